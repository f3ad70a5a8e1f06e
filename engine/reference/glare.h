// SPDX-License-Identifier: MIT
// Light where the lens should have none: anamorphic streaks and lit dirt.
#pragma once

#include <cstdint>

#include "reference/double_image.h"

namespace afterglow::reference {

struct AnamorphicStreaks {
  double threshold = 2, stretch = 0.75, intensity = 0.4;
  Rgb tint{0.55, 0.55, 1};
};
DoubleImage anamorphic_streaks(const DoubleImage& source, const AnamorphicStreaks& settings);

struct LensDirt {
  double intensity = 1, threshold = 1, density = 0.4, size = 0.06;
  std::uint32_t seed = 0;
  const DoubleImage* texture = nullptr;  ///< of the dirt, in place of spots
};
/// Opacity of the dirt, 0…1, in all channels; the larger cells are `cell` pixels wide.
DoubleImage lens_dirt_spots(Size size, double cell, const LensDirt& settings);
DoubleImage lens_dirt(const DoubleImage& source, const LensDirt& settings);

}  // namespace afterglow::reference
