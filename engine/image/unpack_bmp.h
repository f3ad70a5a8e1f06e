// SPDX-License-Identifier: MIT
// BMP pictures that are packed as runs (RLE8, RLE4), unpacked: OpenImageIO 2.4 takes those for damaged whose last line
// has an end, as most programs write them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/geometry.h"
#include "core/result.h"

namespace afterglow {

/// The same picture as a file that is not packed. None: it is not packed as runs. What the runs leave out is colour 0.
/// Errors: io (damaged, sides beyond `most` pixels in all).
Result<std::optional<std::vector<std::uint8_t>>> unpack_bmp(const std::filesystem::path& file, std::uint64_t most);

}  // namespace afterglow
