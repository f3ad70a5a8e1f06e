// SPDX-License-Identifier: MIT
// DPX and Cineon files that OpenImageIO 2.4 reads beyond its memory with, or leaves memory unfilled for. Internal to
// the room.
#pragma once

#include <filesystem>
#include <fstream>

#include "core/result.h"

namespace afterglow {

/// Bytes behind each line that the header does not tell of. Errors: io (malformed, truncated, or a variant that is not
/// read right).
Result<std::uint32_t> check_dpx(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size);
Result<void> check_cineon(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size);

}  // namespace afterglow
