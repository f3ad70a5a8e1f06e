// SPDX-License-Identifier: MIT
#include "reference/outline.h"

#include <cmath>

#include "reference/color.h"

namespace afterglow::reference {

namespace {

struct Pixel {
  int x, y;
};

/// The three pixels whose values are compared: the centre, and the one further along each axis.
struct Samples {
  Pixel centre, right, below;
};

/// The 2×2 quad of the pixel; its origin is even. All four pixels share one result.
Samples quad(int x, int y) {
  const int qx = x - x % 2, qy = y - y % 2;
  return {{qx, qy}, {qx + 1, qy}, {qx, qy + 1}};
}

Samples neighbours(int x, int y, int distance) { return {{x, y}, {x + distance, y}, {x, y + distance}}; }

/// What is compared at a pixel: scaled depth, raw device depth, or scaled normal.
double depth_value(const DoubleImage& depth, Pixel p, const OutlineSettings& s) {
  const double d = depth.clamped(p.x, p.y).r;
  const bool linearise = s.device_depth_input && s.source != OutlineSource::device_depth;
  return (linearise ? linear_eye_depth(d, s) : d) * s.depth_scale;
}

Rgb normal_value(const DoubleImage& normal, Pixel p, const OutlineSettings& s) {
  return Rgb(normal.clamped(p.x, p.y)) * s.normal_scale;
}

/// How far the pixel ahead, at one or more pixels along an axis, leaves the plane through the centre and the pixel
/// behind it (where there is none: the plane through the two ahead). Inverse distance is linear on a plane; its
/// differences count as far as the one ahead exceeds that behind.
double edge_off_the_plane(const DoubleImage& depth, Pixel c, int dx, int dy, const OutlineSettings& s) {
  const auto z_at = [&](int steps) {
    const double d = depth.clamped(c.x + steps * dx, c.y + steps * dy).r;
    return s.device_depth_input && s.source != OutlineSource::device_depth ? linear_eye_depth(d, s) : d;
  };
  const bool raw = s.source == OutlineSource::device_depth, inside = c.x >= dx && c.y >= dy;
  const auto value = [&](int steps) { return raw ? z_at(steps) : 1 / glm::max(z_at(steps), 1e-6); };
  const double ahead = value(1) - value(0), along = inside ? value(0) - value(-1) : value(2) - value(1);
  const bool goes_on = ahead * along > 0;
  const double off = goes_on ? glm::max(std::abs(ahead) - std::abs(along), 0.0) : std::abs(ahead);
  return (raw ? off : off * z_at(0) * z_at(1)) * std::abs(s.depth_scale);
}

double depth_edge(const DoubleImage& depth, const Samples& at, const OutlineSettings& s) {
  if (s.level_slopes && s.difference == OutlineDifference::offset) {
    const int apart = at.right.x - at.centre.x;
    return edge_off_the_plane(depth, at.centre, apart, 0, s) + edge_off_the_plane(depth, at.centre, 0, apart, s);
  }
  const double z = depth_value(depth, at.centre, s);
  return std::abs(z - depth_value(depth, at.right, s)) + std::abs(z - depth_value(depth, at.below, s));
}

double normal_edge(const DoubleImage& normal, const Samples& at, const OutlineSettings& s) {
  const Rgb n = normal_value(normal, at.centre, s);
  return glm::length(n - normal_value(normal, at.right, s)) + glm::length(n - normal_value(normal, at.below, s));
}

/// Whole pixels to the neighbours of (x, y): the width (more than the largest picture counts as that), faded with
/// distance, rounded.
int reach(const DoubleImage* depth, int x, int y, const OutlineSettings& s) {
  double fade = 1;
  if (depth) {
    const double d = depth->clamped(x, y).r;
    const double z = s.device_depth_input ? linear_eye_depth(d, s) : d;
    fade = saturate(1 - z / s.fade_distance);
  }
  return static_cast<int>(std::floor(fade * std::min(s.width, 16384.0) + 0.5));
}

}  // namespace

double linear_eye_depth(double d, const OutlineSettings& settings) {
  const double n = 1 / settings.near, f = 1 / settings.far;
  return settings.reversed_z ? 1 / ((n - f) * d + f) : 1 / ((f - n) * d + n);
}

/// Lines on which 3×3 pixels decide: their mean, steepened so that a line one pixel wide stays as strong as it is.
DoubleImage smoothed(const DoubleImage& lines, double share) {
  return generate(lines.size(), [&](int x, int y) {
    double mean = 0, strongest = 0;
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i) {
        const double line = lines.clamped(x + i, y + j).r;
        mean += line * (2 - std::abs(i)) * (2 - std::abs(j)) / 16;
        strongest = glm::max(strongest, line);
      }
    const double own = lines.at(x, y).r;
    return Rgba(own + share * (glm::clamp((mean - 0.2 * strongest) / 0.3, 0.0, strongest) - own));
  });
}

DoubleImage outline_mask(Size size, const DoubleImage* depth, const DoubleImage* normal, const OutlineSettings& s) {
  const bool use_normal = s.source == OutlineSource::normals || s.source == OutlineSource::mixed;
  const bool use_depth = s.source != OutlineSource::normals;
  return generate(size, [&](int x, int y) {
    const Samples at =
        s.difference == OutlineDifference::derivative ? quad(x, y) : neighbours(x, y, reach(depth, x, y, s));
    const double ez = use_depth ? depth_edge(*depth, at, s) : 0;
    const double en = use_normal ? normal_edge(*normal, at, s) : 0;
    double e = use_depth ? ez : en;
    if (use_depth && use_normal)
      e = s.combine == OutlineCombine::max ? glm::max(ez, en) : s.normal_factor * en + (1 - s.normal_factor) * ez;
    e /= s.divide_factor;
    return Rgba(saturate((e - 0.5) * s.contrast + 0.5));
  });
}

DoubleImage outline(const DoubleImage& source, const DoubleImage* depth, const DoubleImage* normal,
                    const OutlineSettings& settings) {
  const DoubleImage mask = smoothed(outline_mask(source.size(), depth, normal, settings), settings.smoothness);
  return generate(source.size(), [&](int x, int y) {
    const double m = mask.at(x, y).r;
    const Rgba& p = source.at(x, y);
    const Rgb c(p);
    return Rgba(
        settings.blend == OutlineBlend::lerp ? c + m * (settings.color * p.a - c) : c + m * settings.color * p.a, p.a);
  });
}

}  // namespace afterglow::reference
