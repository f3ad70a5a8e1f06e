// SPDX-License-Identifier: MIT
#include "core/printable.h"

#include <string_view>

namespace afterglow {
namespace {

/// Bytes of the character at `at` if it is none that a line may hold, else 0. Those that turn the direction of text or
/// end lines (U+061C, U+200E, U+200F, U+2028–202E, U+2066–2069) could make a message read as another.
std::size_t unprintable(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t ahead) -> unsigned {
    return at + ahead < text.size() ? static_cast<unsigned char>(text[at + ahead]) : 0u;
  };
  if (byte(0) < 0x20 || byte(0) == 0x7F) return 1;
  if (byte(0) == 0xC2 && (byte(1) & 0xE0) == 0x80) return 2;
  if (byte(0) == 0xD8 && byte(1) == 0x9C) return 2;
  if (byte(0) != 0xE2) return 0;
  const bool marks = byte(1) == 0x80 && (byte(2) == 0x8E || byte(2) == 0x8F || (byte(2) >= 0xA8 && byte(2) <= 0xAE));
  const bool isolates = byte(1) == 0x81 && byte(2) >= 0xA6 && byte(2) <= 0xA9;
  return marks || isolates ? 3 : 0;
}

}  // namespace

std::string printable(std::string text, bool lines) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (lines && text[i] == '\n') continue;
    if (const std::size_t bytes = unprintable(text, i); bytes > 0) text.replace(i, bytes, 1, ' ');
  }
  return text;
}

std::string_view cut_utf8(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) --bytes;
  return text.substr(0, bytes);
}

std::string tidy_message(std::string text, std::size_t limit) {
  if (text.size() > limit) {
    text.resize(cut_utf8(text, limit).size());
    text += "…";
  }
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  return text;
}

}  // namespace afterglow
