// SPDX-License-Identifier: MIT
// SMAA 1x without diagonals, with exact areas (math.md §32).
#pragma once

#include "reference/double_image.h"

namespace afterglow::reference {

struct Smaa {
  double threshold = 0.08;
  int search = 32;
  double corner_rounding = 25;  ///< %
};
/// Edges at the left (r) and upper (g) side of each pixel.
DoubleImage smaa_edges(const DoubleImage& source, const Smaa& settings);
/// How much of each pixel lies beyond its edges: below and above the upper one (r, g), right and left of the left (b,
/// a).
DoubleImage smaa_weights(const DoubleImage& edges, const Smaa& settings);
DoubleImage smaa(const DoubleImage& source, const Smaa& settings);

}  // namespace afterglow::reference
