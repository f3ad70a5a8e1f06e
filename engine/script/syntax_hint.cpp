// SPDX-License-Identifier: MIT
#include "script/syntax_hint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

#include "core/ascii.h"
#include "core/printable.h"
#include "core/text.h"

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

std::string_view character_of(std::string_view line, std::size_t at) {
  std::size_t end = at + 1;
  while (end < line.size() && (static_cast<unsigned char>(line[end]) & 0xC0) == 0x80) ++end;
  return line.substr(at, end - at);
}

/// Where something begins in a line, outside of its texts; npos: nowhere. Long texts and comments are not known.
std::size_t find_in_code(std::string_view line, std::string_view what) {
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (quote != 0) {
      if (line[i] == '\\') ++i;
      if (i < line.size() && line[i] == quote) quote = 0;
    } else if (line[i] == '"' || line[i] == '\'') {
      quote = line[i];
    } else if (line.substr(i).starts_with(what)) {
      return i;
    }
  }
  return std::string_view::npos;
}

/// The first character of a line, outside of its texts, that begins with this byte; else within them: long texts and
/// comments may begin on lines above.
std::string_view character_at(std::string_view line, char first) {
  std::size_t at = find_in_code(line, {&first, 1});
  if (at == std::string_view::npos) at = line.find(first);
  return at == std::string_view::npos ? std::string_view() : character_of(line, at);
}

/// The line without a comment at its end and without blanks around it.
std::string code_of(std::string_view line) { return trim(line.substr(0, find_in_code(line, "--"))); }

/// Can another value follow this without a comma: does it end as a value does?
bool ends_a_value(std::string_view code) {
  return !code.empty() &&
         (is_name_char(code.back()) || std::string_view("}])\"'").find(code.back()) != std::string_view::npos);
}

/// Can a value or its name begin so? Words of Lua's own begin statements: there a '}' is missing, or an `end`.
bool begins_a_value(std::string_view token) {
  constexpr std::string_view kStatements =
      " and break do else elseif end for goto if in local or repeat return then until while ";
  if (token.empty() || kStatements.find(" " + std::string(token) + " ") != std::string_view::npos) return false;
  return is_name_char(token[0]) || token[0] == '"' || token[0] == '\'' || token[0] == '{' || token[0] == '-';
}

/// "mode" of "mode: 3" and "mode: \"a\"", not of "g:pass"; empty: there is no such thing.
std::string word_before_colon(std::string_view code) {
  const std::size_t colon = code.find(':');
  if (colon == std::string_view::npos || code.substr(colon).starts_with("::")) return {};
  if (colon + 1 < code.size() && is_name_char(code[colon + 1]) && !is_digit(code[colon + 1])) return {};
  std::size_t end = colon;
  while (end > 0 && code[end - 1] == ' ') --end;
  std::size_t begin = end;
  while (begin > 0 && is_name_char(code[begin - 1])) --begin;
  return std::string(code.substr(begin, end - begin));
}

}  // namespace

std::string_view line_of(std::string_view text, int line) {
  for (int i = 1; i < line; ++i) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  return text.substr(0, text.find('\n'));
}

void name_missing(Error& error, std::string_view text) {
  constexpr std::string_view kNear = " near '";
  const std::size_t at = error.message.rfind(kNear);
  if (at == std::string::npos || !error.message.ends_with('\'')) return;
  const std::size_t begin = at + kNear.size();
  const std::string token = error.message.substr(begin, error.message.size() - 1 - begin);
  const std::string code = code_of(line_of(text, error.line));
  const bool colon = error.message.starts_with("<name> expected") || error.message.starts_with("function arguments");
  if (const std::string name = colon ? word_before_colon(code) : ""; !name.empty()) {
    error.allowed = name + " = …, with a sign of equality";
    return;
  }
  const bool closes = error.message.starts_with("'}' expected") || error.message.starts_with("')' expected");
  if (!closes || !begins_a_value(token)) return;
  constexpr int kMostEmpty = 20;  // each look is as long as the text before it
  int line = error.line - 1;
  const int first = std::max(line - kMostEmpty, 0);
  while (line > first && code_of(line_of(text, line)).empty()) --line;
  if (line < 1 || !code.starts_with(token) || !ends_a_value(code_of(line_of(text, line)))) {
    error.message += "; a comma may be missing before it";
    return;
  }
  error.message += fmt::format(" in line {}; a comma may be missing at the end of this line", error.line);
  error.line = line;
}

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
