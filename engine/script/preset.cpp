// SPDX-License-Identifier: MIT
#include "script/preset.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/file_record.h"
#include "core/text.h"
#include "script/arguments.h"
#include "script/build.h"
#include "script/composite.h"
#include "script/entry_run.h"
#include "script/graph_binding.h"
#include "script/injection.h"
#include "script/invariant_reader.h"
#include "script/items.h"
#include "script/native.h"
#include "script/object.h"
#include "script/overrides.h"
#include "script/resolve.h"
#include "script/space.h"

namespace afterglow {

using namespace script;

struct Preset::State {
  std::unique_ptr<Runtime> runtime;
  ShaderLibrary* shaders = nullptr;
  std::string file, name, input_space;
  std::optional<double> max_error;
  std::optional<int> reference_height;
  double length_scale = 1;                                 // of the settings in `runs`
  std::vector<EntryRun> runs;                              // in the order of execution
  std::shared_ptr<const std::vector<StackEntry>> entries;  // the same, as they were resolved last
  std::shared_ptr<const std::vector<StackEntry>> loaded;   // as they were first
  std::shared_ptr<const Explanation> loaded_so;            // of that
  std::vector<std::string> needs;
  Surroundings surroundings;
  std::shared_ptr<const Explanation> explanation;  // of that
  bool may_change = false;
  std::uint64_t evaluations = 0;

  void load(lua_State* lua, const PresetOptions& options);
  void resolve(lua_State* lua, const BuildContext& context);
  void scale_lengths(lua_State* lua, const BuildContext& context);
  void note_needs(lua_State* lua, const StackEntry*& current);
  ImageRef build_entry(lua_State* lua, const EntryRun& run, GraphBuilder& graph, const ImageRef& source,
                       Diagnostics& diagnostics);
  bool is_left_out(lua_State* lua, const EntryRun& run, GraphBuilder& graph, Diagnostics& diagnostics);
  /// Those from `begin` to `end`, one behind the other; `current`: the one being built.
  ImageRef build_entries(lua_State* lua, std::size_t begin, std::size_t end, GraphBuilder& graph, ImageRef image,
                         const StackEntry*& current, Diagnostics& diagnostics);
};

namespace {

void warn_without_position(const Explanation& explanation, Diagnostics& diagnostics) {
  if (explanation.position) return;
  for (const auto& volume : explanation.volumes)
    if (!volume.reason.empty() && volume.weight > 0)
      diagnostics.warn_once("no position",
                            fmt::format("volume '{}' and others like it do not count: no position is "
                                        "known (--at, position in the preset, worldToCamera in the file)",
                                        volume.name));
}

// What layers there are, where one is missing.
std::string layers_text(const std::vector<std::string>& missing, const BuildContext& context) {
  constexpr std::size_t kMost = 20;
  for (const auto& name : missing) {
    if (!name.starts_with(kLayerPrefix)) continue;
    if (context.layers.empty()) return "; the picture has no named layers";
    std::vector<std::string> known = context.layers;
    const std::string nearest = nearest_name(name.substr(kLayerPrefix.size()), known);
    if (known.size() > kMost) known.resize(kMost), known.emplace_back("…");
    return fmt::format("; the picture has the layers {}{}", join(known),
                       nearest.empty() ? "" : "; did you mean '" + nearest + "'?");
  }
  return {};
}

// Errors in an effect's own file say which entry ran it.
Error with_entry(Error error, const StackEntry* entry) {
  if (entry && error.file != entry->file && error.kind == ErrorKind::script)
    error.trail.push_back(fmt::format("in effect '{}' of {}:{}", entry->name, entry->file, entry->line));
  return error;
}

}  // namespace

void Preset::State::load(lua_State* lua, const PresetOptions& options) {
  open_graph_binding(lua);
  runtime->given_arguments = options.arguments;
  runtime->leave_out_unfit = options.leave_out_unfit;
  runtime->last_argument_must_fit = options.must_fit == MustFit::last_argument;
  DeclaredStack stack = load_stack(lua, file, options.text);
  runtime->declaring = false;
  check_arguments(*runtime);
  shaders->search(runtime->path);
  Diagnostics* left_out = options.leave_out_unfit ? runtime->box->diagnostics : nullptr;
  const bool last_must_fit = options.must_fit == MustFit::last_override;
  if (auto applied = apply_overrides(stack.entries, options.overrides, *runtime, left_out, last_must_fit); !applied)
    throw ScriptError{applied.error()};
  sort_entries(stack.entries);
  name = stack.name.empty() ? std::filesystem::path(file).stem().string() : stack.name;
  max_error = stack.max_error;
  reference_height = stack.reference_height;
  input_space = stack.input_space;
  for (auto& declared : stack.entries) {
    const auto& schema = runtime->effects[static_cast<std::size_t>(declared.effect)].schema;
    for (std::size_t i = 0; i < schema.settings.size(); ++i)
      if (declared.sources[i].preset || declared.sources[i].overridden)
        declared.entry.changed.push_back(schema.settings[i].name);
    for (const auto& [key, source] : {std::pair("opacity", &declared.opacity), std::pair("blend", &declared.blend)})
      if (source->preset || source->overridden) declared.entry.changed.emplace_back(key);
    if (declared.mask >= 0) declared.entry.changed.emplace_back("mask");
    EntryRun run;
    run.entry = std::move(declared.entry);
    run.effect = declared.effect;
    run.sources = std::move(declared.sources);
    run.opacity = std::move(declared.opacity);
    run.blend = std::move(declared.blend);
    run.mask = make_mask_run(*runtime, declared.mask, run.entry);
    run.preset_mask = mask_text(*runtime, declared.preset_mask.value_or(declared.mask));
    runs.push_back(std::move(run));
  }
  surroundings = {std::move(stack.volumes), std::move(stack.position), options.at};
  std::stable_sort(surroundings.volumes.begin(), surroundings.volumes.end(),
                   [](const auto& a, const auto& b) { return a.priority < b.priority; });
  may_change = script::may_change(runs, surroundings);
  resolve(lua, {});
  loaded = entries;
  loaded_so = explanation;
}

void Preset::State::resolve(lua_State* lua, const BuildContext& context) {
  explanation = std::make_shared<const Explanation>(resolve_settings(lua, runs, surroundings, context));
  auto settled = std::make_shared<std::vector<StackEntry>>();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const bool as_before = entries && (*entries)[i].settings == runs[i].entry.settings;
    if (runs[i].settings_ref == LUA_NOREF || !as_before) make_settings(lua, runs[i], length_scale);
    settled->push_back(runs[i].entry);
  }
  entries = std::move(settled);
}

