// SPDX-License-Identifier: MIT
// What stands for anti-aliased edge pixels, which hold light of what is in front (math.md §35, Edges).
#pragma once

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "reference/double_image.h"

namespace afterglow::reference {

/// Weight of the neighbour at `by`; `away` points away from the edge, the longer the more of it there is.
inline double away_from(const glm::dvec2& away, const glm::dvec2& by) {
  const double along = glm::max(glm::dot(by, away), 0.0), length2 = glm::dot(away, away);
  const double cos2 = along * along / (glm::max(glm::dot(by, by), 1.0) * glm::max(length2, 1e-6));
  return length2 * std::pow(cos2, 8);
}

/// What stands for the pixel at (x, y) where neighbours (dx, dy) are in front of it by `before`, 0…1: those away from
/// the edge, as `like` it as that says.
template <class Before, class Like>
Rgb mean_behind_edge(const DoubleImage& source, int x, int y, Before before, Like like) {
  const Rgb color(source.at(x, y));
  glm::dvec2 away(0);
  double edge = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      away -= before(dx, dy) * glm::dvec2(dx, dy);
      edge = glm::max(edge, before(dx, dy));
    }
  Rgb sum = 1e-3 * color;
  double weights = 1e-3;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const double weight = away_from(away, glm::dvec2(dx, dy)) * (1 - before(dx, dy)) * like(dx, dy);
      sum += weight * Rgb(source.clamped(x + dx, y + dy));
      weights += weight;
    }
  return color * (1 - edge) + sum / weights * edge;
}

}  // namespace afterglow::reference
