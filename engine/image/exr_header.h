// SPDX-License-Identifier: MIT
// Reads what an EXR header says, on its own and before any library does: headers lie, and the size of what a library
// would allocate must be known first. No allocation here is larger than the part of the file that covers it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "core/result.h"

namespace afterglow {

enum class ExrChannelType { uint32, half, float32 };

struct ExrChannel {
  std::string name;
  ExrChannelType type = ExrChannelType::half;
  int x_sampling = 1, y_sampling = 1;

  std::uint64_t sample_bytes() const { return type == ExrChannelType::half ? 2 : 4; }
};

/// Lines that one chunk of an image without tiles holds. `compression`: the number stored in the file; OpenEXR's
/// enumeration has the same.
int chunk_lines_of(int compression);

struct ExrPart {
  std::string name;
  bool deep = false, tiled = false;
  std::vector<ExrChannel> channels;  ///< in the file's order, which is alphabetical
  Rect data_window, display_window;
  Size tile;
  int compression = 0;  ///< the number stored in the file
  int orientation = 1;
  std::string view;                ///< the eye of a stereo picture that it is of
  std::vector<std::string> views;  ///< the eyes that it holds, that of plain names first

  std::uint64_t pixel_bytes() const;
  int chunk_lines() const;  ///< lines that one chunk holds, unless it is tiled
  /// Tiles or groups of lines at full resolution. The file holds the place of each, and OpenEXR takes memory for all of
  /// these when it opens the file, whichever part is wanted.
  std::uint64_t chunks() const;
  /// Fewer bytes than this cannot hold the part, however well it compresses.
  std::uint64_t least_file_bytes() const;
  /// Bytes that OpenEXR needs for its line or tile buffers while it reads with `threads` threads; the largest number
  /// when they are more than that.
  std::uint64_t buffer_bytes(int threads) const;
};

/// Whether the file begins with EXR's magic number.
bool is_exr(const std::filesystem::path& file);

/// Errors: io (not an EXR, truncated header, attribute larger than the file, empty or absurd window, …).
Result<std::vector<ExrPart>> read_exr_header(const std::filesystem::path& file);

}  // namespace afterglow
