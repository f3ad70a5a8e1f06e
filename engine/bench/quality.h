// SPDX-License-Identifier: MIT
// How far a result is from the truth.
#pragma once

#include <span>

#include "bench/results.h"

namespace afterglow::bench {

/// Both hold R, G and B of each pixel. `visible`: measure Quality::visible too, where the picture is not too large.
Quality compare_pictures(std::span<const float> result, std::span<const double> truth, Size size, bool visible = true);

/// Peak signal-to-noise ratio in dB of the values clamped to 0…1 and sRGB-encoded; infinite when they are equal.
double display_psnr(std::span<const float> result, std::span<const double> truth);

}  // namespace afterglow::bench
