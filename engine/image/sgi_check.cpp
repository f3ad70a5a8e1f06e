// SPDX-License-Identifier: MIT
#include "image/sgi_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <compare>
#include <span>
#include <vector>

#include "image/container_bytes.h"

namespace afterglow {
namespace {

struct SgiRow {
  std::uint32_t place = 0, length = 0;
  auto operator<=>(const SgiRow&) const = default;
};

/// A row is a list of runs. Each begins with a number of `unit` bytes: how many pixels (7 bits; 0 ends the row), and
/// whether that many values follow or one for all.
bool sgi_row_fits(std::span<const unsigned char> row, std::size_t unit, std::size_t width) {
  std::size_t at = 0;
  while (at < row.size()) {
    if (at + unit > row.size()) return false;
    const std::uint32_t head = big_endian(&row[at], unit);
    const std::size_t count = head & 0x7f;
    at += unit;
    if (count == 0) break;
    at += unit * ((head & 0x80) != 0 ? count : 1);
    if (at > row.size() || count > width) return false;
    width -= count;
  }
  return width == 0;
}

}  // namespace

Result<void> check_sgi(const std::filesystem::path& file, std::ifstream& in, std::uint64_t size) {
  constexpr std::uint64_t kTables = 512, kMostChannels = 32;
  const auto read = [&](std::uint64_t at, std::span<unsigned char> into) {
    in.seekg(static_cast<std::streamoff>(at));
    return fill(in, into.data(), into.size());
  };
  std::array<unsigned char, 12> head{};
  if (!read(0, head)) return malformed(file, "is truncated");
  const bool packed = head[2] == 1;
  const std::size_t unit = head[3];
  const std::uint32_t dimensions = big_endian(&head[4], 2), width = big_endian(&head[6], 2);
  const std::uint64_t height = big_endian(&head[8], 2), planes = big_endian(&head[10], 2);
  if (head[2] > 1 || unit < 1 || unit > 2 || dimensions < 1 || dimensions > 3)
    return malformed(file, "is a malformed SGI picture");
  const std::uint64_t rows = (dimensions > 1 ? height : 1) * (dimensions > 2 ? planes : 1), listed = height * planes;
  if (width == 0 || rows == 0) return malformed(file, "has no pixels");
  if (planes > kMostChannels)  // the reader takes seconds to name thousands
    return malformed(file, fmt::format("has {} channels, more than the {} that are read", planes, kMostChannels));
  if (!packed) return {};
  if (rows > listed) return malformed(file, "is a malformed SGI picture");
  if (kTables + listed * 8 > size) return malformed(file, "is truncated");
  std::vector<unsigned char> places(rows * 4), lengths(rows * 4);
  if (!read(kTables, places) || !read(kTables + listed * 4, lengths)) return malformed(file, "is truncated");
  std::vector<SgiRow> table(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    table[i] = {big_endian(&places[i * 4], 4), big_endian(&lengths[i * 4], 4)};
    if (std::uint64_t{table[i].place} + table[i].length > size) return malformed(file, "is truncated");
  }
  // Rows that are alike may be stored once. Others overlap in no file that was made to be read.
  std::ranges::sort(table);
  table.erase(std::unique(table.begin(), table.end()), table.end());
  const std::uint64_t most = std::uint64_t{2} * unit * width + unit;  // each pixel a run, and the end
  std::uint64_t looked_at = 0;
  std::vector<unsigned char> row;
  for (const SgiRow& next : table) {
    row.resize(std::min<std::uint64_t>(next.length, most));
    looked_at += row.size();
    if (looked_at > size) return malformed(file, "is damaged: its rows overlap");
    if (!read(next.place, row)) return malformed(file, "is truncated");
    if (!sgi_row_fits(row, unit, width)) return malformed(file, "is damaged: a row has too few or too many pixels");
  }
  return {};
}

}  // namespace afterglow
