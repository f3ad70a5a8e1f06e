// Masks: fx.mask.NAME{…} and what operators make of them.
#pragma once

#include <lua.hpp>

namespace afterglow::script {

class TableReader;
struct DeclaredEntry;

/// Pushes `fx.mask`, whose fields are functions that make masks.
void push_masks(lua_State* lua);

/// The key `mask` of an entry: a mask or a number. Notes failures in `table`.
void read_mask(lua_State* lua, TableReader& table, DeclaredEntry& declared);

}  // namespace afterglow::script
