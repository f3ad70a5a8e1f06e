// SPDX-License-Identifier: MIT
// The functions that effects declare themselves with: fx.effect and the setting types.
#pragma once

#include "script/lua.h"
#include "script/preset.h"
#include "script/runtime.h"
#include "script/table_reader.h"

namespace afterglow::script {

/// fx.int, fx.float, fx.bool, fx.enum, fx.color, fx.vec2.
template <SettingType type>
int declare_setting(lua_State* lua);

/// fx.effect.
int declare_effect(lua_State* lua);

/// What a table of NAME = fx.TYPE{…} declares, in the order in which it is written. `taken`: names that it may not use.
/// Failures go to `table`.
std::vector<SettingSchema> read_setting_types(lua_State* lua, TableReader& table,
                                              const std::vector<std::string>& taken);

/// The names in the array on top of the stack (popped), checked against the known auxiliary inputs. `what` is "needs"
/// or "optional". Throws ScriptError.
std::vector<std::string> pop_input_names(lua_State* lua, const std::string& what);

}  // namespace afterglow::script
