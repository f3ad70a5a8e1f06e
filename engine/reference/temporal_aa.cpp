// SPDX-License-Identifier: MIT
#include "reference/temporal_aa.h"

#include <array>
#include <cmath>

namespace afterglow::reference {
namespace {

double most_of(const Rgb& c) { return glm::max(c.r, glm::max(c.g, c.b)); }
Rgb weighed(const Rgba& c) { return Rgb(c) / (1 + most_of(Rgb(c))); }
Rgb unweighed(const Rgb& c) { return c / glm::max(1 - most_of(c), 1e-6); }
Rgb ycocg_of(const Rgb& c) { return {(c.r + 2 * c.g + c.b) / 4, (c.r - c.b) / 2, (2 * c.g - c.r - c.b) / 4}; }
Rgb rgb_of(const Rgb& c) { return {c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z}; }

/// Catmull and Rom's spline through four values, at t between the middle two.
std::array<double, 4> spline_weights(double t) {
  const double t2 = t * t, t3 = t2 * t;
  return {(-t3 + 2 * t2 - t) / 2, (3 * t3 - 5 * t2 + 2) / 2, (-3 * t3 + 4 * t2 + t) / 2, (t3 - t2) / 2};
}

Rgb past_of(const DoubleImage& before, double px, double py) {
  const double bx = std::floor(px - 0.5), by = std::floor(py - 0.5);
  const auto wx = spline_weights(px - 0.5 - bx), wy = spline_weights(py - 0.5 - by);
  Rgb sum(0);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      sum += wx[static_cast<std::size_t>(i)] * wy[static_cast<std::size_t>(j)] *
             weighed(before.clamped(static_cast<int>(bx) + i - 1, static_cast<int>(by) + j - 1));
  return glm::max(sum, Rgb(0));
}

}  // namespace

DoubleImage temporal_aa(const DoubleImage& source, const DoubleImage* before, const DoubleImage& motion,
                        const DoubleImage* depth, const TemporalAa& s) {
  if (!before) return source;
  return generate(source.size(), [&](int x, int y) {
    const Rgba& p = source.at(x, y);
    int front_x = x, front_y = y;
    Rgb mean(0), squares(0), least(1e30), most(-1e30);
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Rgb c = ycocg_of(weighed(source.clamped(x + dx, y + dy)));
        mean += c / 9.0;
        squares += c * c / 9.0;
        least = glm::min(least, c);
        most = glm::max(most, c);
        if (depth && depth->clamped(x + dx, y + dy).r < depth->clamped(front_x, front_y).r)
          front_x = x + dx, front_y = y + dy;
      }
    const Rgba way = motion.clamped(front_x, front_y) * (s.to_next ? -1.0 : 1.0);
    const double px = x + 0.5 + way.r, py = y + 0.5 + way.g;
    if (px < 0 || py < 0 || px > source.width || py > source.height) return p;
    const Rgb deviation = glm::sqrt(glm::max(squares - mean * mean, Rgb(0)));
    const Rgb low = glm::max(mean - s.bounds * deviation, least), high = glm::min(mean + s.bounds * deviation, most);
    const Rgb middle = (low + high) / 2.0, off = ycocg_of(past_of(*before, px, py)) - middle;
    const double beyond = most_of(glm::abs(off / glm::max((high - low) / 2.0, Rgb(1e-7))));
    const Rgb past = glm::max(rgb_of(middle + off / glm::max(beyond, 1.0)), Rgb(0));
    return Rgba(unweighed(glm::mix(weighed(p), past, s.feedback)), p.a);
  });
}

}  // namespace afterglow::reference
