// SPDX-License-Identifier: MIT
#include "core/utf8.h"

#include <cstddef>
#include <string_view>

namespace afterglow {
namespace {

/// How a character begins: the bytes that follow, and what the first of them may be. (Others are 0x80 to 0xBF.)
struct Beginning {
  std::size_t following;
  unsigned least, most;
};

/// Table 3-7 of the Unicode standard.
Beginning beginning(unsigned byte) {
  if (byte < 0x80) return {0, 0, 0};
  if (byte >= 0xC2 && byte <= 0xDF) return {1, 0x80, 0xBF};
  if (byte >= 0xE0 && byte <= 0xEF) return {2, byte == 0xE0 ? 0xA0u : 0x80u, byte == 0xED ? 0x9Fu : 0xBFu};
  if (byte >= 0xF0 && byte <= 0xF4) return {3, byte == 0xF0 ? 0x90u : 0x80u, byte == 0xF4 ? 0x8Fu : 0xBFu};
  return {1, 1, 0};  // none: no byte may follow
}

struct Character {
  std::size_t bytes;
  bool whole;
};

Character character(std::string_view text, std::size_t at) {
  auto [following, least, most] = beginning(static_cast<unsigned char>(text[at]));
  for (std::size_t i = 1; i <= following; ++i) {
    const unsigned byte = at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0u;
    if (byte < least || byte > most) return {i, false};
    least = 0x80, most = 0xBF;
  }
  return {following + 1, true};
}

}  // namespace

std::string utf8_text(std::string text) {
  std::string out;
  std::size_t kept = 0;  // what comes before is in `out`
  for (std::size_t at = 0; at < text.size();) {
    const Character one = character(text, at);
    if (!one.whole) {
      out.append(text, kept, at - kept).append("\uFFFD");
      kept = at + one.bytes;
    }
    at += one.bytes;
  }
  return kept == 0 ? text : out.append(text, kept);
}

}  // namespace afterglow
