// SPDX-License-Identifier: MIT
// SGI pictures before OpenImageIO reads them: it believes their tables of rows, and writes as many pixels as a row
// says. Internal to the room.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "core/result.h"

namespace afterglow {

/// `in` is the file, of `size` bytes, which begins as SGI pictures do. What it reads is at most the file, once.
/// Errors: io (malformed, truncated, or with rows that do not give as many pixels as the picture is wide).
Result<void> check_sgi(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size);

}  // namespace afterglow
