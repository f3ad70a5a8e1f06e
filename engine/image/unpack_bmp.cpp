// SPDX-License-Identifier: MIT
#include "image/unpack_bmp.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <span>

#include "core/file.h"
#include "image/container_bytes.h"

namespace afterglow {
namespace {

using Bytes = std::span<const std::uint8_t>;

/// Where the lines of codes are, the lowest first, each of `stride` bytes.
struct Lines {
  int width, height;
  std::size_t stride;
  std::vector<std::uint8_t> codes;
  int x = 0, y = 0;

  /// Codes beyond a side are dropped, as other programs do.
  void put(unsigned code) {
    if (x >= width) return;
    if (y < height) codes[static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x)] = code & 255;
    ++x;
  }
};

/// Microsoft, "Bitmap compression": N and a code, N times; 0 and 0: end of line, 1: of the picture, 2: a step to the
/// right and up; 0 and N: N codes as they are, padded to 16 bits. Of 4 bits two codes are in a byte. False: it ends
/// early.
bool unpack_runs(Bytes runs, bool nibbles, Lines& lines) {
  const auto code_of = [&](unsigned byte, unsigned i) { return !nibbles ? byte : i % 2 == 0 ? byte >> 4 : byte & 15; };
  for (std::size_t at = 0; at + 2 <= runs.size() && lines.y <= lines.height;) {
    const unsigned count = runs[at], value = runs[at + 1];
    at += 2;
    if (count > 0) {
      for (unsigned i = 0; i < count; ++i) lines.put(code_of(value, i));
    } else if (value == 0) {
      lines.x = 0;
      ++lines.y;
    } else if (value == 1) {
      return true;
    } else if (value == 2) {
      if (at + 2 > runs.size()) return false;
      lines.x = std::min(lines.width, lines.x + runs[at]);
      lines.y += runs[at + 1];
      at += 2;
    } else {
      const std::size_t bytes = nibbles ? (value + 1) / 2 : value;
      if (bytes > runs.size() - at) return false;
      for (unsigned i = 0; i < value; ++i) lines.put(code_of(runs[at + (nibbles ? i / 2 : i)], i));
      at = std::min(runs.size(), at + bytes + bytes % 2);
    }
  }
  return lines.y >= lines.height;  // without its end mark, as some write it
}

}  // namespace

Result<std::optional<std::vector<std::uint8_t>>> unpack_bmp(const std::filesystem::path& file, std::uint64_t most) {
  constexpr std::size_t kHead = 54;
  constexpr std::uint32_t kOldHeader = 12, kRuns8 = 1, kRuns4 = 2;
  const auto damaged = [&](const char* why) { return Error{ErrorKind::io, why, file.string()}; };
  std::array<unsigned char, kHead> head{};
  std::ifstream(file, std::ios::binary).read(reinterpret_cast<char*>(head.data()), head.size());
  const std::uint32_t packing = little_endian(&head[30], 4), offset = little_endian(&head[10], 4);
  if (little_endian(&head[14], 4) == kOldHeader || (packing != kRuns8 && packing != kRuns4))
    return std::optional<std::vector<std::uint8_t>>();
  AFTERGLOW_TRY(const std::string text, read_file(file, std::size_t{4} << 30));
  const Bytes in(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  if (in.size() < kHead) return damaged("is truncated");
  Lines lines{.width = static_cast<int>(little_endian(&in[18], 4)),
              .height = static_cast<int>(little_endian(&in[22], 4)),
              .stride = 0,
              .codes = {}};
  if (lines.width < 1 || lines.height < 1 || offset < kHead || offset > in.size())
    return damaged("is damaged: its header makes no sense");  // packed ones cannot be upside down
  lines.stride = (static_cast<std::size_t>(lines.width) + 3) / 4 * 4;
  if (lines.stride > most / static_cast<std::uint64_t>(lines.height)) return damaged("is larger than it may be");
  lines.codes.resize(lines.stride * static_cast<std::size_t>(lines.height));
  if (!unpack_runs(in.subspan(offset), packing == kRuns4, lines)) return damaged("is truncated");
  // The short header, and a table with a colour for each code that there may be.
  std::vector<std::uint8_t> out(in.begin(), in.begin() + kHead);
  const std::size_t table = 14 + std::size_t{little_endian(&in[14], 4)};
  const std::uint32_t told = little_endian(&in[46], 4), colors = told != 0 ? told : packing == kRuns4 ? 16u : 256u;
  const std::size_t end = std::min<std::size_t>({offset, table + std::size_t{4} * std::min(colors, 256u), in.size()});
  if (table < end)
    out.insert(out.end(), in.begin() + static_cast<std::ptrdiff_t>(table),
               in.begin() + static_cast<std::ptrdiff_t>(end));
  out.resize(kHead + 4 * 256);
  const auto put = [&](std::size_t at, std::uint64_t value) { put_ordered(&out[at], 4, value, false); };
  put(2, out.size() + lines.codes.size());
  put(10, out.size());
  put(14, 40);
  out[28] = 8;  // bits of a code
  put(30, 0);
  put(34, lines.codes.size());
  put(46, 256);
  out.insert(out.end(), lines.codes.begin(), lines.codes.end());
  return std::optional(std::move(out));
}

}  // namespace afterglow
