// SPDX-License-Identifier: MIT
// What is told of a picture that was read: what of it is unusual, and what had to be mended.
#pragma once

#include <filesystem>
#include <string>

#include "core/diagnostics.h"
#include "image/color_encoding.h"
#include "image/picture.h"

namespace afterglow {

/// "color: 2 NaN, 1 +Inf, first at pixel 5,3: (nan, 0.25, inf, 1)" for each layer.
std::string non_finite_text(const Picture& picture);

/// Pixels that are not square, and overscan.
void report_shape(const Picture& picture, const std::filesystem::path& file, Diagnostics& diagnostics);

/// Colours outside of Rec.709, and values that were not finite.
void report_values(const Picture& picture, const ColorEncoding& encoding, NanPolicy policy,
                   const std::filesystem::path& file, Diagnostics& diagnostics);

}  // namespace afterglow
