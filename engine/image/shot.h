// SPDX-License-Identifier: MIT
// Whether two pictures are of one shot, by what is seen in them (docs/math.md, 54).
#pragma once

#include <vector>

#include "image/picture.h"

namespace afterglow {

/// A picture so small that it is quickly compared.
struct ShotSketch {
  std::vector<float> tones;    ///< 32 × 18 cells, three channels in stops
  std::vector<float> details;  ///< 64 × 36 cells, how many stops each is brighter than those around it
  /// Rows and columns of those 64 × 36 at the borders that are black bars.
  struct Bars {
    int left = 0, right = 0, top = 0, bottom = 0;
  } bars;
  /// It shows nothing, be it black, white or noise: it belongs to the shot before it.
  bool blank = true;
};

/// Of the colours.
ShotSketch sketch_of(const Picture& picture);

/// False where the second shows nothing of the first: neither its light and dark at large, nor its details, moved by up
/// to a quarter of the picture. Light that comes on or goes out, pans, dissolves and what enters leave enough of it.
/// Bars that both have do not count. Neither is blank.
bool same_shot(const ShotSketch& before, const ShotSketch& now);

}  // namespace afterglow
