// SPDX-License-Identifier: MIT
// Files known by their first bytes.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace afterglow {

struct FileSignature {
  std::size_t at;  ///< where the bytes lie
  std::string_view bytes;
  const char* format;  ///< whoever keeps the table says whose name it is
};

/// Of the first that fits; empty: none does.
inline std::string_view format_by_signature(std::span<const FileSignature> known, std::string_view head) {
  for (const FileSignature& one : known)
    if (head.size() >= one.at && head.substr(one.at).starts_with(one.bytes)) return one.format;
  return {};
}

}  // namespace afterglow
