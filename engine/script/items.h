// SPDX-License-Identifier: MIT
// What stands in a stack or a group without a name: entries, groups, lists of them.
#pragma once

#include <vector>

#include "script/lua.h"
#include "script/runtime.h"
#include "script/table_reader.h"

namespace afterglow::script {

/// Adds the positional items of a table behind `entries`; a group is followed by its members. `false` stands for
/// nothing, so that `cond and fx.x { }` may be an item. `volumes` null: none may stand here. Failures go to `table`.
void read_items(lua_State* lua, TableReader& table, std::vector<DeclaredEntry>& entries,
                std::vector<DeclaredVolume>* volumes);

/// Puts entries in the order in which they run: by injection point, order, place in the list; those of a group among
/// themselves. Says where groups stand that do not say so themselves, and how deep each entry lies.
void sort_entries(std::vector<DeclaredEntry>& entries);

/// fx.group, fx.mix.
int declare_group(lua_State* lua);
int declare_mix(lua_State* lua);

}  // namespace afterglow::script
