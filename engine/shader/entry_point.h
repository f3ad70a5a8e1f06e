// SPDX-License-Identifier: MIT
// The signature of the function that an author's shader defines for the engine. Internal to the room.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "shader/interface.h"
#include "shader/token.h"

namespace afterglow {

struct EntryPoint {
  std::vector<Token> inputs;  ///< names of the pixel-wise inputs: the arguments of `apply` behind the colour
  bool at_pixel = false;      ///< `apply` ends with the target's pixel
};

/// `name` is that of `kind`; `arguments` are the tokens between its parentheses. Errors (script).
Result<EntryPoint> parse_entry_point(PassKind kind, const Token& result, const Token& name,
                                     std::span<const Token* const> arguments, const std::string& file);

/// The same for kDoneFunction.
Result<void> check_done_function(const Token& result, const Token& name, std::span<const Token* const> arguments,
                                 const std::string& file);

}  // namespace afterglow
