// SPDX-License-Identifier: MIT
#include "shader/fixed_alpha.h"

#include <cstddef>

namespace afterglow {
namespace {

/// `vec4(…, NUMBER);`, from `at` on.
bool ends_with_number(const std::vector<Token>& tokens, std::size_t at) {
  if (at + 1 >= tokens.size() || !tokens[at].is("vec4") || !tokens[at + 1].is("(")) return false;
  const std::size_t behind = after_closing(tokens, at + 1);
  return behind < tokens.size() && tokens[behind].is(";") && tokens[behind - 2].kind == TokenKind::number &&
         tokens[behind - 3].is(",");
}

/// The brace that begins the function's body; the number of tokens when there is none.
std::size_t body_of(const std::vector<Token>& tokens, std::string_view function) {
  for (std::size_t at = 0; at + 1 < tokens.size(); ++at) {
    if (!tokens[at].is(function) || tokens[at].directive >= 0 || !tokens[at + 1].is("(")) continue;
    const std::size_t behind = after_closing(tokens, at + 1);
    if (behind < tokens.size() && tokens[behind].is("{")) return behind;
  }
  return tokens.size();
}

}  // namespace

std::optional<int> fixed_alpha_line(const std::vector<Token>& tokens, std::string_view function) {
  std::optional<int> line;
  const std::size_t begin = body_of(tokens, function), end = after_closing(tokens, begin);
  for (std::size_t at = begin; at < end; ++at) {
    if (!tokens[at].is("return")) continue;
    if (!ends_with_number(tokens, at + 1)) return std::nullopt;
    if (!line) line = tokens[at].line;
  }
  return line;
}

}  // namespace afterglow
