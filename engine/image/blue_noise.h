// SPDX-License-Identifier: MIT
// Blue noise for dithering: thresholds that spread evenly, without the grid of ordered noise or the clumps of white
// noise.
#pragma once

#include <memory>

#include "core/image_data.h"

namespace afterglow {

inline constexpr int kBlueNoiseSize = 64;  ///< sides of the tile, in pixels

/// Threshold in (0, 1) of a pixel of the tile, which repeats; x and y ≥ 0. Each of 4096 evenly spaced ones occurs once.
float blue_noise(int x, int y);

/// The tile as an image for shaders, threshold in red. Made once.
std::shared_ptr<const ImageData> blue_noise_image();

}  // namespace afterglow
