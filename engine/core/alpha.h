// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

namespace afterglow {

/// The least alpha that colours are divided by (math.md §19); what is below counts as 0, as devices and processor modes
/// differ in whether they do. shaders/lib/alpha.glsl says the same.
inline constexpr float kLeastAlpha = std::numeric_limits<float>::min();

}  // namespace afterglow
