// SPDX-License-Identifier: MIT
// Names that do not exist: reading one is an error, not nil, so that no misspelt name becomes a setting's default. What
// Lua has and presets do not is told with the reason.
#pragma once

#include "script/lua.h"

namespace afterglow::script {

/// Gives the table on top of the stack a metatable that does this for one of Lua's libraries: "" (the globals), "math",
/// "string", "table". Keys that are no texts stay nil.
void name_absent(lua_State* lua, const char* library);

}  // namespace afterglow::script
