// SPDX-License-Identifier: MIT
// A picture laid over a picture (math.md §56).
#pragma once

#include <string>

#include "reference/double_image.h"

namespace afterglow::reference {

struct ImageOverlay {
  std::string blend = "normal";
  enum class Fit { contain, cover, stretch, tile } fit = Fit::contain;
  double size = 1, x = 0.5, y = 0.5, margin = 0, intensity = 1;
  double tile_scale = 1;  ///< px of the picture for a texel of tiles
};

/// `over` so large that it covers a picture of this size, bilinear where it is enlarged.
DoubleImage covering(const DoubleImage& over, Size target);

DoubleImage image_overlay(const DoubleImage& source, const DoubleImage& over, const ImageOverlay& s);

}  // namespace afterglow::reference
