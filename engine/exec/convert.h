// SPDX-License-Identifier: MIT
// Pixels between the host's floats and the formats of device images.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "gpu/device.h"

namespace afterglow {

/// Writes `width` pixels of 1 to 4 channels in `format` (R32F: the first channel; RGBA32F, RGBA16F: missing colours are
/// 0, missing alpha is 1). Returns how many values were held at ±65504.
std::uint64_t pack_row(const float* from, int channels, int width, VkFormat format, std::byte* to);

/// Reads `width` pixels of 1, 2 or 4 channels of floats or halves into RGBA, missing ones as above. Returns how many
/// half values are ±65504.
std::uint64_t unpack_row(const std::byte* from, VkFormat format, int width, float* rgba);

/// The same, but leaves the alphas in `rgba` as they are.
std::uint64_t unpack_row_rgb(const std::byte* from, VkFormat format, int width, float* rgba);

/// Whether the alpha of some pixel of RGBA32F, RGBA16F or RGBA8 is (+)0.
bool any_alpha_zero(const std::byte* from, VkFormat format, int width);

/// Calls `row(y)` for every row, over threads when the rows together are large; returns the sum of what it returned.
std::uint64_t over_rows(int rows, std::size_t bytes_per_row, const std::function<std::uint64_t(int y)>& row);

}  // namespace afterglow
