// SPDX-License-Identifier: MIT
// How the values of a picture are spread, and what is wrong with some of them.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/geometry.h"

namespace afterglow {

/// Of red, green, blue and luminance (Rec.709 weights), in that order. Linear values in; alpha is not counted.
struct Histogram {
  static constexpr int kCodes = 256;
  static constexpr int kStopsBelow = 12, kStopsAbove = 12, kBinsPerStop = 4;
  static constexpr int kStopBins = (kStopsBelow + kStopsAbove) * kBinsPerStop;

  /// By 8-bit sRGB code; values beyond 0…1 count in the first and the last.
  std::array<std::array<std::uint32_t, kCodes>, 4> display{};
  /// By stops from middle grey (0.18): bin 0 begins at −12 EV; values beyond count in the first and the last, zero and
  /// less in none.
  std::array<std::array<std::uint32_t, kStopBins>, 4> stops{};

  std::uint64_t pixels = 0;              ///< that were looked at
  int every = 1;                         ///< of so many pixels in each direction, one was looked at
  std::uint64_t nan = 0;                 ///< pixels with a red, green or blue that is no number; counted nowhere else
  std::uint64_t infinite = 0;            ///< …that is infinite; counted nowhere else
  std::uint64_t negative = 0;            ///< pixels with a red, green or blue below 0
  std::uint64_t above_one = 0;           ///< …above 1: more than a display shows
  std::array<float, 3> least{}, most{};  ///< of the finite red, green and blue
};

/// `rgba`: rows from the top without padding. Looks at no more than about `most_pixels`, in a regular grid.
Histogram histogram_of(std::span<const float> rgba, Size size, std::uint64_t most_pixels = 1u << 20);

/// sRGB code of a linear value, as an 8-bit display file has it.
int display_code(float linear);

}  // namespace afterglow
