// SPDX-License-Identifier: MIT
#include "reference/occlusion.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "reference/grain.h"

namespace afterglow::reference {
namespace {

using Vec = glm::dvec3;

double tangent_of(const Ssao& s) { return std::tan(s.field_of_view / 2 * glm::pi<double>() / 180); }

/// The point that pixel (x, y) of an image shows at distance z; `size` may be half the picture's.
Vec seen_at(double x, double y, double z, Size size, double tan, double aspect) {
  return {(2 * x / size.width - 1) * tan * aspect * z, -(2 * y / size.height - 1) * tan * z, -z};
}

double held_distance(double z) { return glm::clamp(z, 0.0, 1e10); }

DoubleImage smooth_along(const DoubleImage& image, int dx, int dy) {
  return generate(image.size(), [&](int x, int y) {
    const double z = image.at(x, y).a;
    double sum = 0, weights = 0;
    for (int i = -3; i <= 3; ++i) {
      const Rgba& there = image.clamped(x + i * dx, y + i * dy);
      const double apart = std::abs(there.a - z) / glm::max(0.02 * z, 1e-6);
      const double w = i == 0 ? 1.0 : (1 - 0.2 * std::abs(i)) * glm::max(1 - apart, 0.0);
      sum += w * there.r;
      weights += w;
    }
    return Rgba(Rgb(sum / weights), z);
  });
}

}  // namespace

DoubleImage ssao_surface(const DoubleImage& depth, const DoubleImage* normal, const Ssao& s) {
  const double tan = tangent_of(s), aspect = static_cast<double>(depth.width) / depth.height;
  const auto z_at = [&](int x, int y) { return held_distance(depth.clamped(x, y).r); };
  const auto point = [&](int x, int y) { return seen_at(x + 0.5, y + 0.5, z_at(x, y), depth.size(), tan, aspect); };
  // Beyond the edge the camera goes on, the depth is the last pixel's.
  const auto slope = [&](int x, int y, int dx, int dy) {
    const Vec here = point(x, y);
    const double ahead = std::abs(z_at(x + dx, y + dy) - z_at(x, y)),
                 behind = std::abs(z_at(x - dx, y - dy) - z_at(x, y));
    return ahead <= behind ? point(x + dx, y + dy) - here : here - point(x - dx, y - dy);
  };
  const Vec forward = glm::normalize(s.camera_forward), right = glm::normalize(glm::cross(forward, s.camera_up));
  const Vec up = glm::cross(right, forward);
  return generate({(depth.width + 1) / 2, (depth.height + 1) / 2}, [&](int i, int j) {
    const int x = glm::min(2 * i, depth.width - 1), y = glm::min(2 * j, depth.height - 1);
    Vec n;
    if (s.normals == SurfaceNormals::from_depth) {
      n = glm::cross(slope(x, y, 0, 1), slope(x, y, 1, 0));
    } else {
      n = Vec(normal->at(x, y));
      if (s.normals == SurfaceNormals::world) n = {glm::dot(n, right), glm::dot(n, up), -glm::dot(n, forward)};
    }
    n = glm::length(n) > 1e-30 ? glm::normalize(n) : Vec(0, 0, 1);
    return Rgba(n, z_at(x, y));
  });
}

/// What is farther is as far, once light has been found: distances then lie where half floats have them.
constexpr double kFarthest = 65504;

DoubleImage ssao_occlusion(const DoubleImage& surface, Size picture, const Ssao& s) {
  const double tan = tangent_of(s), aspect = static_cast<double>(picture.width) / picture.height;
  const Size size = surface.size();
  const double most = s.max_radius * size.height;
  return generate(size, [&](int x, int y) {
    const Rgba& here = surface.at(x, y);
    const double z = here.a;
    if (z >= 1e9 || z < 1e-12) return Rgba(1, 1, 1, glm::min(z, kFarthest));
    const Vec at = seen_at(x + 0.5, y + 0.5, z, size, tan, aspect);
    const double far = glm::min(0.5 * size.height * s.radius / (tan * z), most);
    if (far < 0.5) return Rgba(1, 1, 1, glm::min(z, kFarthest));
    const double within = glm::min(s.radius, 2 * far * tan * z / size.height);
    const Words chance = pcg3d({static_cast<std::uint32_t>(x & 3), static_cast<std::uint32_t>(y & 3), 17});
    double sum = 0;
    for (int i = 0; i < s.samples; ++i) {
      const double share = (i + 0.25 + 0.5 * unit(chance[1])) / s.samples;
      const double angle = glm::two_pi<double>() * (share * 7 + unit(chance[0]));
      const int px =
          glm::clamp(x + static_cast<int>(std::floor(far * share * std::cos(angle) + 0.5)), 0, size.width - 1);
      const int py =
          glm::clamp(y + static_cast<int>(std::floor(far * share * std::sin(angle) + 0.5)), 0, size.height - 1);
      const Vec way = seen_at(px + 0.5, py + 0.5, surface.at(px, py).a, size, tan, aspect) - at;
      const double apart = glm::dot(way, way) / (within * within);
      const double rise = (glm::dot(way, Vec(here)) - 3e-4 * z) / within - s.bias;
      sum += std::pow(glm::max(1 - apart, 0.0), 3) * glm::max(rise, 0.0) / (apart + 0.01);
    }
    return Rgba(Rgb(glm::max(0.0, 1 - 4 * s.intensity * sum / s.samples)), glm::min(z, kFarthest));
  });
}

DoubleImage ssao(const DoubleImage& source, const DoubleImage& depth, const DoubleImage* normal, const Ssao& s) {
  DoubleImage light = ssao_occlusion(ssao_surface(depth, normal, s), source.size(), s);
  light = smooth_along(smooth_along(light, 1, 0), 0, 1);
  return generate(source.size(), [&](int x, int y) {
    const Rgba& p = source.at(x, y);
    const double z = glm::min(held_distance(depth.at(x, y).r), kFarthest), fx = x % 2 * 0.5, fy = y % 2 * 0.5;
    double sum = 0, weights = 0;
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        const Rgba& there = light.clamped(x / 2 + i, y / 2 + j);
        const double near = 1e-3 + std::abs(there.a - z) / glm::max(0.02 * z, 1e-6);
        const double w = (i ? fx : 1 - fx) * (j ? fy : 1 - fy) / near;
        sum += w * there.r;
        weights += w;
      }
    double left = sum / glm::max(weights, 1e-20);
    const double b = glm::max(p.r, glm::max(p.g, p.b));
    const double t = glm::clamp((b - s.spare) / (3 * s.spare + 1e-6), 0.0, 1.0);
    left = glm::mix(left, 1.0, t * t * (3 - 2 * t));
    return Rgba(Rgb(p) * glm::mix(s.color, Rgb(1), left), p.a);
  });
}

}  // namespace afterglow::reference
