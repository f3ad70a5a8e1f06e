// SPDX-License-Identifier: MIT
// Reads the table of one entry of a stack: fx.NAME{…}, and what fx.extend changes of one.
#pragma once

#include "script/runtime.h"
#include "script/table_reader.h"

namespace afterglow::script {

/// An entry of the effect with nothing said about it.
DeclaredEntry new_entry(const Runtime& runtime, int effect);

/// Puts what the table says over what `declared` holds. What is wrong becomes failures of the table.
void read_entry(lua_State* lua, TableReader& table, const EffectSchema& schema, DeclaredEntry& declared);

/// The settings alone; `others` are names that somebody else reads.
void read_settings_of(lua_State* lua, TableReader& table, const EffectSchema& schema, DeclaredEntry& declared,
                      const std::vector<std::string>& others);

/// The keys that are no settings: where the entry stands, how its result is put over what it was given.
void read_entry_keys(lua_State* lua, TableReader& table, const EffectSchema& schema, DeclaredEntry& declared);

}  // namespace afterglow::script
