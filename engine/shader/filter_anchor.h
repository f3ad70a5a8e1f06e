// SPDX-License-Identifier: MIT
// The anchor of a kernel that resamples: GLSL that sets ag_color from image 0, made from a Filter. Internal to the
// room.
#pragma once

#include <string>
#include <string_view>

#include "core/result.h"
#include "shader/kernel.h"

namespace afterglow {

/// What assembled kernels call the function of these statements, where it is no part of main().
inline constexpr std::string_view kFilterFunction = "ag_filter";

/// Statements for main(); they use ag_pixel, ag_image0 and the push constants, and set ag_color. Independent of image
/// sizes. Errors (script): no taps, weights or offsets that are not finite, more texel reads than a kernel should have.
Result<std::string> filter_anchor(const Filter& filter, AxisRatio ratio_x, AxisRatio ratio_y, bool hardware_filter);

/// Whether several rows of the target can be made together with rows of texels that they share.
bool shares_rows(const Filter& filter, AxisRatio ratio_y, int rows);

/// Statements for main() that declare ag_color0 … and set them to the target's rows ag_pixel.y …, where `shares_rows`.
/// Exact fetches only. Errors: as filter_anchor.
Result<std::string> filter_rows(const Filter& filter, AxisRatio ratio_x, AxisRatio ratio_y, int rows);

}  // namespace afterglow
