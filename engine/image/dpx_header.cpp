// SPDX-License-Identifier: MIT
#include "image/dpx_header.h"

#include <array>
#include <cstdint>

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

}  // namespace afterglow
