// SPDX-License-Identifier: MIT
#include "image/claimed_size.h"

#include <algorithm>
#include <string_view>

#include "image/container_bytes.h"

namespace afterglow {
namespace {

/// RFC 9649: the first chunk is VP8X with the canvas, or the picture itself.
Size webp_size(std::span<const unsigned char> head) {
  const unsigned char* data = &head[20];
  const std::string_view chunk(reinterpret_cast<const char*>(&head[12]), 4);
  if (chunk == "VP8X") return claimed_sides(little_endian(data + 4, 3) + 1, little_endian(data + 7, 3) + 1);
  if (chunk == "VP8L") {
    const std::uint32_t bits = little_endian(data + 1, 4);
    return claimed_sides((bits & 0x3fff) + 1, (bits >> 14 & 0x3fff) + 1);
  }
  return claimed_sides(little_endian(data + 6, 2) & 0x3fff, little_endian(data + 8, 2) & 0x3fff);
}

}  // namespace

Size claimed_sides(std::uint64_t width, std::uint64_t height) {
  constexpr std::uint64_t kLargest = 0x7fffffff;
  return {static_cast<int>(std::min(width, kLargest)), static_cast<int>(std::min(height, kLargest))};
}

std::optional<ClaimedSize> claimed_size(std::span<const unsigned char> head) {
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  // GIF composes frames over a canvas; WebP decodes a frame and composes it.
  if (text.starts_with("GIF8") && head.size() >= 10)
    return ClaimedSize{claimed_sides(little_endian(&head[6], 2), little_endian(&head[8], 2)), 4};
  if (text.starts_with("RIFF") && head.size() >= 30 && text.substr(8, 4) == "WEBP")
    return ClaimedSize{webp_size(head), 8};
  return {};
}

}  // namespace afterglow
