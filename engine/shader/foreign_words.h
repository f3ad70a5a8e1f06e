// SPDX-License-Identifier: MIT
// Words of other shading languages (HLSL, Metal, older GLSL) in shaders of authors who come from there. Internal to the
// room.
#pragma once

#include <string_view>

namespace afterglow {

/// What GLSL, or a helper of the engine, has for a word; empty: nothing is known.
std::string_view in_glsl(std::string_view word);

/// Why a name of GLSL has no place in a stage or a library; empty: it has.
std::string_view why_not(std::string_view name);

}  // namespace afterglow
