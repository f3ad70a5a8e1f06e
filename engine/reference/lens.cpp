// SPDX-License-Identifier: MIT
#include "reference/lens.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace afterglow::reference {

namespace {

constexpr double kRightAngle = std::numbers::pi / 2 - 1e-6;  ///< rays beyond it come from nowhere: the edge is read

Point uv_of(int x, int y, Size size) { return {(x + 0.5) / size.width, (y + 0.5) / size.height}; }

Rgba read(const DoubleImage& image, Point uv) {
  uv = glm::clamp(uv, Point(0), Point(1));
  return sample_linear(image, uv.x * image.width, uv.y * image.height);
}

}  // namespace

DoubleImage vignette(const DoubleImage& source, const Vignette& s) {
  return generate(source.size(), [&](int x, int y) {
    Point d = glm::abs(uv_of(x, y, source.size()) - s.center) * (3 * s.intensity);
    if (s.rounded) d.x *= static_cast<double>(source.width) / source.height;
    const double kept = std::pow(glm::clamp(1 - glm::dot(d, d), 0.0, 1.0), 5 * s.smoothness);
    const Rgba& p = source.at(x, y);
    return Rgba(Rgb(p) * (s.color + kept * (Rgb(1) - s.color)), p.a);
  });
}

DoubleImage chromatic_aberration(const DoubleImage& source, double intensity, int samples) {
  return generate(source.size(), [&](int x, int y) {
    const Point uv = uv_of(x, y, source.size()), coords = 2.0 * uv - 1.0;
    const Point end = uv - coords * glm::dot(coords, coords) * intensity * 0.05;
    const double reach = glm::length((end - uv) * (2.0 / 3) * Point(source.width, source.height));
    const auto whole = [](double pixels) { return static_cast<int>(std::floor(pixels + 0.7)); };
    const int steps = samples == 3 ? 2 : std::max({2, whole(reach * 2 / 3), std::min(samples - 1, whole(reach))});
    Rgb sum(0), weights(0);
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      const Rgb weight(glm::max(0.0, 1 - 2 * t), 1 - std::abs(2 * t - 1), glm::max(0.0, 2 * t - 1));
      sum += weight * Rgb(read(source, uv + (end - uv) * (t * 2 / 3)));
      weights += weight;
    }
    return Rgba(sum / weights, source.at(x, y).a);
  });
}

DoubleImage lens_distortion(const DoubleImage& source, const LensDistortion& s) {
  const double theta = glm::min(1.6 * glm::max(std::abs(s.intensity) * 100, 1.0), 160.0) * std::numbers::pi / 180;
  const double sigma = 2 * std::tan(theta / 2);
  const Point axes(glm::max(s.x_multiplier, 1e-4), glm::max(s.y_multiplier, 1e-4));
  return generate(source.size(), [&](int x, int y) {
    Point uv = s.center + (uv_of(x, y, source.size()) - s.center) / s.scale;
    const Point ray = axes * (uv - s.center);
    const double r = glm::length(ray);
    if (s.intensity != 0 && r > 0)
      uv += ray * ((s.intensity > 0 ? std::tan(std::min(r * theta, kRightAngle)) / (r * sigma)
                                    : std::atan(r * sigma) / (r * theta)) -
                   1);
    double inside = 1;
    for (int axis = 0; axis < 2; ++axis) {
      const double side = axis == 0 ? source.width : source.height;
      if (s.edges == LensEdges::mirror) uv[axis] = std::abs(uv[axis] - 2 * std::round(uv[axis] / 2));
      // Of bilinear reads among black pixels beyond the edge.
      if (s.edges == LensEdges::black) inside *= glm::clamp(glm::min(uv[axis], 1 - uv[axis]) * side + 0.5, 0.0, 1.0);
    }
    return Rgba(Rgb(read(source, uv)) * inside, source.at(x, y).a);
  });
}

}  // namespace afterglow::reference
