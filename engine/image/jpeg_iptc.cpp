// SPDX-License-Identifier: MIT
#include "image/jpeg_iptc.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "image/container_bytes.h"

namespace afterglow {
namespace {

/// IIM 4.2: record 1, data set 90, three bytes: ESC % G, which is UTF-8 (ISO 2022).
constexpr std::array<std::uint8_t, 8> kUtf8{0x1c, 1, 90, 0, 3, 0x1b, '%', 'G'};
constexpr std::string_view kHead("Photoshop 3.0\0008BIM\x04\x04\0\0\0\0",
                                 24);  // name, resource, its empty name, half a size
constexpr std::size_t kLongest = 0xffff;

void put_16(std::uint8_t* at, std::size_t value) {
  at[0] = static_cast<std::uint8_t>(value >> 8);
  at[1] = static_cast<std::uint8_t>(value);
}

/// Of a segment from its length on: the block that kHead begins, which is all that it holds.
bool is_block(std::span<const std::uint8_t> segment) {
  const std::string_view text(reinterpret_cast<const char*>(segment.data()), segment.size());
  return text.size() > 2 + kHead.size() + 2 && text.substr(2, kHead.size()) == kHead;
}

}  // namespace

void tell_iptc_letters(std::vector<std::uint8_t>& jpeg) {
  constexpr std::uint8_t kMark = 0xff, kApp13 = 0xed, kScan = 0xda;
  for (std::size_t at = 2; at + 4 <= jpeg.size() && jpeg[at] == kMark && jpeg[at + 1] != kScan;) {
    const std::size_t length = big_endian(&jpeg[at + 2], 2);
    if (at + 2 + length > jpeg.size()) return;
    const std::span<std::uint8_t> segment(&jpeg[at + 2], length);
    if (jpeg[at + 1] == kApp13 && is_block(segment)) {
      const std::size_t size = 2 + kHead.size(), texts = size + 2;
      const bool ascii = std::ranges::all_of(segment.subspan(texts), [](std::uint8_t c) { return c < 0x80; });
      if (ascii || length + kUtf8.size() > kLongest) return;
      put_16(&segment[0], length + kUtf8.size());
      put_16(&segment[size], big_endian(&segment[size], 2) + kUtf8.size());
      jpeg.insert(jpeg.begin() + static_cast<std::ptrdiff_t>(at + 2 + texts), kUtf8.begin(), kUtf8.end());
      return;
    }
    at += 2 + length;
  }
}

}  // namespace afterglow
