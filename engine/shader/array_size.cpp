// SPDX-License-Identifier: MIT
#include "shader/array_size.h"

#include <cmath>

#include "shader/literal.h"

namespace afterglow {
namespace {

std::optional<int> whole_number(const Token& token) {
  const auto value = literal_value(token, ParamType::int1);
  return value ? std::optional(static_cast<int>(*value)) : std::nullopt;
}

/// What the tokens from `at` on give the name: "define NAME 8" that is all of its line, or "const int NAME = 8;".
std::optional<int> given_at(const std::vector<Token>& tokens, std::size_t at, std::string_view name) {
  const auto is = [&](std::size_t ahead, std::string_view text) {
    return at + ahead < tokens.size() && tokens[at + ahead].is(text);
  };
  const bool macro = tokens[at].directive >= 0;
  if (macro && is(0, "define") && is(1, name) && at + 2 < tokens.size()) {
    const bool whole = at + 3 >= tokens.size() || tokens[at + 3].directive != tokens[at].directive;
    return whole ? whole_number(tokens[at + 2]) : std::nullopt;
  }
  if (!macro && is(0, "const") && is(1, "int") && is(2, name) && is(3, "=") && is(5, ";"))
    return whole_number(tokens[at + 4]);
  return std::nullopt;
}

}  // namespace

std::optional<int> array_size(const std::vector<Token>& tokens, const Token& size) {
  if (!size.is_identifier()) return whole_number(size);
  std::optional<int> found;
  for (std::size_t at = 0; at < tokens.size() && tokens[at].offset < size.offset; ++at) {
    const auto given = given_at(tokens, at, size.text);
    if (given && found && *given != *found) return std::nullopt;
    if (given) found = given;
  }
  return found;
}

}  // namespace afterglow
