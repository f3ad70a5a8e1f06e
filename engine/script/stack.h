// The functions that presets are made of: fx.NAME{…} and fx.stack{…}.
#pragma once

#include <lua.hpp>

namespace afterglow::script {

/// `fx.NAME`: a function of the library or, for any other name, the effect of that name as a function.
int library_index(lua_State* lua);

/// fx.stack.
int declare_stack(lua_State* lua);

}  // namespace afterglow::script
