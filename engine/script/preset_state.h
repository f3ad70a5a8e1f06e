// SPDX-License-Identifier: MIT
// What a preset holds. For preset.cpp, which loads it, and preset_build.cpp, which makes graphs of it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "script/entry_run.h"
#include "script/explanation.h"
#include "script/graph_builder.h"
#include "script/preset.h"
#include "script/resolve.h"
#include "script/runtime.h"

namespace afterglow {

using namespace script;

struct Preset::State {
  std::unique_ptr<Runtime> runtime;
  ShaderLibrary* shaders = nullptr;
  std::string file, name, input_space, gamut, alpha;
  std::optional<double> max_error;
  std::optional<int> reference_height;
  double length_scale = 1;                                 // of the settings in `runs`
  std::vector<EntryRun> runs;                              // in the order of execution
  std::shared_ptr<const std::vector<StackEntry>> entries;  // the same, as they were resolved last
  std::shared_ptr<const std::vector<StackEntry>> loaded;   // as they were first
  std::shared_ptr<const Explanation> loaded_so;            // of that
  std::vector<std::string> needs;
  bool needs_move = false;     ///< other frames may ask for others
  bool needs_unknown = false;  ///< of them, some that only a function knows
  Surroundings surroundings;
  std::shared_ptr<const Explanation> explanation;  // of that
  bool may_change = false;
  std::uint64_t evaluations = 0, builds = 0;
  double first_frame = 1;  ///< that was evaluated

  void load(lua_State* lua, const PresetOptions& options);
  void resolve(lua_State* lua, const BuildContext& context);
  void scale_lengths(lua_State* lua, const BuildContext& context);
  /// What may be asked for in any frame, as far as it is known before.
  void note_needs(lua_State* lua, const StackEntry*& current);
  /// What settings as they are now ask for; true: that is more than was known.
  bool note_needs_now(lua_State* lua, const StackEntry*& current);
  bool note(const std::vector<std::string>& inputs);
  /// Runs the effects' functions once.
  Result<Graph> build(const BuildContext& context, Diagnostics& diagnostics);
  /// What is said of an entry whose effect makes another graph when the frame is built again, with another frame in
  /// between; `graph`: as it was built first. Empty: none does.
  std::string changed_when_repeated(const BuildContext& context, const Graph& graph);
  ImageRef build_entry(lua_State* lua, const EntryRun& run, GraphBuilder& graph, const ImageRef& source,
                       Diagnostics& diagnostics);
  bool is_left_out(lua_State* lua, const EntryRun& run, GraphBuilder& graph, Diagnostics& diagnostics);
  /// Those from `begin` to `end`, one behind the other; `current`: the one being built.
  ImageRef build_entries(lua_State* lua, std::size_t begin, std::size_t end, GraphBuilder& graph, ImageRef image,
                         const StackEntry*& current, Diagnostics& diagnostics);
};

/// Errors in an effect's own file say which entry ran it.
Error with_entry(Error error, const StackEntry* entry);

}  // namespace afterglow
