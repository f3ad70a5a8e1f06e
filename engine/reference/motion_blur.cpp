// SPDX-License-Identifier: MIT
#include "reference/motion_blur.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

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

double longer(const Way& way) { return glm::max(std::abs(way.x), std::abs(way.y)); }

/// How much of the read `i` steps away a way of `steps` covers.
double covered_by(double i, double steps) { return glm::clamp(steps + 0.5 - i, 0.0, 1.0); }

/// Square of the difference of two ways, whichever end of them comes first.
double unlike(const Way& a, const Way& b) {
  return glm::max(glm::min(glm::dot(a - b, a - b), glm::dot(a + b, a + b)), 1e-6);
}

/// What crosses one pixel.
struct Crossing {
  const DoubleImage &source, &ways, &nearness;
  double softness = 1;
  int samples = 0;
  int x = 0, y = 0;
  Way own{}, around{};  // the pixel's way, and the longest around
  bool two = false;     // they differ
  Rgb behind{0}, front{0};
  double behind_weight = 0, front_share = 0;

  void count(int px, int py, double share, double i, const Way& step, bool first, double steps) {
    const Way read = way_of(ways.clamped(px, py));
    const double in_front = glm::clamp((nearness.clamped(px, py).r - nearness.at(x, y).r) / softness, 0.0, 1.0);
    const double along = std::abs(glm::dot(read, step)) / glm::dot(step, step);
    double passes = share * in_front * covered_by(i, along) / (2 * glm::max(along, 0.5));
    if (two) {
      const double to_own = unlike(read, own), to_around = unlike(read, around);
      passes *= (first ? to_around : to_own) / (to_own + to_around);
    }
    const double stays = first ? share * covered_by(i, steps) * (1 - in_front) : 0;
    const Rgb color(source.clamped(px, py));
    front += passes * color;
    front_share += passes;
    behind += stays * color;
    behind_weight += stays;
  }

  void follow(const Way& way, bool first) {
    const double length = longer(way), apart = glm::max(1.0, std::ceil((2 * length - 0.3) / samples));
    const Way step = way * (apart / length);
    const bool flat = std::abs(way.x) >= std::abs(way.y);
    for (int i = 1; i <= static_cast<int>(std::floor(length / apart + 0.5)); ++i)
      for (const int side : {-1, 1}) {
        const Way at = step * double(side * i);
        const int along = static_cast<int>(std::lround(flat ? at.x : at.y));
        const double aside = flat ? at.y : at.x;
        const int low = static_cast<int>(std::floor(aside));
        for (const int by : {0, 1}) {
          const double share = by == 1 ? aside - low : 1 - (aside - low);
          count(x + (flat ? along : low + by), y + (flat ? low + by : along), share, i, step, first, length / apart);
        }
      }
  }
};

}  // namespace

DoubleImage motion_blur(const DoubleImage& source, const DoubleImage& motion, const DoubleImage* depth,
                        const MotionBlur& s) {
  const DoubleImage ways = half_ways(motion, s);
  const DoubleImage nearness = generate(source.size(), [&](int x, int y) {
    return Rgba(depth ? -depth->at(x, y).r : glm::length(way_of(ways.at(x, y))));
  });
  const int tile = static_cast<int>(std::ceil(s.max_radius));
  const Size tiles{(source.width + tile - 1) / tile, (source.height + tile - 1) / tile};
  const DoubleImage by_tile = generate(tiles, [&](int x, int y) {
    return longest_in(ways, x * tile, y * tile, glm::min((x + 1) * tile, source.width),
                      glm::min((y + 1) * tile, source.height));
  });
  return generate(source.size(), [&](int x, int y) {
    const int tx = x / tile, ty = y / tile;
    const Way around = way_of(longest_in(by_tile, tx - 1, ty - 1, tx + 2, ty + 2));
    const Rgba color = source.at(x, y);
    if (longer(around) <= 0.5) return color;
    Crossing pixel{source, ways, nearness, depth ? s.depth_softness : 1, s.samples, x, y, way_of(ways.at(x, y)),
                   around};
    pixel.two = unlike(pixel.around, pixel.own) > 0.25;
    pixel.behind = Rgb(color);
    pixel.behind_weight = 1;
    if (longer(pixel.own) > 0.5) pixel.follow(pixel.own, true);
    if (pixel.two) pixel.follow(around, false);
    return Rgba(pixel.behind * (glm::max(1 - pixel.front_share, 0.0) / pixel.behind_weight) +
                    pixel.front / glm::max(pixel.front_share, 1.0),
                color.a);
  });
}

}  // namespace afterglow::reference