// Lengths of this frame: what scripts read of settings in px follows.
void Preset::State::scale_lengths(lua_State* lua, const BuildContext& context) {
  const double scale = reference_height ? double(context.size.height) / *reference_height : context.length_scale;
  if (scale == length_scale) return;
  length_scale = scale;
  for (auto& run : runs) {
    make_settings(lua, run, length_scale);
    if (run.mask) script::scale_lengths(lua, *run.mask, length_scale);
  }
}

void Preset::State::note_needs(lua_State* lua, const StackEntry*& current) {
  const auto note = [&](const std::vector<std::string>& names) {
    for (const auto& input : names)
      if (std::find(needs.begin(), needs.end(), input) == needs.end()) needs.push_back(input);
  };
  for (const auto& run : runs) {
    current = &run.entry;
    const bool changes = script::may_change(run, surroundings);
    if (!run.entry.enabled || (!changes && inactive_reason(lua, run))) continue;
    note(needed_inputs(lua, run));
    note(optional_inputs(lua, run));
    std::vector<std::string> of_masks;
    add_mask_inputs(lua, run, true, of_masks);
    note(of_masks);
    // Other settings may ask for other inputs: what an effect asks for by a function cannot be known before.
    const Effect& effect = runtime->effects[static_cast<std::size_t>(run.effect)];
    if (changes && (effect.needs.function.set() || effect.optional.function.set())) note(auxiliary_inputs());
  }
}

Preset::Preset(std::unique_ptr<State> state) : state_(std::move(state)) {}
Preset::Preset(Preset&&) noexcept = default;
Preset& Preset::operator=(Preset&&) noexcept = default;
Preset::~Preset() = default;

Result<Preset> Preset::load(const std::filesystem::path& file, const PresetOptions& options, ShaderLibrary& shaders,
                            Diagnostics& diagnostics) {
  auto state = std::make_unique<State>();
  state->file = file.string();
  state->shaders = &shaders;
  auto record = options.record ? options.record : std::make_shared<FileRecord>();
  AFTERGLOW_TRY(state->runtime,
                Runtime::create(search_path_for(file, options.paths, std::move(record), options.installation),
                                options.limits, diagnostics));
  state->runtime->assets.store = options.assets ? options.assets : std::make_shared<AssetStore>();
  Sandbox& box = *state->runtime->box;
  const StackEntry* current = nullptr;
  auto error = box.run(state->file, [&](lua_State* lua) {
    state->load(lua, options);
    state->note_needs(lua, current);
  });
  box.diagnostics = nullptr;
  if (error) return with_entry(std::move(*error), current);
  return Preset(std::move(state));
}

