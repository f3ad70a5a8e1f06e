// SPDX-License-Identifier: MIT
// `setmetatable` of scripts, whose metatables no limit could hold otherwise: a chain of tables that call each other
// runs in one loop of Lua's own, weak tables show when garbage is collected and make collecting slow, finalizers run
// unseen.
#pragma once

#include "script/lua.h"

namespace afterglow::script {

/// setmetatable(table, metatable): what the metatable holds at this moment counts, in a copy that scripts cannot reach
/// and that `getmetatable` shows as the metatable itself. Throws ScriptError for __gc, __mode, and a __call that is no
/// function.
int do_setmetatable(lua_State* lua);

/// Does the value's metatable forbid changes of it (`__metatable`)?
bool is_protected(lua_State* lua, int index);

}  // namespace afterglow::script
