// SPDX-License-Identifier: MIT
// Metadata of PNG, WebP and TIFF files that OpenImageIO 2.4 reads beyond its end. Internal to the room.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/result.h"
#include "image/container_check.h"

namespace afterglow {

/// Of a PNG's chunk, whose data begin at `at`: what is wrong, or null. Takes the orientation of its EXIF and the
/// profile of the first iCCP chunk, as far as it can be unpacked.
const char* png_metadata_fault(const std::string& type, std::ifstream& in, std::uint64_t at, std::uint64_t length,
                               ContainerFacts& facts);
/// Takes its ICC profile and its EXIF. Errors: io.
Result<void> check_webp(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size,
                        ContainerFacts& facts);
/// Errors: io.
Result<void> check_tiff(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size);

}  // namespace afterglow
