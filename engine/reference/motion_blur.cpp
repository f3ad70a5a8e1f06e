// SPDX-License-Identifier: MIT
#include "reference/motion_blur.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <vector>

#include "reference/edge_pixels.h"

namespace afterglow::reference {
namespace {

using Way = glm::dvec2;

Way way_of(const Rgba& p) { return {p.r, p.g}; }

/// Half ways of all pixels: what they move while half of the exposure passes.
DoubleImage half_ways(const DoubleImage& motion, const MotionBlur& s) {
  const double exposure = s.shutter_angle / 360;
  return generate(motion.size(), [&](int x, int y) {
    return Rgba(way_of(motion.at(x, y)) * Way(s.scale_x, s.scale_y) * (exposure / 2), 0, 0);
  });
}

Way held(const Way& way, double most) { return way / glm::max(glm::length(way) / most, 1.0); }

/// Area between two ways.
double between(const Way& a, const Way& b) { return std::abs(a.x * b.y - a.y * b.x); }

/// The longest of many ways, and the one that leads farthest aside of it; of equal ones the first.
struct Around {
  Way longest{0}, aside{0};
};
Around around_of(const std::vector<Way>& ways) {
  Around found;
  for (const Way& way : ways)
    if (glm::length(way) > glm::length(found.longest)) found.longest = way;
  for (const Way& way : ways)
    if (between(found.longest, way) > between(found.longest, found.aside)) found.aside = way;
  return found;
}

/// Those of a tile: of its rows first.
Around around_in(const DoubleImage& ways, int x0, int y0, int side) {
  std::vector<Way> of_rows;
  for (int y = y0; y < glm::min(y0 + side, ways.height); ++y) {
    std::vector<Way> row;
    for (int x = x0; x < glm::min(x0 + side, ways.width); ++x) row.push_back(way_of(ways.at(x, y)));
    const Around of_row = around_of(row);
    of_rows.insert(of_rows.end(), {of_row.longest, of_row.aside});
  }
  return around_of(of_rows);
}

double longer(const Way& way) { return glm::max(std::abs(way.x), std::abs(way.y)); }

/// How much of the read `i` steps away a way of `steps` covers.
double covered_by(double i, double steps) { return glm::clamp(steps + 0.5 - i, 0.0, 1.0); }

/// Square of the difference of two ways, whichever end of them comes first.
double unlike(const Way& a, const Way& b) {
  return glm::max(glm::min(glm::dot(a - b, a - b), glm::dot(a + b, a + b)), 1e-6);
}

/// Square of how far a motion is from the line of a way, or where `ends` from the way, whichever end of it comes first.
double off(const Way& motion, const Way& way, bool ends) {
  double along = glm::dot(way, way) > 0 ? glm::dot(motion, way) / glm::dot(way, way) : 0;
  if (ends) along = glm::clamp(along, -1.0, 1.0);
  const Way by = motion - along * way;
  return glm::dot(by, by) + 1e-6;
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
  struct Followed {
    Way way;
    double counts = 1;
  };
  std::array<Followed, 3> ways;  // the pixel's own, the longest around, and the one farthest aside of that
  Rgb along{0}, front{0}, past{0};
  double along_weight = 0, front_share = 0, past_weight = 0, past_share = 0;

  /// Returns how much of it is behind the pixel and moves otherwise. `clear`: 1, and half as much after each such read.
  double count(int px, int py, double share, double i, const Way& step, std::size_t which, double steps, double clear) {
    const Way read = m.way(px, py);
    const double nearer = m.nearer(px, py, x, y), in_front = glm::max(nearer, 0.0);
    const double to_end = std::abs(glm::dot(read, step)) / glm::dot(step, step);
    double passes = share * in_front * covered_by(i, to_end) / (2 * glm::max(to_end, 0.5));
    std::array<double, 3> near{};
    for (std::size_t k = 0; k < 3; ++k) near[k] = ways[k].counts / off(read, ways[k].way, k == 0);
    passes *= near[which] / (near[0] + near[1] + near[2]);
    const double stays = which == 0 ? share * covered_by(i, steps) * (1 - in_front) : 0;
    const double leaves = glm::max(-nearer, 0.0) * differs(ways[0].way, read);
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

  void follow(std::size_t which) {
    const Way way = ways[which].way;
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
                          by == 1 ? aside - low : 1 - (aside - low), i, step, which, length / apart, clear);
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
  const DoubleImage whole = half_ways(motion, s), ways = generate(source.size(), [&](int x, int y) {
                                                    return Rgba(held(way_of(whole.at(x, y)), s.max_radius), 0, 0);
                                                  });
  const DoubleImage nearness = generate(source.size(), [&](int x, int y) {
    return Rgba(depth ? -depth->at(x, y).r : glm::length(way_of(ways.at(x, y))));
  });
  const Moving moving{source, ways, nearness, depth ? s.depth_softness : 1, s.samples};
  const int tile = static_cast<int>(std::ceil(s.max_radius));
  const Size tiles{(source.width + tile - 1) / tile, (source.height + tile - 1) / tile};
  const DoubleImage by_tile = generate(tiles, [&](int x, int y) {
    const Around found = around_in(whole, x * tile, y * tile, tile);
    return Rgba(found.longest, found.aside);
  });
  return generate(source.size(), [&](int x, int y) {
    std::vector<Way> around;
    for (int ty = y / tile - 1; ty <= y / tile + 1; ++ty)
      for (int tx = x / tile - 1; tx <= x / tile + 1; ++tx) {
        const Rgba& of_tile = by_tile.clamped(tx, ty);
        around.insert(around.end(), {Way(of_tile.r, of_tile.g), Way(of_tile.b, of_tile.a)});
      }
    const Around found = around_of(around);
    const Way own = way_of(ways.at(x, y)), longest = held(found.longest, s.max_radius);
    const Way aside = held(found.aside, s.max_radius);
    const Rgba color = source.at(x, y);
    if (longer(longest) <= 0.5) return color;
    const auto apart = [&](const Way& way) { return unlike(way, own) > 0.25 ? 1.0 : 0.0; };
    const double leads =
        glm::clamp(4 * between(longest, aside) / glm::max(glm::dot(longest, longest), 0.25) - 1, 0.0, 1.0);
    Crossing pixel{moving, x, y, {{{own}, {longest, apart(longest)}, {aside, leads * apart(aside)}}}};
    if (longer(own) > 0.5) pixel.follow(0);
    if (pixel.ways[1].counts > 0) pixel.follow(1);
    if (pixel.ways[2].counts > 0) pixel.follow(2);
    return Rgba(pixel.result(), color.a);
  });
}

}  // namespace afterglow::reference
