// SPDX-License-Identifier: MIT
// Which files are videos, by their first bytes.
#pragma once

#include <filesystem>
#include <string>

namespace afterglow {

/// FFmpeg's name of the container ("mov", "matroska", "gif"); empty: no video that is read. Pictures that may move
/// (GIF, PNG, WebP) are videos when they have more than one frame. Files that
/// cannot be opened are none, nor are pipes.
std::string movie_format(const std::filesystem::path& file);

}  // namespace afterglow
