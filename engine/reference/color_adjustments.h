// SPDX-License-Identifier: MIT
// Colour adjustments (math.md §8): each step alone, and all in their order.
#pragma once

#include "reference/double_image.h"

namespace afterglow::reference {

struct ColorAdjustments {
  double post_exposure = 0;   ///< EV
  double contrast = 0;        ///< −100…100
  Rgb color_filter{1, 1, 1};  ///< scene-linear
  double hue_shift = 0;       ///< degrees, −180…180
  double saturation = 0;      ///< −100…100
};

/// Around middle grey in LogC; factor = contrast/100 + 1. Factor 0 gives the pivot's grey for every colour.
Rgb adjust_contrast(const Rgb& c, double factor);
/// Turns the hue by `turn` (1 is a full circle).
Rgb shift_hue(const Rgb& c, double turn);
/// Y + factor·(c − Y)
Rgb adjust_saturation(const Rgb& c, double factor);

/// min(c, 60), then every step whose setting is not neutral, with the clamps to ≥ 0 between.
Rgb adjust_color(Rgb c, const ColorAdjustments& settings);
DoubleImage color_adjustments(const DoubleImage& source, const ColorAdjustments& settings);

}  // namespace afterglow::reference
