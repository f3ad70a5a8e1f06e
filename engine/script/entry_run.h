// Runs the functions of one entry's effect: `active`, `needs`, `optional`, `build`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "script/graph_builder.h"
#include "script/runtime.h"

namespace afterglow::script {

/// An entry in its place, with its settings as a Lua table.
struct EntryRun {
  StackEntry entry;
  int effect = 0;
  std::vector<SettingSource> sources;  ///< as DeclaredEntry::sources
  int settings_ref = LUA_NOREF;        ///< read-only table in the registry
};

/// All throw ScriptError.
/// Makes the table `s` anew from the entry's settings: reading a setting that does not exist is an error.
void make_settings(lua_State* lua, EntryRun& run);
/// Why the effect has nothing to do with these settings; empty when it is active.
std::optional<std::string> inactive_reason(lua_State* lua, const EntryRun& run);
std::vector<std::string> needed_inputs(lua_State* lua, const EntryRun& run);
std::vector<std::string> optional_inputs(lua_State* lua, const EntryRun& run);
/// Runs `build` on `source`; the image it returned.
ImageRef run_build(lua_State* lua, const EntryRun& run, GraphBuilder& graph, const ImageRef& source);

}  // namespace afterglow::script
