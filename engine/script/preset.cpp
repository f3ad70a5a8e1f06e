#include "script/preset.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "script/entry_run.h"
#include "script/graph_binding.h"
#include "script/hold_reader.h"
#include "script/injection.h"
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
  double length_scale = 1;          // of the settings in `runs`
  std::vector<EntryRun> runs;       // in the order of execution
  std::vector<StackEntry> entries;  // the same
  std::vector<std::string> needs;
  Surroundings surroundings;
  Explanation explanation;
  bool may_change = false;
  std::uint64_t builds = 0;

  void load(lua_State* lua, const PresetOptions& options);
  void resolve(lua_State* lua, const BuildContext& context);
  void scale_lengths(lua_State* lua, const BuildContext& context);
  void note_needs(lua_State* lua, const StackEntry*& current);
  ImageRef build_entry(lua_State* lua, const EntryRun& run, GraphBuilder& graph, const ImageRef& source,
                       Diagnostics& diagnostics);
};

namespace {

std::ptrdiff_t point_index(const std::string& at) {
  const auto& points = injection_points();
  return std::find(points.begin(), points.end(), at) - points.begin();
}

void sort_entries(std::vector<DeclaredEntry>& entries) {
  std::stable_sort(entries.begin(), entries.end(), [](const DeclaredEntry& a, const DeclaredEntry& b) {
    const auto point_a = point_index(a.entry.at), point_b = point_index(b.entry.at);
    return point_a != point_b ? point_a < point_b : a.entry.order < b.entry.order;
  });
}

void warn_without_position(const Explanation& explanation, Diagnostics& diagnostics) {
  if (explanation.position) return;
  for (const auto& volume : explanation.volumes)
    if (!volume.reason.empty() && volume.weight > 0)
      diagnostics.warn_once("no position",
                            fmt::format("volume '{}' and others like it do not count: no position is "
                                        "known (--at, position in the preset, worldToCamera in the file)",
                                        volume.name));
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
  DeclaredStack stack = load_stack(lua, file, options.text);
  runtime->declaring = false;
  shaders->search(runtime->path);
  Diagnostics* left_out = options.leave_out_unfit ? runtime->box->diagnostics : nullptr;
  if (auto applied = apply_overrides(stack.entries, options.overrides, runtime->effects, left_out); !applied)
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
    entries.push_back(declared.entry);
    runs.push_back({std::move(declared.entry), declared.effect, std::move(declared.sources)});
  }
  surroundings = {std::move(stack.volumes), std::move(stack.position), options.at};
  std::stable_sort(surroundings.volumes.begin(), surroundings.volumes.end(),
                   [](const auto& a, const auto& b) { return a.priority < b.priority; });
  may_change = script::may_change(runs, surroundings);
  resolve(lua, {});
}

void Preset::State::resolve(lua_State* lua, const BuildContext& context) {
  explanation = resolve_settings(lua, runs, surroundings, context);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].settings_ref != LUA_NOREF && entries[i].settings == runs[i].entry.settings) continue;
    entries[i].settings = runs[i].entry.settings;
    make_settings(lua, runs[i], length_scale);
  }
}

