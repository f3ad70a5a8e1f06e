// SPDX-License-Identifier: MIT
#include "script/syntax_hint.h"

#include <array>
#include <cstdlib>
#include <string>

#include "core/printable.h"

namespace afterglow::script {
namespace {

struct Substitute {
  std::string_view character, instead;
};
constexpr std::string_view kQuotes = "plain quotes: \"text\" or 'text'", kMinus = "a plain minus: -",
                           kSpace = "a plain space";
constexpr std::array<Substitute, 17> kSubstitutes{{{"“", kQuotes},
                                                   {"”", kQuotes},
                                                   {"„", kQuotes},
                                                   {"‟", kQuotes},
                                                   {"‘", kQuotes},
                                                   {"’", kQuotes},
                                                   {"‚", kQuotes},
                                                   {"«", kQuotes},
                                                   {"»", kQuotes},
                                                   {"–", kMinus},
                                                   {"—", kMinus},
                                                   {"−", kMinus},
                                                   {"\xC2\xA0", kSpace},
                                                   {"\xE3\x80\x80", kSpace},
                                                   {"，", "a plain comma: ,"},
                                                   {"＝", "a plain sign: ="},
                                                   {"×", "a plain sign: *"}}};

std::string_view line_of(std::string_view text, int line) {
  for (int i = 1; i < line; ++i) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  return text.substr(0, text.find('\n'));
}

std::string_view character_of(std::string_view line, std::size_t at) {
  std::size_t end = at + 1;
  while (end < line.size() && (static_cast<unsigned char>(line[end]) & 0xC0) == 0x80) ++end;
  return line.substr(at, end - at);
}

/// The first character of a line, outside of its texts, that begins with this byte; else within them: long texts and
/// comments may begin on lines above.
std::string_view character_at(std::string_view line, char first) {
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (quote != 0) {
      if (line[i] == '\\') ++i;
      if (i < line.size() && line[i] == quote) quote = 0;
    } else if (line[i] == '"' || line[i] == '\'') {
      quote = line[i];
    } else if (line[i] == first) {
      return character_of(line, i);
    }
  }
  const std::size_t within = line.find(first);
  return within == std::string_view::npos ? std::string_view() : character_of(line, within);
}

}  // namespace

void name_symbol(Error& error, std::string_view text) {
  constexpr std::string_view kNear = "near '<\\";
  const std::size_t at = error.message.find(kNear);
  if (at == std::string::npos || !error.message.ends_with(">'")) return;
  const int byte = std::atoi(error.message.c_str() + at + kNear.size());
  const std::string_view character = character_at(line_of(text, error.line), static_cast<char>(byte));
  if (byte < 128 || character.empty()) return;
  error.message = error.message.substr(0, at) + "near '" + printable(std::string(character)) + "'";
  error.allowed = "letters, digits and signs of ASCII, outside of texts and comments";
  for (const auto& [known, instead] : kSubstitutes)
    if (character == known) error.allowed = instead;
}

}  // namespace afterglow::script
