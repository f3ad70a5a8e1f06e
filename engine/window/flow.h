// SPDX-License-Identifier: MIT
// Pieces side by side, on as many rows as their widths need.
#pragma once

#include <span>
#include <vector>

namespace afterglow {

/// The row of each piece, from 0. `gaps` are in front of each but the first of a row. A piece that has no room beside
/// those before it begins the next row.
inline std::vector<int> rows_of(std::span<const float> widths, std::span<const float> gaps, float available) {
  std::vector<int> rows;
  float used = 0;
  int row = 0;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    const float width = widths[i];
    const float wanted = used > 0 ? used + gaps[i] + width : width;
    if (used > 0 && wanted > available) {
      ++row;
      used = width;
    } else {
      used = wanted;
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace afterglow
