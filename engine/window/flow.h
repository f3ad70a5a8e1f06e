// SPDX-License-Identifier: MIT
// Pieces side by side, on as many rows as their widths need.
#pragma once

#include <span>
#include <vector>

namespace afterglow {

/// The row of each piece, from 0: a piece that has no room beside those before it begins the next row.
inline std::vector<int> rows_of(std::span<const float> widths, float gap, float available) {
  std::vector<int> rows;
  float used = 0;
  int row = 0;
  for (const float width : widths) {
    const float wanted = used > 0 ? used + gap + width : width;
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
