// SPDX-License-Identifier: MIT
// Shaders that give every pixel the same alpha. Internal to the room.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "shader/token.h"

namespace afterglow {

/// The line of the first `return vec4(…, NUMBER);` of a function, where it returns nothing else; else nothing.
std::optional<int> fixed_alpha_line(const std::vector<Token>& tokens, std::string_view function);

}  // namespace afterglow
