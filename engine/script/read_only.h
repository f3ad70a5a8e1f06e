// SPDX-License-Identifier: MIT
// Read-only tables: an empty table whose metatable reads from the real one and refuses writes. Scripts can neither
// reach the real table nor the metatable.
#pragma once

#include "script/lua.h"

namespace afterglow::script {

/// Replaces the table on top of the stack by a read-only view of it. The real table may have a metatable of its own
/// (an `__index` for names that it lacks).
void make_read_only(lua_State* lua);

/// Pushes the real table behind a view, or a copy of the value itself when it is none.
void push_real(lua_State* lua, int index);

}  // namespace afterglow::script
