// SPDX-License-Identifier: MIT
#include "image/jpeg2000_check.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "image/container_bytes.h"
#include "image/iso_boxes.h"
#include "image/metadata_check.h"

namespace afterglow {
namespace {

constexpr std::uint64_t kMostProfile = 16u << 20;

/// Where the codestream begins. Looks at colour profiles on its way.
Result<std::optional<std::uint64_t>> codestream(const std::filesystem::path& file, std::ifstream& in,
                                                std::uint64_t size) {
  std::uint64_t at = 0, end = size;
  std::vector<IsoBox> outer;
  while (true) {
    const auto box = iso_box_at(in, at, end);
    if (!box) {
      if (outer.empty()) return std::optional<std::uint64_t>();
      at = outer.back().end, end = size;
      outer.pop_back();
      continue;
    }
    if (box->type == "jp2c") return std::optional(box->begin);
    if (box->type == "colr" && box->end - box->begin > 3 && box->end - box->begin < kMostProfile) {
      const auto colr = bytes_at(in, box->begin, box->end - box->begin);
      if (colr.size() > 3 && colr[0] == 2)
        if (const char* why = icc_fault(Bytes(colr).subspan(3))) return malformed(file, why);
    }
    if (box->type == "jp2h" && outer.empty()) {
      outer.push_back(*box);
      at = box->begin, end = box->end;
    } else {
      at = box->end;
    }
  }
}

std::uint64_t up(std::uint64_t n, std::uint64_t d) { return (n + d - 1) / d; }

/// A channel's first place and its number of places along one side of the picture, at the whole picture's scale.
struct Extent {
  std::uint64_t begin = 0, end = 0;
  bool operator==(const Extent&) const = default;
};
Extent extent(std::uint64_t begin, std::uint64_t end, std::uint64_t step) {
  const std::uint64_t first = up(begin, step), count = up(end, step) - first;
  return {first, first + count * step};
}

}  // namespace

Result<std::optional<ClaimedSize>> check_jpeg2000(const std::filesystem::path& file, std::ifstream& in,
                                                  std::uint64_t size) {
  constexpr std::size_t kFixed = 42;  // of the codestream's first two markers, up to the channels
  constexpr std::size_t kMostChannels = 16384;
  const auto magic = bytes_at(in, 0, 4);
  std::uint64_t at = 0;
  if (magic.size() == 4 && big_endian(magic.data(), 4) != 0xff4fff51) {
    AFTERGLOW_TRY(const auto found, codestream(file, in, size));
    if (!found) return std::optional<ClaimedSize>();
    at = *found;
  }
  const auto head = bytes_at(in, at, kFixed + 3 * kMostChannels);
  if (head.size() < kFixed || big_endian(head.data(), 4) != 0xff4fff51) return std::optional<ClaimedSize>();
  const auto number = [&](std::size_t place) { return std::uint64_t{big_endian(&head[place], 4)}; };
  const std::uint64_t x1 = number(8), y1 = number(12), x0 = number(16), y0 = number(20);
  const std::size_t channels = big_endian(&head[40], 2);
  if (x0 >= x1 || y0 >= y1 || channels == 0 || kFixed + 3 * channels > head.size()) return std::optional<ClaimedSize>();
  if (y0 > 0) return malformed(file, "does not begin at its first line, which cannot be read right");
  std::optional<Extent> across, down;
  for (std::size_t c = 0; c < channels; ++c) {
    const std::uint64_t dx = head[kFixed + 3 * c + 1], dy = head[kFixed + 3 * c + 2];
    if (dx == 0 || dy == 0) return std::optional<ClaimedSize>();
    const Extent x = extent(x0, x1, dx), y = extent(y0, y1, dy);
    if (across && (x != *across || y != *down))
      return malformed(file, "has channels of different sizes, which cannot be read right");
    across = x, down = y;
  }
  return std::optional(ClaimedSize{claimed_sides(x1 - x0, y1 - y0), 8 * channels});
}

}  // namespace afterglow
