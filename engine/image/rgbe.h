// SPDX-License-Identifier: MIT
// The numbers that a Radiance file can hold: three mantissas of eight bits and one exponent.
#pragma once

#include <span>

namespace afterglow {

/// RGB, each pixel to the nearest that RGBE holds as readers have it that take mantissas as they stand. Writers that
/// cut off what lies between (OpenImageIO, Radiance) then leave it: else a round trip loses 0.36 % of the light on
/// average. What is below 0 becomes 0.
void round_to_rgbe(std::span<float> rgb);

}  // namespace afterglow