const std::string& Preset::name() const { return state_->name; }
const std::string& Preset::input_space() const { return state_->input_space; }
std::optional<double> Preset::max_error() const { return state_->max_error; }
const std::vector<PresetArgument>& Preset::arguments() const { return state_->runtime->arguments; }
bool Preset::may_change() const { return state_->may_change; }
const std::vector<StackEntry>& Preset::entries() const { return *state_->loaded; }
const Explanation& Preset::explanation() const { return *state_->loaded_so; }
bool Preset::detailed() const {
  return std::any_of(entries().begin(), entries().end(),
                     [&](const StackEntry& entry) { return entry.enabled && schema(entry.effect).detail; });
}
std::uint64_t Preset::evaluations() const { return state_->evaluations; }
std::vector<std::string> Preset::needs() const { return state_->needs; }
std::shared_ptr<const FileProbes> Preset::probes() const { return state_->runtime->path.record->looks(); }
const SearchPath& Preset::path() const { return state_->runtime->path; }
const std::vector<std::filesystem::path>& Preset::scripts() const { return state_->runtime->scripts; }

const EffectSchema& Preset::schema(const std::string& effect) const {
  static const EffectSchema none;
  const auto found = state_->runtime->effect_by_name.find(effect);
  return found == state_->runtime->effect_by_name.end()
             ? none
             : state_->runtime->effects[static_cast<std::size_t>(found->second)].schema;
}

std::size_t Preset::memory_used() const {
  lua_State* lua = state_->runtime->box->lua();
  lua_gc(lua, LUA_GCCOLLECT);
  return state_->runtime->box->memory_used();
}

namespace {

void warn_skipped(const StackEntry& entry, const std::string& reason, Diagnostics& diagnostics) {
  diagnostics.warn_once(fmt::format("{}:{}: {}", entry.file, entry.name, reason),
                        fmt::format("effect '{}' is skipped: {}", entry.name, reason));
}

}  // namespace

ImageRef Preset::State::build_entry(lua_State* lua, const EntryRun& run, GraphBuilder& graph, const ImageRef& source,
                                    Diagnostics& diagnostics) {
  const StackEntry& entry = run.entry;
  if (is_left_out(lua, run, graph, diagnostics)) return source;
  bool told = false;
  if (auto reason = inactive_reason(lua, run, &told)) {
    if (told) warn_skipped(entry, *reason, diagnostics);
    graph.add_skipped(entry.name, std::move(*reason));
    return source;
  }
  std::vector<std::string> inputs = needed_inputs(lua, run);
  for (auto& input : optional_inputs(lua, run)) inputs.push_back(std::move(input));
  graph.begin(entry, std::move(inputs), runtime->effects[static_cast<std::size_t>(run.effect)].schema.straight);
  const ImageRef image = run_build(lua, run, graph, source);
  graph.end();
  if (image.id == source.id) {
    graph.add_skipped(entry.name, graph.skip_reason().value_or("returned its source"));
    return image;
  }
  // What an idle effect makes is its source; that over the source is made all the same.
  if (const auto limit = idle_limit(lua, run, source)) graph.add_idle(source, image, *limit);
  const ImageRef seen = composite(lua, run, graph, source, image);
  if (seen.id == source.id) graph.add_skipped(entry.name, "its mask selects nothing");
  return seen;
}

/// Disabled, unseen, or without an input that it needs; said why.
bool Preset::State::is_left_out(lua_State* lua, const EntryRun& run, GraphBuilder& graph, Diagnostics& diagnostics) {
  const StackEntry& entry = run.entry;
  if (!entry.enabled) {
    graph.add_skipped(entry.name, "disabled");
    return true;
  }
  if (auto reason = unseen_reason(lua, run)) {
    graph.add_skipped(entry.name, std::move(*reason));
    return true;
  }
  std::vector<std::string> inputs, missing;
  if (!inactive_reason(lua, run)) inputs = needed_inputs(lua, run);
  add_mask_inputs(lua, run, false, inputs);
  for (const auto& input : inputs)
    if (!graph.context().auxiliary.contains(input)) missing.push_back(input);
  if (missing.empty()) return false;
  const std::string reason = fmt::format("no {} input", join(missing, " and ")) + layers_text(missing, graph.context());
  if (entry.required)
    throw ScriptError{{ErrorKind::script, fmt::format("effect '{}' is required, but there is {}", entry.name, reason),
                       entry.file, entry.line}};
  graph.add_skipped(entry.name, reason);
  warn_skipped(entry, reason, diagnostics);
  return true;
}

