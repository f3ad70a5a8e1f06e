// SPDX-License-Identifier: MIT
// Reads what effects promise, and asks them what holds for a frame.
#pragma once

#include <vector>

#include "core/geometry.h"
#include "script/lua.h"
#include "script/schema.h"

namespace afterglow::script {

class TableReader;
struct Effect;
struct EntryRun;

/// Reads `holds` of the table of fx.effect into the effect; failures are noted in `table`.
void read_invariants(lua_State* lua, TableReader& table, Effect& effect);

/// The promises that hold for the settings of an entry and a picture of this size. Throws ScriptError: a function of
/// them fails, or returns no boolean or number.
std::vector<Invariant> invariants_of(lua_State* lua, const EntryRun& run, Size size);

}  // namespace afterglow::script
