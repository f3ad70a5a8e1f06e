// SPDX-License-Identifier: MIT
// Pictures whose pixels are numbers of colours: OpenImageIO 2.4 looks them up beyond the table. Also what it decodes
// whole. Internal to the room.
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>

#include "core/result.h"
#include "image/claimed_size.h"

namespace afterglow {

/// What the file claims, where its reader keeps the whole picture. Errors: io.
Result<ClaimedSize> check_targa(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size);
Result<std::optional<ClaimedSize>> check_bmp(const std::filesystem::path& file, std::ifstream& in);
/// Whether the fourth byte of a pixel is no alpha, for files that are checked. Targas say it. BMPs without a mask for
/// alpha have none, but some programs write it there all the same: it is one where any pixel has another one than 0.
bool pads_targa(std::ifstream& in, std::uint64_t size);
bool pads_bmp(std::ifstream& in, std::uint64_t size);
/// Its first frame. Errors: io.
Result<void> check_gif(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size);

}  // namespace afterglow
