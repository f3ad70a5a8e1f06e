// SPDX-License-Identifier: MIT
// PGM and PPM files of more than eight bits: OpenImageIO 2.4 multiplies their samples in integers that overflow, so
// that white is not 1. Internal to the room.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

#include "core/geometry.h"
#include "core/result.h"

namespace afterglow {

struct DeepPnm {
  Size size;
  int channels = 1;                                                ///< 1 or 3
  int most = 65535;                                                ///< what stands for 1
  bool text = false;                                               ///< numbers, not bytes
  std::uint64_t data_at = 0;                                       ///< of the first sample
  std::size_t sample_bytes() const { return most > 255 ? 2 : 1; }  ///< unless it is text
  std::uint64_t samples() const {
    return static_cast<std::uint64_t>(size.area()) * static_cast<std::uint64_t>(channels);
  }
};

/// None: it is no such file, or OpenImageIO reads it right. Errors: io (a largest value that PNM does not have, a file
/// that is too short for its pixels).
Result<std::optional<DeepPnm>> deep_pnm(const std::filesystem::path& file, std::ifstream& in, std::uint64_t file_size);
/// All samples, 0…1, channel by channel within pixels, row by row. Errors: io.
Result<std::vector<float>> read_deep_pnm(const std::filesystem::path& file, const DeepPnm& form);

}  // namespace afterglow
