// SPDX-License-Identifier: MIT
// What stands for anti-aliased edge pixels, which hold light of what is in front (math.md §35, Edges).
#pragma once

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace afterglow::reference {

/// Weight of the neighbour at `by`; `away` points away from the edge, the longer the more of it there is.
inline double away_from(const glm::dvec2& away, const glm::dvec2& by) {
  const double along = glm::max(glm::dot(by, away), 0.0), length2 = glm::dot(away, away);
  const double cos2 = along * along / (glm::max(glm::dot(by, by), 1.0) * glm::max(length2, 1e-6));
  return length2 * std::pow(cos2, 8);
}

}  // namespace afterglow::reference
