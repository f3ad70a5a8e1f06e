// SPDX-License-Identifier: MIT
// A preset: a sandboxed Lua script that returns a stack. Loading runs the script, finds the effects it names, and
// checks every setting against its effect's schema; building runs the effects' `build` functions and yields a graph.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/file_record.h"
#include "core/paths.h"
#include "core/result.h"
#include "graph/graph.h"
#include "image/metadata.h"
#include "script/schema.h"
#include "shader/library.h"

namespace afterglow {

class AssetStore;  // script/asset_store.h

/// In the scene: x, y, z in its units.
using Position = std::array<double, 3>;

/// The light in which an entry of a stack runs.
struct EntrySpace {
  SpaceUse use;                           ///< with the entry's settings
  LightSpace before = LightSpace::scene;  ///< what it gets
  LightSpace behind = LightSpace::scene;  ///< what the next one gets
  std::string warning;                    ///< why it stands in the wrong place; empty: it does not
  bool runs = true;                       ///< it is enabled and does something
};
/// Whether what comes out stands for codes of a display's view: SpaceUse::view of the last entry that makes light.
bool ends_in_view(const std::vector<EntrySpace>& spaces);

/// Where an entry counts, and how much: a mask with the settings of the last build.
struct EntryMask {
  enum class Kind { named, number, add, subtract, multiply };
  Kind kind = Kind::number;
  double number = 0;
  std::string name;  ///< of the mask's script: "luma"
  std::string part;  ///< how settings call it: "mask.luma", a second one "mask.luma#2"
  std::vector<std::pair<std::string, SettingValue>> settings;
  std::string file;  ///< where the preset makes it
  int line = 0;
  std::shared_ptr<const EntryMask> a, b;  ///< of operators
  std::string text() const;               ///< "luma * (1 - radial)"
  /// Those that scripts make, from left to right.
  std::vector<const EntryMask*> parts() const;
};

/// One effect of a stack, in its resolved place, or a group or mix of such.
struct StackEntry {
  std::string name;  ///< unique in the stack: "glow"; a second one is "glow#2"
  std::string effect;
  std::string at;  ///< injection point
  int order = 0;
  bool enabled = true;
  bool required = false;  ///< a missing auxiliary input is an error
  bool can_lack = false;  ///< the preset says that it is none (`required = false`)
  double opacity = 1;     ///< of the frame
  std::string blend = "normal";
  std::shared_ptr<const EntryMask> mask;  ///< null: everywhere
  int members = 0;  ///< of a group or mix: so many entries behind it belong to it, with those that belong to them
  int middle = 0;   ///< of a mix: so many of them are its first look
  int depth = 0;    ///< in how many groups it stands
  std::string overtakes = {};  ///< the first entry of its list that is written above it and runs behind it; empty: none
  /// All of them, in the schema's order.
  std::vector<std::pair<std::string, SettingValue>> settings;
  /// Of settings that name files: the script that gives the name, whose folder of the search path goes before others.
  std::map<std::string, std::string> named_in = {};
  std::vector<std::string> changed;  ///< names of those that the preset or an override set; "opacity", "blend", "mask"
  std::string file;                  ///< where the preset names the effect
  int line = 0;

