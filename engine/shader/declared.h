// SPDX-License-Identifier: MIT
// The variables that a file of GLSL declares in its functions and beside them, found by its tokens. Internal to the
// room.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "shader/token.h"

namespace afterglow {

/// A variable that may be read before it has a value.
struct Unset {
  /// `argument`: an `out` one, which its function may leave as it is; `result`: what a function may end without.
  enum class Kind { local, argument, global, result };
  std::string name;
  int line = 0;
  Kind kind = Kind::local;
  std::size_t at = 0;     ///< byte offset behind the declaration, or the function's first brace; not of globals
  std::string type = {};  ///< of a result
};

/// Adds what a function declares without a value: `arguments` are the tokens between its parentheses, `body` those from
/// its first brace to its last. What stands in the head of a loop or alone behind `if` and `else` is not found.
void find_unset(std::span<const Token* const> arguments, std::span<const Token* const> body, std::vector<Unset>& out);

/// Adds the result of a function whose last statement is no `return`: whether its end is reached, the compiler finds
/// out. Types that are no single word are left out.
void find_unset_result(const Token& type, const Token& name, std::span<const Token* const> body,
                       std::vector<Unset>& out);

}  // namespace afterglow
