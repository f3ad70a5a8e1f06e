// SPDX-License-Identifier: MIT
// `space` of an effect: the light that it is made for, and the light that each entry of a stack gets.
#pragma once

#include <vector>

#include "script/entry_run.h"
#include "script/lua.h"
#include "script/table_reader.h"

namespace afterglow::script {

/// Reads `space` of fx.effect: "scene", "display", "other", { needs = …, makes = … }, or a function of the settings that
/// returns one of these. Mistakes are noted in `table`.
void read_space(lua_State* lua, TableReader& table, Effect& effect);

/// Follows the light through the stack, which begins scene-linear. An entry is warned about when it is made for scene
/// light and gets display light, or is made for display light and stands before the entry that makes it. In a stack
/// that never makes display light nothing is known about the picture, and nothing is warned about. Both looks of a mix
/// get the light in front of it; what nobody sees does not run. Throws ScriptError.
std::vector<EntrySpace> trace_spaces(lua_State* lua, const std::vector<EntryRun>& runs);

}  // namespace afterglow::script
