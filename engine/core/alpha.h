// SPDX-License-Identifier: MIT
// What colours are divided by where straight ones are wanted (math.md §19). shaders/lib/alpha.glsl says the same.
#pragma once

#include <algorithm>
#include <limits>

namespace afterglow {

/// What is below counts as 0, as devices and processor modes differ in whether they do.
inline constexpr float kLeastAlpha = std::numeric_limits<float>::min();
/// What is above counts as this, so that light up to 1e30 times it stays finite.
inline constexpr float kMostAlpha = 65504;

/// The divisor for an alpha: 1 where there is no coverage.
template <class Number>
constexpr Number cover_of(Number alpha) {
  return alpha >= Number(kLeastAlpha) ? std::min(alpha, Number(kMostAlpha)) : Number(1);
}

}  // namespace afterglow
