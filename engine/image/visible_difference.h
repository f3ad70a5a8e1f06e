// SPDX-License-Identifier: MIT
// Whether people would see a difference: Yee's model of perception, as OpenImageIO has it.
#pragma once

#include "core/result.h"
#include "image/image.h"

namespace afterglow {

/// Share of pixels (0…1) that look different on a display. Both images have 3 channels and the same size; linear light,
/// 1 is white at 100 cd/m². Errors: io (OpenImageIO is not installed), other (it failed).
Result<double> visible_difference(const Image& a, const Image& b);

}  // namespace afterglow
