// SPDX-License-Identifier: MIT
#include <cmath>

#include "image/metadata.h"

namespace afterglow {

std::optional<std::array<double, 3>> camera_position(const Metadata& metadata) {
  const MetadataValue* value = find_metadata(metadata, "worldToCamera");
  const auto* m = value ? std::get_if<std::vector<float>>(value) : nullptr;
  if (!m || m->size() != 16) return {};
  const auto at = [&](std::size_t row, std::size_t column) { return static_cast<double>((*m)[row * 4 + column]); };
  // The camera stands at the origin of its own space: p · A + t = 0, solved by Cramer's rule for pᵀ with Aᵀ.
  const auto determinant = [](const std::array<std::array<double, 3>, 3>& c) {
    return c[0][0] * (c[1][1] * c[2][2] - c[1][2] * c[2][1]) - c[0][1] * (c[1][0] * c[2][2] - c[1][2] * c[2][0]) +
           c[0][2] * (c[1][0] * c[2][1] - c[1][1] * c[2][0]);
  };
  std::array<std::array<double, 3>, 3> rows{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column) rows[row][column] = at(row, column);
  const double whole = determinant(rows);
  std::array<double, 3> position{};
  for (std::size_t i = 0; i < 3; ++i) {
    auto replaced = rows;
    replaced[i] = {-at(3, 0), -at(3, 1), -at(3, 2)};
    position[i] = determinant(replaced) / whole;
    if (!std::isfinite(position[i])) return {};
  }
  return position;
}

}  // namespace afterglow
