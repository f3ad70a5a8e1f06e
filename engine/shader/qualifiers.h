// SPDX-License-Identifier: MIT
// Macros that stand for nothing but qualifiers (`#define static`, `#define CONSTANT const`). Internal to the room.
#pragma once

#include <vector>

#include "shader/token.h"

namespace afterglow {

/// The tokens outside the preprocessor, with the qualifiers in place of such macros of the same file. They have the
/// place and the line of the word that they replace; each qualifier comes once. A macro with several definitions gives
/// what all of them have.
std::vector<Token> code_tokens(const std::vector<Token>& tokens);

}  // namespace afterglow
