// SPDX-License-Identifier: MIT
// Metadata of PNG, WebP and TIFF files that OpenImageIO 2.4 reads beyond its end. Internal to the room.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/result.h"

namespace afterglow {

/// Of a PNG's chunk, whose data begin at `at`: what is wrong, or null. `profile` gets that of the first iCCP
/// chunk, as far as it can be unpacked.
const char* png_metadata_fault(const std::string& type, std::ifstream& in, std::uint64_t at, std::uint64_t length,
                               std::vector<std::uint8_t>& profile);
/// Its ICC profile; empty: it has none. Errors: io.
Result<std::vector<std::uint8_t>> check_webp(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size);
/// Errors: io.
Result<void> check_tiff(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size);

}  // namespace afterglow
