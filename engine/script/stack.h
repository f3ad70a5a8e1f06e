// SPDX-License-Identifier: MIT
// The functions that presets are made of: fx.NAME{…} and fx.stack{…}.
#pragma once

#include <string>
#include <vector>

#include "script/lua.h"
#include "script/runtime.h"
#include "script/table_reader.h"

namespace afterglow::script {

/// `fx.NAME`: a function of the library or, for any other name, the effect of that name as a function.
int library_index(lua_State* lua);

/// fx.stack.
int declare_stack(lua_State* lua);

/// fx.extend.
int declare_extend(lua_State* lua);

/// Names that the table of a stack may have besides its items.
const std::vector<std::string>& stack_keys();

/// Puts what the table says (`stack_keys` and items) over and behind what `stack` holds, and names what has no name.
void read_stack(lua_State* lua, TableReader& table, DeclaredStack& stack);

/// Completes the stack's volumes and pushes the stack. Throws ScriptError.
void push_stack(lua_State* lua, DeclaredStack stack);

}  // namespace afterglow::script