// Lengths of this frame: what scripts read of settings in px follows.
void Preset::State::scale_lengths(lua_State* lua, const BuildContext& context) {
  const double scale = reference_height ? double(context.size.height) / *reference_height : context.length_scale;
  if (scale == length_scale) return;
  length_scale = scale;
  for (auto& run : runs) make_settings(lua, run, length_scale);
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
  AFTERGLOW_TRY(state->runtime, Runtime::create(search_path_for(file, options.paths), options.limits, diagnostics));
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
const std::vector<StackEntry>& Preset::entries() const { return state_->entries; }
bool Preset::may_change() const { return state_->may_change; }
const Explanation& Preset::explanation() const { return state_->explanation; }
std::vector<std::string> Preset::needs() const { return state_->needs; }
const SearchPath& Preset::path() const { return state_->runtime->path; }
const std::vector<std::filesystem::path>& Preset::files() const { return state_->runtime->files; }

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

ImageRef Preset::State::build_entry(lua_State* lua, const EntryRun& run, GraphBuilder& graph, const ImageRef& source,
                                    Diagnostics& diagnostics) {
  const StackEntry& entry = run.entry;
  if (!entry.enabled) {
    graph.add_skipped(entry.name, "disabled");
    return source;
  }
  if (auto reason = inactive_reason(lua, run)) {
    graph.add_skipped(entry.name, std::move(*reason));
    return source;
  }
  std::vector<std::string> inputs = needed_inputs(lua, run), missing;
  for (const auto& input : inputs)
    if (!graph.context().auxiliary.contains(input)) missing.push_back(input);
  if (!missing.empty()) {
    const std::string reason = fmt::format("no {} input", join(missing, " and "));
    if (entry.required)
      throw ScriptError{{ErrorKind::script, fmt::format("effect '{}' is required, but there is {}", entry.name, reason),
                         entry.file, entry.line}};
    graph.add_skipped(entry.name, reason);
    diagnostics.warn_once(fmt::format("{}:{}: {}", entry.file, entry.name, reason),
                          fmt::format("effect '{}' is skipped: {}", entry.name, reason));
    return source;
  }
  for (auto& input : optional_inputs(lua, run)) inputs.push_back(std::move(input));
  graph.begin(entry, std::move(inputs));
  const ImageRef image = run_build(lua, run, graph, source);
  graph.end();
  if (image.id == source.id)
    graph.add_skipped(entry.name, graph.skip_reason().value_or("returned its source"));
  else if (const auto limit = idle_limit(lua, run, source))
    graph.add_idle(source, image, *limit);
  return image;
}

Result<Graph> Preset::build(const BuildContext& context, Diagnostics& diagnostics) {
  State& state = *state_;
  Sandbox& box = *state.runtime->box;
  GraphBuilder graph(context, *state.shaders, ++state.builds);
  const StackEntry* current = nullptr;
  ImageRef image = graph.source();
  state.runtime->graph = &graph;
  box.diagnostics = &diagnostics;
  auto error = box.run(state.file, [&](lua_State* lua) {
    state.scale_lengths(lua, context);
    graph.scale_lengths(state.length_scale);
    if (state.may_change) state.resolve(lua, context);
    warn_without_position(state.explanation, diagnostics);
    for (const auto& run : state.runs) {
      current = &run.entry;
      image = state.build_entry(lua, run, graph, image, diagnostics);
    }
  });
  state.runtime->graph = nullptr;
  box.diagnostics = nullptr;
  if (error) return with_entry(std::move(*error), current);
  return graph.finish(image.id);
}

Result<std::vector<Hold>> Preset::holds(const std::string& entry, Size size) {
  State& state = *state_;
  std::vector<Hold> out;
  auto error = state.runtime->box->run(state.file, [&](lua_State* lua) {
    for (const auto& run : state.runs)
      if (run.entry.name == entry) out = holds_of(lua, run, size);
  });
  if (error) return std::move(*error);
  return out;
}

Result<std::vector<EntrySpace>> Preset::spaces() {
  State& state = *state_;
  std::vector<EntrySpace> out;
  auto error = state.runtime->box->run(state.file, [&](lua_State* lua) { out = trace_spaces(lua, state.runs); });
  if (error) return std::move(*error);
  return out;
}

Result<std::vector<EffectSchema>> list_effects(const SearchPath& path, Diagnostics& diagnostics) {
  std::vector<EffectSchema> schemas;
  for (const auto& name : effect_names(path)) {
    // A state each: an effect that spends its budget or memory takes nothing from the others.
    AFTERGLOW_TRY(const std::unique_ptr<Runtime> runtime, Runtime::create(path, ScriptLimits{}, diagnostics));
    int index = -1;
    const auto error = runtime->box->run(name + ".lua", [&](lua_State* lua) { index = find_effect(lua, name); });
    if (error)
      diagnostics.warn(fmt::format("effect '{}' is left out: {}", name, error->text()));
    else
      schemas.push_back(runtime->effects[static_cast<std::size_t>(index)].schema);
  }
  return schemas;
}

}  // namespace afterglow
