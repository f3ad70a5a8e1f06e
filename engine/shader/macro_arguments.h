// SPDX-License-Identifier: MIT
// What macros with arguments do to names: the preprocessor leaves parameters and names of fields as they are. Internal
// to the room.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shader/token.h"

namespace afterglow {

/// The names between the parentheses of `#define NAME(…)`, whose '#' is tokens[at]; none: another line.
std::optional<std::vector<std::string_view>> macro_parameters(const std::vector<Token>& tokens, std::size_t at);

/// Of each macro with arguments of a file: which of them are names of fields in every definition (`color.NAME`).
using FieldArguments = std::map<std::string, std::vector<bool>, std::less<>>;
FieldArguments field_arguments(const std::vector<Token>& tokens);

/// An argument of something with parentheses.
struct ArgumentPlace {
  std::string_view name;   ///< of the macro or function
  std::size_t number = 0;  ///< from 0
};

/// The argument that begins with tokens[at], if one does.
std::optional<ArgumentPlace> argument_beginning_at(const std::vector<Token>& tokens, std::size_t at);

}  // namespace afterglow
