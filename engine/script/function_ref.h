// SPDX-License-Identifier: MIT
// A Lua function that a script gave and that is called later.
#pragma once

#include "core/result.h"
#include "script/lua.h"

namespace afterglow::script {

/// A function in Lua's registry, or none.
struct FunctionRef {
  int ref = LUA_NOREF;
  bool set() const { return ref != LUA_NOREF; }
};

/// Points `error` at the line where the function begins.
void locate_function(lua_State* lua, const FunctionRef& function, Error& error);

}  // namespace afterglow::script