  bool is_mix() const { return members > 0 && !settings.empty(); }
  /// Where its members begin, a mix's second look begins and they end, in a list in which it is entry `i`.
  std::size_t first_of(std::size_t i) const { return i + 1; }
  std::size_t middle_of(std::size_t i) const { return i + 1 + static_cast<std::size_t>(middle); }
  std::size_t end_of(std::size_t i) const { return i + 1 + static_cast<std::size_t>(members); }
};

/// An argument that a preset declares by fx.args, and its value.
struct PresetArgument {
  SettingSchema schema;
  SettingValue value;
  bool given = false;  ///< by --arg
};

/// `--arg strength=0.3`.
struct ArgumentValue {
  std::string name, value;
};
/// Errors: usage.
Result<ArgumentValue> parse_argument(const std::string& text);

struct ScriptLimits {
  std::size_t memory = 64u << 20;           ///< bytes
  std::uint64_t instructions = 50'000'000;  ///< per load or build
  double seconds = 2.0;                     ///< per load or build
  /// Ends a script that is running from another thread: it fails with ErrorKind::interrupted once the steady clock has
  /// come so far. Null: never.
  std::shared_ptr<const std::atomic<std::chrono::steady_clock::rep>> until = {};
};

/// What is an error all the same where other values that do not fit are left out: how many of the last ones.
struct MustFit {
  std::size_t overrides = 0, arguments = 0;
};

struct PresetOptions {
  std::vector<std::filesystem::path> paths;  ///< --path
  std::filesystem::path installation;        ///< empty: find_installation()
  std::vector<Override> overrides;
  std::vector<ArgumentValue> arguments;  ///< --arg
  bool leave_out_unfit = false;          ///< overrides and arguments that do not fit are warned about, and no errors
  MustFit must_fit = {};                 ///< with that
  std::optional<Position> at;            ///< --at: where the picture is seen from, for volumes
  bool note_reads = false;               ///< which settings effects read: Build::unread. Reading them takes longer
  std::optional<std::string> text = {};  ///< of the preset, instead of what its file holds; the file need not exist
  /// Takes down what is looked at, also by a preset that fails to load. Null: the preset's own (Build::files).
  std::shared_ptr<FileRecord> record = {};
  /// What tables and pictures became for the looks before, and for this one. Null: the preset's own.
  std::shared_ptr<AssetStore> assets = {};
  ScriptLimits limits;
};

/// What `evaluate` may ask about the picture.
struct BuildContext {
  Size size;                              ///< of the source
  std::map<std::string, Size> auxiliary;  ///< inputs that the picture has: "depth", "normal", "layer:albedo"
  double frame = 1, time = 0, fps = 24;   ///< number in its sequence, seconds, pictures a second
  double step = 1;       ///< frames since the one before it, whose images its histories hold (graph/history.h)
  bool restart = false;  ///< no frame is before it: histories begin anew
  std::optional<Position> position = {};  ///< of its camera, when the picture says it
  /// Pixels of `size` for each pixel of the picture that is delivered: below 1 in previews that run smaller. Settings
  /// in px are lengths of that picture. A stack's `reference_height` goes before it.
  double length_scale = 1;
  /// What is skipped for lack of an input is not warned about: whoever evaluates tells it by Graph::skipped.
  bool notes_lacks = false;
  std::vector<std::string> asked = {};                  ///< inputs that it was read for, also those that it has not
  std::vector<std::string> layers = {};                 ///< names of all layers that it has, for messages
  std::map<std::string, std::string> hints = {};        ///< of inputs that it has not: what may be meant, for messages
  std::shared_ptr<const Metadata> metadata = {};        ///< of its file; null: unknown
  std::filesystem::path picture = {};                   ///< its file; empty: unknown
  std::shared_ptr<const Metadata> matte_metadata = {};  ///< of the file with mattes beside it; null: there is none
  std::filesystem::path mattes = {};                    ///< that file
  friend bool operator==(const BuildContext&, const BuildContext&) = default;
};

struct Build;        // script/build.h
struct Explanation;  // script/explanation.h

/// Owns one Lua state. Not thread-safe; may move between threads. Errors of all functions: script.
class Preset {
 public:
  static Result<Preset> load(const std::filesystem::path& file, const PresetOptions& options, ShaderLibrary& shaders,
                             Diagnostics& diagnostics);
  Preset(Preset&&) noexcept;
  Preset& operator=(Preset&&) noexcept;
  ~Preset();

