// SPDX-License-Identifier: MIT
#include "shader/macro_arguments.h"

#include <algorithm>

namespace afterglow {
namespace {

constexpr std::size_t kMaxArguments = 64;  ///< those beyond are names like any others

bool is_field_of(const FieldArguments& macros, const std::optional<ArgumentPlace>& place) {
  const auto macro = place ? macros.find(place->name) : macros.end();
  return macro != macros.end() && place->number < macro->second.size() && macro->second[place->number];
}

}  // namespace

std::optional<std::vector<std::string_view>> macro_parameters(const std::vector<Token>& tokens, std::size_t at) {
  const int directive = tokens[at].directive;
  const auto is_there = [&](std::size_t i) { return i < tokens.size() && tokens[i].directive == directive; };
  if (at > 0 && tokens[at - 1].directive == directive) return std::nullopt;
  if (directive < 0 || !is_there(at + 3) || !tokens[at].is("#") || !tokens[at + 1].is("define")) return std::nullopt;
  if (!tokens[at + 3].is("(") || tokens[at + 3].offset != tokens[at + 2].end()) return std::nullopt;
  std::vector<std::string_view> names;
  for (std::size_t i = at + 4; is_there(i) && !tokens[i].is(")") && names.size() < kMaxArguments; ++i)
    if (tokens[i].is_identifier()) names.push_back(tokens[i].text);
  return names;
}

FieldArguments field_arguments(const std::vector<Token>& tokens) {
  FieldArguments macros;
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    const auto parameters = macro_parameters(tokens, at);
    if (!parameters) continue;
    std::vector<int> uses(parameters->size()), fields(parameters->size());
    std::size_t body = at + 4;
    while (!tokens[body - 1].is(")") && body < tokens.size() && tokens[body].directive == tokens[at].directive) ++body;
    for (std::size_t i = body; i < tokens.size() && tokens[i].directive == tokens[at].directive; ++i) {
      const auto parameter = std::ranges::find(*parameters, tokens[i].text);
      if (parameter == parameters->end()) continue;
      const auto number = static_cast<std::size_t>(parameter - parameters->begin());
      ++uses[number];
      fields[number] += tokens[i - 1].is(".") || is_field_of(macros, argument_beginning_at(tokens, i));
    }
    std::vector<bool> all;
    for (std::size_t i = 0; i < uses.size(); ++i) all.push_back(uses[i] > 0 && uses[i] == fields[i]);
    const auto [known, fresh] = macros.emplace(tokens[at + 2].text, all);
    for (std::size_t i = 0; !fresh && i < known->second.size(); ++i)
      known->second[i] = known->second[i] && i < all.size() && all[i];
  }
  return macros;
}

std::optional<ArgumentPlace> argument_beginning_at(const std::vector<Token>& tokens, std::size_t at) {
  if (at < 2 || !(tokens[at - 1].is("(") || tokens[at - 1].is(","))) return std::nullopt;
  std::size_t number = 0;
  int depth = 0;
  for (std::size_t i = at; i-- > 1 && number < kMaxArguments;) {
    const Token& token = tokens[i];
    if (token.directive != tokens[at].directive || token.is(";")) break;
    if (depth == 0 && opens(token)) {
      if (!token.is("(") || !tokens[i - 1].is_identifier()) break;
      return ArgumentPlace{tokens[i - 1].text, number};
    }
    if (opens(token)) --depth;
    if (closes(token)) ++depth;
    if (depth == 0 && token.is(",")) ++number;
  }
  return std::nullopt;
}

}  // namespace afterglow
