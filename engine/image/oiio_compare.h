// SPDX-License-Identifier: MIT
// Part of the OpenImageIO module: see oiio_module.h and metrics.h.
#pragma once

#include "core/result.h"
#include "image/image.h"

namespace afterglow {

Result<double> visible_difference_with_oiio(const Image& a, const Image& b);

}  // namespace afterglow
