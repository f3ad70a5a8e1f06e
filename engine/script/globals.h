// SPDX-License-Identifier: MIT
// What scripts find in a fresh state: an allow-list, everything on it bounded and deterministic.
#pragma once

#include "script/lua.h"

namespace afterglow::script {

/// Makes the table of globals and the string metatable. Left out on purpose: io, os, debug, package, coroutine, utf8,
/// load, loadfile, dofile, collectgarbage, warn, next (order of keys), xpcall (handlers run unhooked), string.dump,
/// table.move, the pattern functions (find, match, gmatch, gsub: they run for seconds without one instruction of Lua),
/// math.random.
void open_globals(lua_State* lua);

/// Adds a global: the value on top of the stack, which is popped.
void set_global(lua_State* lua, const char* name);

/// Pushes a new environment for a chunk: reads fall through to the globals, writes stay in it.
void push_environment(lua_State* lua);

// The tables of globals, in library_tables.cpp; each pushes one.
void push_string_library(lua_State* lua);
void push_table_library(lua_State* lua);
void push_math_library(lua_State* lua);

/// Pushes the text of the value as `tostring` gives it: without addresses, which differ from run to run.
void push_text(lua_State* lua, int index);

}  // namespace afterglow::script
