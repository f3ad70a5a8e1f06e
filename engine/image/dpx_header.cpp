// SPDX-License-Identifier: MIT
#include "image/dpx_header.h"

#include <array>
#include <cstdint>
#include <vector>

#include "image/container_bytes.h"
#include "image/metadata.h"

namespace afterglow {

void set_dpx_name_and_time(const Picture& picture, const std::string& name, OutputFile& out) {
  constexpr std::uint64_t kNameAt = 36, kTimeAt = 136;
  constexpr std::size_t kNameBytes = 100, kTimeBytes = 24;
  const std::uint64_t end = out.position();
  std::string field = name;
  field.resize(kNameBytes - 1);
  field.resize(kNameBytes);
  out.seek(kNameAt);
  out.write(field.data(), field.size());
  if (!picture.facts || !find_metadata(picture.facts->metadata, "DateTime")) {
    const std::array<char, kTimeBytes> unknown{};
    out.seek(kTimeAt);
    out.write(unknown.data(), unknown.size());
  }
  out.seek(end);
}

void pad_dpx_lines(OutputFile& out) {
  constexpr std::uint64_t kOffsetAt = 4, kFileSizeAt = 16, kLinesAt = 776;
  std::array<unsigned char, 4> magic{};
  out.seek(0);
  if (!out.read(magic.data(), magic.size())) return;
  const bool big = magic[0] == 'S';
  const auto number_at = [&](std::uint64_t at) {
    std::array<unsigned char, 4> bytes{};
    out.seek(at);
    return out.read(bytes.data(), 4) ? static_cast<std::uint32_t>(ordered(bytes.data(), 4, big)) : 0u;
  };
  const auto put = [&](std::uint64_t at, std::uint64_t value) {
    std::array<unsigned char, 4> bytes{};
    put_ordered(bytes.data(), bytes.size(), value, big);
    out.seek(at);
    out.write(bytes.data(), 4);
  };
  const std::uint64_t end = out.size(), offset = number_at(kOffsetAt), lines = number_at(kLinesAt);
  if (lines == 0 || offset == 0 || offset > end || (end - offset) % lines != 0) return;
  const std::uint64_t line = (end - offset) / lines, whole = (line + 3) / 4 * 4;
  if (whole == line) return;
  std::vector<char> bytes(whole);
  for (std::uint64_t i = lines; i-- > 0;) {  // from the last one on: none is written over
    out.seek(offset + i * line);
    if (!out.read(bytes.data(), line)) return;
    out.seek(offset + i * whole);
    out.write(bytes.data(), whole);
  }
  put(kFileSizeAt, offset + lines * whole);
  put(kDpxLinePaddingAt, whole - line);
  out.seek(offset + lines * whole);
}

}  // namespace afterglow