ImageRef Preset::State::build_entries(lua_State* lua, std::size_t begin, std::size_t end, GraphBuilder& graph,
                                      ImageRef image, const StackEntry*& current, Diagnostics& diagnostics) {
  for (std::size_t i = begin; i < end;) {
    const EntryRun& run = runs[i];
    const StackEntry& entry = run.entry;
    current = &entry;
    const std::size_t first = i + 1, middle = first + static_cast<std::size_t>(entry.middle),
                      last = first + static_cast<std::size_t>(entry.members);
    i = last;
    if (!runtime->effects[static_cast<std::size_t>(run.effect)].is_group()) {
      image = build_entry(lua, run, graph, image, diagnostics);
      continue;
    }
    if (is_left_out(lua, run, graph, diagnostics)) continue;
    ImageRef made = image;
    if (entry.settings.empty()) {
      made = build_entries(lua, first, last, graph, image, current, diagnostics);
    } else {
      const ImageRef one = build_entries(lua, first, middle, graph, image, current, diagnostics);
      const ImageRef other = build_entries(lua, middle, last, graph, image, current, diagnostics);
      current = &entry;
      made = mixed(run, graph, one, other, entry.settings.front().second.number[0]);
    }
    current = &entry;
    if (made.id == image.id)
      graph.add_skipped(entry.name, "nothing in it runs");
    else
      image = composite(lua, run, graph, image, made);
  }
  return image;
}

Result<Build> Preset::evaluate(const BuildContext& context, Diagnostics& diagnostics) {
  State& state = *state_;
  Sandbox& box = *state.runtime->box;
  GraphBuilder graph(context, *state.shaders, ++state.evaluations);
  const StackEntry* current = nullptr;
  ImageRef image = graph.source();
  state.runtime->graph = &graph;
  state.runtime->depends = {};
  box.diagnostics = &diagnostics;
  auto error = box.run(state.file, [&](lua_State* lua) {
    state.scale_lengths(lua, context);
    graph.scale_lengths(state.length_scale);
    if (state.may_change) state.resolve(lua, context);
    warn_without_position(*state.explanation, diagnostics);
    image = state.build_entries(lua, 0, state.runs.size(), graph, image, current, diagnostics);
  });
  state.runtime->graph = nullptr;
  box.diagnostics = nullptr;
  if (error) return with_entry(std::move(*error), current);
  Build out{.context = context,
            .length_scale = state.length_scale,
            .graph = {},
            .entries = state.entries,
            .explanation = state.explanation,
            .promises = {},
            .promise_error = {},
            .depends = std::move(state.runtime->depends),
            .files = {}};
  out.graph = graph.finish(image.id);
  out.promise_error = box.run(state.file, [&](lua_State* lua) {
    for (const auto& run : state.runs) out.promises.push_back({run.entry.name, invariants_of(lua, run, context.size)});
  });
  out.files = probes();
  return out;
}

Result<std::vector<std::string>> Preset::named_files(const BuildContext& context) {
  State& state = *state_;
  std::vector<std::string> names;
  const auto note = [&](const std::vector<std::pair<std::string, SettingValue>>& settings) {
    for (const auto& [name, value] : settings)
      if (value.type == SettingType::file && !value.choice.empty()) names.push_back(value.choice);
  };
  auto error = state.runtime->box->run(state.file, [&](lua_State* lua) {
    if (state.may_change) state.resolve(lua, context);
  });
  if (error) return std::move(*error);
  for (const StackEntry& entry : *state.entries) {
    note(entry.settings);
    if (!entry.mask) continue;
    for (const EntryMask* part : entry.mask->parts()) note(part->settings);
  }
  return names;
}

Result<std::vector<EntrySpace>> Preset::spaces() {
  State& state = *state_;
  std::vector<EntrySpace> out;
  auto error = state.runtime->box->run(state.file, [&](lua_State* lua) { out = trace_spaces(lua, state.runs); });
  if (error) return std::move(*error);
  return out;
}

BuildContext usual_context(const Preset& preset, Size size, double frame, double fps) {
  BuildContext out{.size = size, .auxiliary = {}, .frame = frame, .time = frame / fps, .fps = fps};
  for (const auto& name : preset.needs()) out.auxiliary[name] = size;
  return out;
}

}  // namespace afterglow
