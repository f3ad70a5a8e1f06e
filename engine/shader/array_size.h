// SPDX-License-Identifier: MIT
// How many elements an array of parameters has. Internal to the room.
#pragma once

#include <optional>
#include <vector>

#include "shader/token.h"

namespace afterglow {

/// The number that a token says: a literal, or a name that a `#define` or a `const int` before it gives a literal, the
/// same one wherever that is done. Empty: it says none.
std::optional<int> array_size(const std::vector<Token>& tokens, const Token& size);

}  // namespace afterglow
