// SPDX-License-Identifier: MIT
// What Lua has and presets do not: reading it says so, and why.
#pragma once

#include "script/lua.h"

namespace afterglow::script {

/// Gives the table on top of the stack a metatable that does this for the names of one of Lua's libraries: "" (the
/// globals), "math", "string", "table". Other names stay nil.
void name_absent(lua_State* lua, const char* library);

}  // namespace afterglow::script
