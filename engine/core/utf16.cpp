// SPDX-License-Identifier: MIT
#include "core/utf16.h"

#include <cstddef>

namespace afterglow {

bool is_utf16(std::string_view text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return true;
  constexpr std::size_t kLooked = 8;
  const auto zeros = [&](std::size_t first) {
    for (std::size_t i = 0; i < kLooked; ++i)
      if ((text[i] == '\0') != (i % 2 == first) || static_cast<unsigned char>(text[i]) >= 0x80) return false;
    return true;
  };
  return text.size() >= kLooked && (zeros(0) || zeros(1));
}

}  // namespace afterglow
