// SPDX-License-Identifier: MIT
// An analogue signal that has come loose (after K. Takahashi's KinoGlitch): whole pixels, random by frame and seed.
#pragma once

#include <cstdint>

#include "reference/double_image.h"

namespace afterglow::reference {

struct Glitch {
  double scan_line_jitter = 0.3;
  double line_height = 2;
  double horizontal_shake = 0, rgb_split = 0.1;
  double vertical_roll = 0;  ///< pictures per second
  bool stretch = false;      ///< past the sides stands their last pixel
  std::uint32_t seed = 0, frame = 1;
  double time = 0;  ///< seconds
};
DoubleImage glitch(const DoubleImage& source, const Glitch& settings);

}  // namespace afterglow::reference
