// SPDX-License-Identifier: MIT
// Arguments of a preset: fx.args{…}, and `--arg NAME=VALUE`.
#pragma once

#include "script/lua.h"

namespace afterglow::script {

struct Runtime;

/// fx.args: declares arguments; returns a new table of their values.
int declare_arguments(lua_State* lua);

/// Once the preset is loaded. Throws ScriptError (usage): a value was given for an argument that no script declares.
void check_arguments(const Runtime& runtime);

}  // namespace afterglow::script
