// SPDX-License-Identifier: MIT
// What one Lua state knows of Afterglow: the scripts it read, the effects and settings they declared, the stack they
// made. The files library.cpp, declare.cpp, stack.cpp and graph_binding.cpp give Lua the functions that fill it.
#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/paths.h"
#include "script/animated.h"
#include "script/assets.h"
#include "script/dependencies.h"
#include "script/explanation.h"
#include "script/function_ref.h"
#include "script/preset.h"
#include "script/sandbox.h"
#include "script/volume.h"

namespace afterglow::script {

class GraphBuilder;

/// Auxiliary inputs that an effect names: a fixed list, or a function of its settings.
struct InputList {
  std::vector<std::string> names;
  FunctionRef function;
};

/// A promise as an effect makes it.
struct DeclaredInvariant {
  InvariantSchema schema;
  FunctionRef when;  ///< not set: always
  std::map<std::string, FunctionRef> computed;
};

struct Effect {
  EffectSchema schema;
  std::vector<DeclaredInvariant> invariants;  ///< parallel to the schema's
  FunctionRef active, build, idle, space;
  InputList needs, optional;
  bool is_group() const { return !build.set(); }  ///< of fx.group and fx.mix: no script made it
};

/// What the preset and the command line say about one setting.
struct SettingSource {
  std::optional<Animated> preset;
  std::shared_ptr<const ScriptPlace> place;  ///< of `preset`
  std::optional<SettingValue> overridden;
};

/// An entry as `fx.NAME{…}` made it; what it leaves open is decided when the stack is complete.
struct DeclaredEntry {
  int effect = 0;  ///< index in Runtime::effects
  std::optional<std::string> name;
  SettingSource opacity, blend;
  int mask = -1;                             ///< index in Runtime::masks, or -1
  std::optional<int> preset_mask;            ///< the one before --set
  bool says_at = false, says_order = false;  ///< itself; what a group does not say is that of its first entry
  StackEntry entry;                          ///< its settings are filled in when they are resolved
  std::vector<SettingSource> sources;        ///< parallel to the schema's settings
};

/// A mask as fx.mask.NAME{…} and operators made it.
struct DeclaredMask {
  EntryMask::Kind kind = EntryMask::Kind::number;
  double number = 0;
  int a = -1, b = -1;  ///< of operators: indices in Runtime::masks
  DeclaredEntry named = {};
  int parts = 1;  ///< masks and numbers that it is made of
};

/// What fx.group{…} and fx.mix{…} made: an entry, and those that belong to it, in the preset's order.
struct DeclaredGroup {
  DeclaredEntry entry;
  std::vector<DeclaredEntry> members;
};

struct DeclaredStack {
  std::string name;
  std::optional<double> max_error;
  std::optional<Animated> position;
  std::string input_space;              ///< that pictures are stored in; empty: what they say
  std::string gamut;                    ///< "cut" or "keep"; empty: not said
  std::string alpha;                    ///< "straight" or "associated"; empty: not said
  std::optional<int> reference_height;  ///< of the picture whose pixels lengths are given in
  std::vector<DeclaredEntry> entries;   ///< in the preset's order
  std::vector<DeclaredVolume> volumes;  ///< the same
};

/// A setting as `fx.float{…}` made it, before it has a name; its index is the order of declaration.
struct DeclaredSetting {
  SettingSchema schema;
};

struct Runtime {
  /// Opens a state with `require` and the library. Errors: script.
  static Result<std::unique_ptr<Runtime>> create(SearchPath path, const ScriptLimits& limits, Diagnostics& diagnostics);
  static Runtime& of(lua_State* lua) { return *static_cast<Runtime*>(Sandbox::of(lua).owner); }

  std::unique_ptr<Sandbox> box;
  SearchPath path;
  std::vector<std::filesystem::path> scripts;  ///< that were read
  Dependencies depends;                        ///< of the frame that is built
  std::deque<Effect> effects;
  std::map<std::string, int> effect_by_name;
  std::set<std::string> loading;  ///< effects and modules that are being loaded: cycles
  std::vector<DeclaredSetting> settings;
  std::vector<DeclaredEntry> entries;
  std::vector<DeclaredGroup> groups;
  std::vector<DeclaredMask> masks;
  std::vector<DeclaredStack> stacks;
  std::vector<PresetArgument> arguments;       ///< declared so far
  std::vector<ArgumentValue> given_arguments;  ///< --arg
  bool leave_out_unfit = false;                ///< PresetOptions: of arguments too
  std::size_t arguments_that_must_fit = 0;     ///< with that: of the last ones
  std::vector<DeclaredCurve> curves;
  std::size_t keys_of_settings = 0;  ///< of curves, each counted for each setting that it is given to
  std::size_t targets = 0;           ///< of volumes
  std::size_t stack_entries = 0;     ///< of all stacks
  /// Settings are settled for a frame that may never be run: functions that fail there give defaults.
  bool provisional = false;
  std::vector<DeclaredVolume> volumes;
  Assets assets;
  std::size_t curve_keys = 0, wanted = 0, group_members = 0;  ///< of all curves, volumes, groups: limited
  bool note_reads = false;                                    ///< PresetOptions
  std::vector<std::filesystem::path> modules;                 ///< files that `require` ran
  bool declaring = true;                                      ///< false once the preset is loaded
  GraphBuilder* graph = nullptr;                              ///< while `build` runs
};

/// What a file that declares by fx.effect is for, which is the folder that it lies in.
enum class ScriptKind { effect, mask };

/// Names a file of an effect that declares `name`; finds, loads and remembers it. Errors: throws ScriptError.
int find_effect(lua_State* lua, const std::string& name, ScriptKind kind = ScriptKind::effect);

/// Runs a preset's file, or `text` in its place; the stack that it returns. Errors: throws ScriptError.
DeclaredStack load_stack(lua_State* lua, const std::filesystem::path& file,
                         const std::optional<std::string>& text = std::nullopt);
/// The same for a preset on the search path. Its folder joins the path: what it brings along is found.
DeclaredStack load_named_stack(lua_State* lua, const std::string& name);

/// Reads the file as a text chunk with an environment of its own and pushes it as a function. Errors: throws
/// ScriptError.
void load_chunk(lua_State* lua, const std::filesystem::path& file, bool library = false,
                const std::optional<std::string>& text = std::nullopt);

/// Pushes `require`.
void push_require(lua_State* lua);

/// Pushes the library table `fx`.
void push_library(lua_State* lua);

/// Names that effects and modules may have: letters, digits and '_', not starting with a digit.
bool is_identifier(const std::string& name);

/// Every effect (or mask) name on the search path, sorted, each once.
std::vector<std::string> effect_names(const SearchPath& path, ScriptKind kind = ScriptKind::effect);

}  // namespace afterglow::script
