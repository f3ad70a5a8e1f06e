// SPDX-License-Identifier: MIT
#include "reference/motion_blur.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "reference/edge_pixels.h"

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

/// Ways of all pixels, and how near they are.
struct Moving {
  const DoubleImage &source, &ways, &nearness;
  double softness = 1;
  int samples = 0;

  Way way(int x, int y) const { return way_of(ways.clamped(x, y)); }
  /// −1…1: how much (px, py) lies in front of (x, y); below 0: behind it.
  double nearer(int px, int py, int x, int y) const {
    return glm::clamp((nearness.clamped(px, py).r - nearness.at(x, y).r) / softness, -1.0, 1.0);
  }
};

/// How much the second moves otherwise than the first does, in parts of the first's way.
double differs(const Way& first, const Way& second) {
  return glm::min(unlike(first, second) / glm::max(glm::dot(first, first), 0.25), 1.0);
}

/// What stands for a pixel that holds light of what passes in front of it: its neighbours away from the edge.
Rgb behind_edge(const Moving& m, int x, int y) {
  const auto before = [&](int dx, int dy) {
    const Way way = m.way(x + dx, y + dy);
    return glm::max(m.nearer(x + dx, y + dy, x, y), 0.0) * glm::clamp(longer(way) - 0.5, 0.0, 1.0) *
           differs(way, m.way(x, y));
  };
  return mean_behind_edge(m.source, x, y, before, [](int, int) { return 1.0; });
}

/// What crosses one pixel.
struct Crossing {
  const Moving& m;
  int x = 0, y = 0;
  Way own{}, around{};  // the pixel's way, and the longest around
  bool two = false;     // they differ
  Rgb along{0}, front{0}, past{0};
  double along_weight = 0, front_share = 0, past_weight = 0, past_share = 0;

  /// Returns how much of it is behind the pixel and moves otherwise. `clear`: 1, and half as much after each such read.
  double count(int px, int py, double share, double i, const Way& step, bool first, double steps, double clear) {
    const Way read = m.way(px, py);
    const double nearer = m.nearer(px, py, x, y), in_front = glm::max(nearer, 0.0);
    const double to_end = std::abs(glm::dot(read, step)) / glm::dot(step, step);
    double passes = share * in_front * covered_by(i, to_end) / (2 * glm::max(to_end, 0.5));
    if (two) {
      const double to_own = unlike(read, own), to_around = unlike(read, around);
      passes *= (first ? to_around : to_own) / (to_own + to_around);
    }
    const double stays = first ? share * covered_by(i, steps) * (1 - in_front) : 0;
    const double leaves = glm::max(-nearer, 0.0) * differs(own, read);
    const double weight = stays * leaves * (clear - clear * clear + 1e-3) / (i * i);
    const Rgb color(m.source.clamped(px, py));
    front += passes * color;
    front_share += passes;
    along += stays * (1 - leaves) * color;
    along_weight += stays * (1 - leaves);
    past += weight * color;
    past_weight += weight;
    past_share += stays * leaves;
    return leaves * share;
  }

  void follow(const Way& way, bool first) {
    const double length = longer(way), apart = glm::max(1.0, std::ceil((2 * length - 0.3) / m.samples));
    const Way step = way * (apart / length);
    const bool flat = std::abs(way.x) >= std::abs(way.y);
    for (const int side : {-1, 1}) {
      double clear = 1;
      for (int i = 1; i <= static_cast<int>(std::floor(length / apart + 0.5)); ++i) {
        const Way at = step * double(side * i);
        const int to = static_cast<int>(std::lround(flat ? at.x : at.y));
        const double aside = flat ? at.y : at.x;
        const int low = static_cast<int>(std::floor(aside));
        double leaves = 0;
        for (const int by : {0, 1})
          leaves += count(x + (flat ? to : low + by), y + (flat ? low + by : to),
                          by == 1 ? aside - low : 1 - (aside - low), i, step, first, length / apart, clear);
        clear *= 1 - leaves / 2;
      }
    }
  }

  Rgb result() const {
    Rgb behind = along + (front_share > 0 ? behind_edge(m, x, y) : Rgb(m.source.at(x, y)));
    if (past_share > 0) behind += past * (past_share / past_weight);
    return behind * (glm::max(1 - front_share, 0.0) / (1 + along_weight + past_share)) +
           front / glm::max(front_share, 1.0);
  }
};

}  // namespace

DoubleImage motion_blur(const DoubleImage& source, const DoubleImage& motion, const DoubleImage* depth,
                        const MotionBlur& s) {
  const DoubleImage ways = half_ways(motion, s);
  const DoubleImage nearness = generate(source.size(), [&](int x, int y) {
    return Rgba(depth ? -depth->at(x, y).r : glm::length(way_of(ways.at(x, y))));
  });
  const Moving moving{source, ways, nearness, depth ? s.depth_softness : 1, s.samples};
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
    Crossing pixel{moving, x, y, way_of(ways.at(x, y)), around};
    pixel.two = unlike(pixel.around, pixel.own) > 0.25;
    if (longer(pixel.own) > 0.5) pixel.follow(pixel.own, true);
    if (pixel.two) pixel.follow(around, false);
    return Rgba(pixel.result(), color.a);
  });
}

}  // namespace afterglow::reference
