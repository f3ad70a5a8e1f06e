// SPDX-License-Identifier: MIT
#include "shader/levels.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace afterglow {
namespace {

bool is_zero(std::string_view number) {
  return number.find_first_not_of("0.uUfF") == std::string_view::npos && number.find('0') != std::string_view::npos;
}

/// Whether the third argument of the call whose parenthesis is at `open` is there, and not 0: a number, or a name.
bool asks_for_level(const std::vector<Token>& tokens, std::size_t open) {
  const std::size_t end = after_closing(tokens, open) - 1;
  int depth = 0, argument = 1;
  for (std::size_t at = open + 1; at < end; ++at) {
    if (opens(tokens[at])) ++depth;
    if (closes(tokens[at])) --depth;
    if (depth == 0 && tokens[at].is(",")) ++argument;
    const bool conversion = tokens[at].is("int") || tokens[at].is("float");
    const bool number = tokens[at].kind == TokenKind::number;
    if (argument == 3 && ((number && !is_zero(tokens[at].text)) || (tokens[at].is_identifier() && !conversion)))
      return true;
  }
  return false;
}

}  // namespace

std::optional<int> level_line(const std::vector<Token>& tokens) {
  for (std::size_t at = 0; at + 1 < tokens.size(); ++at)
    if ((tokens[at].is("textureLod") || tokens[at].is("texelFetch") || tokens[at].is("texture")) &&
        tokens[at + 1].is("(") && asks_for_level(tokens, at + 1))
      return tokens[at].line;
  return std::nullopt;
}

}  // namespace afterglow
