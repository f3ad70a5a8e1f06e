// SPDX-License-Identifier: MIT
#include "reference/motion_blur.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "reference/grain.h"

namespace afterglow::reference {
namespace {

using Way = glm::dvec2;

Way way_of(const Rgba& p) { return {p.r, p.g}; }

/// Half ways of all pixels: what they move while half of the exposure passes; their lengths before they are held in .a.
DoubleImage half_ways(const DoubleImage& motion, const MotionBlur& s) {
  const double exposure = s.shutter_angle / 360;
  return generate(motion.size(), [&](int x, int y) {
    Way way = way_of(motion.at(x, y)) * Way(s.scale_x, s.scale_y) * (exposure / 2);
    const double length = glm::length(way);
    if (length > s.max_radius) way *= s.max_radius / length;
    return Rgba(way.x, way.y, 0, length);
  });
}

/// The longest in a rectangle of an image; of equal ones the first in the order given: by rows of it.
Rgba longest_in(const DoubleImage& ways, int x0, int y0, int x1, int y1) {
  Rgba most(0);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      if (ways.clamped(x, y).a > most.a) most = ways.clamped(x, y);
  return most;
}

double cone(double away, double way) { return glm::clamp(1 - away / way, 0.0, 1.0); }
double cylinder(double away, double way) {
  const double t = glm::clamp((away - 0.95 * way) / (0.1 * way), 0.0, 1.0);
  return 1 - t * t * (3 - 2 * t);
}

}  // namespace

DoubleImage motion_blur(const DoubleImage& source, const DoubleImage& motion, const DoubleImage* depth,
                        const MotionBlur& s) {
  const DoubleImage ways = half_ways(motion, s);
  const int tile = static_cast<int>(std::ceil(s.max_radius));
  const Size tiles{(source.width + tile - 1) / tile, (source.height + tile - 1) / tile};
  const DoubleImage by_tile = generate(tiles, [&](int x, int y) {
    return longest_in(ways, x * tile, y * tile, glm::min((x + 1) * tile, source.width),
                      glm::min((y + 1) * tile, source.height));
  });
  return generate(source.size(), [&](int x, int y) {
    const int tx = x / tile, ty = y / tile;
    const Way along = way_of(longest_in(by_tile, tx - 1, ty - 1, tx + 2, ty + 2));
    const Rgba color = source.at(x, y);
    if (glm::dot(along, along) <= 0.25) return color;
    const double own = glm::max(glm::length(way_of(ways.at(x, y))), 0.5);
    const auto in_front = [&](int ax, int ay, int bx, int by) {
      if (!depth) return 1.0;
      const double a = depth->clamped(ax, ay).r, b = depth->clamped(bx, by).r;
      return glm::clamp(1 - (a - b) / s.depth_softness, 0.0, 1.0);
    };
    const double offset =
        (pcg3d({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0})[0] >> 8) / 16777216.0 - 0.5;
    const int count = glm::min(s.samples, static_cast<int>(std::floor(2 * glm::length(along) + 0.7)) + 1);
    double weight = count / (s.samples * own);
    Rgb sum = Rgb(color) * weight;
    for (int i = 0; i < count; ++i) {
      const double t = 2 * (i + offset + 1) / (count + 1) - 1;
      const int px = x + static_cast<int>(std::floor(along.x * t + 0.5));
      const int py = y + static_cast<int>(std::floor(along.y * t + 0.5));
      if (px == x && py == y) continue;
      const double away = std::hypot(px - x, py - y);
      const double read = glm::max(glm::length(way_of(ways.clamped(px, py))), 0.5);
      const double counts = in_front(px, py, x, y) * cone(away, read) + in_front(x, y, px, py) * cone(away, own) +
                            2 * cylinder(away, read) * cylinder(away, own);
      weight += counts;
      sum += counts * Rgb(source.clamped(px, py));
    }
    return Rgba(sum / weight, color.a);
  });
}

}  // namespace afterglow::reference
