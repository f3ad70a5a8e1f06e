// SPDX-License-Identifier: MIT
// Reads a filter described as a Lua table.
#pragma once

#include "core/filter.h"
#include "script/table_reader.h"

namespace afterglow::script {

/// The filter on top of the stack (left there), the value of the key `filter` of a call's table. What is wrong is noted
/// in `call`.
Filter read_filter(lua_State* lua, TableReader& call);

}  // namespace afterglow::script
