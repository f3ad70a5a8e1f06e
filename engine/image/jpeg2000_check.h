// SPDX-License-Identifier: MIT
// Sizes of a JPEG 2000 file, which OpenJPEG decodes whole as soon as it is opened. Internal to the room.
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>

#include "core/result.h"
#include "image/claimed_size.h"

namespace afterglow {

/// Nothing when it has no size, which its reader says. Errors: io (channels of different sizes, which OpenImageIO 2.4
/// reads beyond their memory; a colour profile that it reads beyond its end).
Result<std::optional<ClaimedSize>> check_jpeg2000(const std::filesystem::path& file, std::ifstream& in,
                                                  std::uint64_t size);

}  // namespace afterglow
