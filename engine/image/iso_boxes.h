// SPDX-License-Identifier: MIT
// The boxes that JPEG 2000, HEIF and AVIF files consist of (ISO/IEC 14496-12, 4.2). Internal to the room.
#pragma once

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

#include "image/container_bytes.h"

namespace afterglow {

struct IsoBox {
  std::string type;
  std::uint64_t begin = 0, end = 0;  ///< of what it holds
};

/// The box at a place before `end`, which it does not reach beyond. Nothing where none can begin.
inline std::optional<IsoBox> iso_box_at(std::ifstream& in, std::uint64_t at, std::uint64_t end) {
  const auto head = bytes_at(in, at, 16);
  if (at >= end || head.size() < 8) return {};
  std::uint64_t length = big_endian(head.data(), 4), begin = at + 8;
  if (length == 1) {
    if (head.size() < 16) return {};
    length = ordered(&head[8], 8, true);
    begin = at + 16;
  }
  const bool rest = length == 0 || length > end - at;
  if (!rest && length < begin - at) return {};
  return IsoBox{std::string(reinterpret_cast<const char*>(&head[4]), 4), std::min(begin, end),
                rest ? end : at + length};
}

}  // namespace afterglow
