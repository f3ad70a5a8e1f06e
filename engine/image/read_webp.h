// SPDX-License-Identifier: MIT
// WebP stills with alpha, by libwebp itself: OpenImageIO 2.4 hands out their colours multiplied by the alpha in 8 bits,
// in which soft edges lose them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/geometry.h"
#include "core/result.h"

namespace afterglow {

/// RGBA, straight, row by row. Errors: io (damaged, of another size).
Result<std::vector<std::uint8_t>> read_webp(const std::filesystem::path& file, const Size& size);

}  // namespace afterglow
