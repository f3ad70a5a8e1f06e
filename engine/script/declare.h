// The functions that effects declare themselves with: fx.effect and the setting types.
#pragma once

#include "script/lua.h"
#include "script/preset.h"
#include "script/runtime.h"

namespace afterglow::script {

/// fx.int, fx.float, fx.bool, fx.enum, fx.color, fx.vec2.
template <SettingType type>
int declare_setting(lua_State* lua);

/// fx.effect.
int declare_effect(lua_State* lua);

/// The names in the array on top of the stack (popped), checked against the known auxiliary inputs. `what` is "needs"
/// or "optional". Throws ScriptError.
std::vector<std::string> pop_input_names(lua_State* lua, const std::string& what);

}  // namespace afterglow::script
