// SPDX-License-Identifier: MIT
// A quick look at samples: do any need mending?
#pragma once

#include <cstddef>

namespace afterglow {

/// Whether every value is 0 or between kSmallestColor and kLargestColor (image/picture.h). Mending changes none of
/// these, neither in colours nor in alpha. NaN, infinities, negative values, -0 and subnormal numbers are not plain.
bool all_plain(const float* values, std::size_t count);

}  // namespace afterglow
