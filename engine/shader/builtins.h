// SPDX-License-Identifier: MIT
// Names that GLSL, or the engine's prelude, gives to every shader. Internal to the room.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace afterglow {

/// A built-in function of GLSL 4.60: an author's own function of this name would hide or redefine it.
bool is_builtin_function(std::string_view name);
/// A helper of shaders/lib/prelude.glsl.
bool is_prelude_function(std::string_view name);

/// All of them, for "did you mean".
const std::vector<std::string>& builtin_functions();
const std::vector<std::string>& prelude_functions();

}  // namespace afterglow
