// SPDX-License-Identifier: MIT
// Runs the functions of one entry's effect: `active`, `needs`, `optional`, `build`.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "script/graph_builder.h"
#include "script/runtime.h"

namespace afterglow::script {

struct EntryRun;

/// A mask whose scripts can be run.
struct MaskRun {
  EntryMask::Kind kind = EntryMask::Kind::number;
  double number = 0;
  std::string part;                 ///< see EntryMask::part
  std::shared_ptr<EntryRun> named;  ///< of a mask's script; its entry has the name of the one that is masked
  std::shared_ptr<MaskRun> a, b;    ///< of operators
};

/// An entry in its place, with its settings as a Lua table.
struct EntryRun {
  StackEntry entry;
  int effect = 0;
  std::vector<SettingSource> sources;  ///< as DeclaredEntry::sources
  int settings_ref = LUA_NOREF;        ///< read-only table in the registry
  int reads_ref = LUA_NOREF;           ///< with Runtime::note_reads: table of the names that were read of it
  SettingSource opacity, blend;
  std::shared_ptr<MaskRun> mask;  ///< null: none
  std::string preset_mask;        ///< see EntryHistory::preset_mask
  double length_scale = 1;        ///< of the lengths in that table
};

/// All throw ScriptError.
/// Makes the table `s` anew from the entry's settings: reading a setting that does not exist is an error. Settings in
/// px are multiplied by `length_scale`: numbers as they are, whatever their least value; integers rounded, and not
/// below it.
void make_settings(lua_State* lua, EntryRun& run, double length_scale);
/// Why something has nothing to do.
struct Inactive {
  std::string reason;
  bool told = false;  ///< its author wants people to hear of it
};
/// Empty when the effect, or the mask, is active with these settings.
std::optional<Inactive> why_inactive(lua_State* lua, const EntryRun& run);
/// Do its inputs depend on its settings?
bool asks_by_function(const Runtime& runtime, const EntryRun& run);
std::vector<std::string> needed_inputs(lua_State* lua, const EntryRun& run);
std::vector<std::string> optional_inputs(lua_State* lua, const EntryRun& run);
/// The needed ones, then the optional ones.
std::vector<std::string> used_inputs(lua_State* lua, const EntryRun& run);
/// What `idle` says about an effect that was built on `source`: the largest red, green or blue of it up to which the
/// effect changes nothing. Empty when there is no such limit.
std::optional<double> idle_limit(lua_State* lua, const EntryRun& run, const ImageRef& source);
/// Runs `build` on `source`; the image it returned.
ImageRef run_build(lua_State* lua, const EntryRun& run, GraphBuilder& graph, const ImageRef& source);

}  // namespace afterglow::script