  const std::string& name() const;         ///< of the stack
  const std::string& input_space() const;  ///< `input_space` of the stack; empty: none
  /// `alpha` of the stack: effects see colours as they are, not straight.
  bool sees_associated() const;
  /// `gamut` of the stack: whether components below 0 stay, which colours outside of Rec.709 have; none: not said.
  std::optional<bool> keeps_negative() const;
  std::optional<double> max_error() const;  ///< `max_error` of the stack
  /// In the order of execution, as they are for no frame in particular; those of a frame are Build::entries.
  const std::vector<StackEntry>& entries() const;
  const Explanation& explanation() const;                       ///< the same for Build::explanation
  const EffectSchema& schema(const std::string& effect) const;  ///< of an effect that the stack uses
  /// What a setting of an entry may be: of its effect, "opacity", "blend", "mask" (by --set a number), "enabled",
  /// "order", "at", or of a part of its mask ("mask.luma.from"). None: it has no such setting.
  std::optional<SettingSchema> setting_schema(const StackEntry& entry, const std::string& setting) const;
  /// The names of all that `setting_schema` knows.
  std::vector<std::string> setting_names(const StackEntry& entry) const;
  const std::vector<PresetArgument>& arguments() const;  ///< that scripts of the preset declare, in their order
  /// May settings differ from frame to frame or from place to place (curves, functions, volumes)?
  bool may_change() const;
  /// May an effect look at frames before (g:history)? By the texts of what was loaded; false is sure, but for scripts
  /// that put the word together.
  bool may_look_back() const;
  /// Has an enabled entry an effect that declares `detail = true`? Previews are then made at twice their size.
  bool detailed() const;
  /// The light in which each entry runs, in the order of execution, with the settings of the last evaluation.
  Result<std::vector<EntrySpace>> spaces();
  /// Names of auxiliary inputs that enabled, active effects and masks ask for. Where settings may change, what depends
  /// on the frame comes with it (`note_needs`, `evaluate`).
  const std::vector<std::string>& needs() const;
  /// With those that frames which nobody has asked for yet could ask for, but for layers.
  std::vector<std::string> possible_needs() const;
  /// May `needs` of some looks grow? Then asks with the settings of this frame. True: it wants inputs that were not
  /// known.
  Result<bool> note_needs(const BuildContext& context);
  /// Where names are looked up; a preset that extends another has that one's folder in it too.
  const SearchPath& path() const;
  /// Every script that was read: preset, library, effects, modules. (What frames are made of besides: Build::depends.)
  const std::vector<std::filesystem::path>& scripts() const;

  /// Everything that was looked at on disk so far, also in vain: what the next Build::files holds.
  std::shared_ptr<const FileProbes> probes() const;

  /// Bytes that the script's state holds, after a collection.
  std::size_t memory_used() const;

  /// Settles the settings of this frame, then runs `active` and `build` of each enabled entry, in order. The same
  /// context gives the same value, whatever was evaluated before.
  Result<Build> evaluate(const BuildContext& context, Diagnostics& diagnostics);
  std::uint64_t evaluations() const;  ///< so far
  /// The values of all settings that name files, as they are in this frame: `evaluate` without building anything.
  Result<std::vector<std::string>> named_files(const BuildContext& context);

 private:
  struct State;
  explicit Preset(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// A frame as they usually are: of a picture of this size that has everything the preset asks for, at the time that
/// `frame` has at `fps` pictures a second.
BuildContext usual_context(Preset& preset, Size size, double frame, double fps);

/// May a new effect be called so? Errors (usage): no identifier, a word of Lua or of the library, taken.
Result<void> check_new_effect_name(const std::string& name, const SearchPath& path);
/// Errors (usage): a new look cannot be called so.
Result<void> check_new_look_name(const std::string& name);

/// Every effect on the search path, by name. Scripts that fail to load are warned about and left out.
Result<std::vector<EffectSchema>> list_effects(const SearchPath& path, Diagnostics& diagnostics);
/// The same for masks.
Result<std::vector<EffectSchema>> list_masks(const SearchPath& path, Diagnostics& diagnostics);
/// Why the script of an effect (or of a mask, "mask.NAME") that is on the search path cannot be used; none: it can, or
/// there is none of that name.
std::optional<Error> effect_error(const SearchPath& path, const std::string& name);
/// The text of a lua-language-server completion file (`_meta`) for these effects and masks.
std::string completion_text(const std::vector<EffectSchema>& effects, const std::vector<EffectSchema>& masks);

}  // namespace afterglow
