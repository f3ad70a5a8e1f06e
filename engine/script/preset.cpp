// SPDX-License-Identifier: MIT
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
#include "script/preset_state.h"
#include "script/resolve.h"
#include "script/space.h"

namespace afterglow {

Error with_entry(Error error, const StackEntry* entry) {
  if (entry && error.file != entry->file && error.kind == ErrorKind::script)
    error.trail.push_back(fmt::format("in effect '{}' of {}:{}", entry->name, entry->file, entry->line));
  return error;
}

void Preset::State::load(lua_State* lua, const PresetOptions& options) {
  open_graph_binding(lua);
  runtime->given_arguments = options.arguments;
  runtime->note_reads = options.note_reads;
  runtime->leave_out_unfit = options.leave_out_unfit;
  runtime->arguments_that_must_fit = options.must_fit.arguments;
  DeclaredStack stack = load_stack(lua, file, options.text);
  runtime->declaring = false;
  check_arguments(*runtime);
  shaders->search(runtime->path);
  Diagnostics* left_out = options.leave_out_unfit ? runtime->box->diagnostics : nullptr;
  const std::size_t must_fit = options.must_fit.overrides;
  if (auto applied = apply_overrides(stack.entries, options.overrides, *runtime, left_out, must_fit); !applied)
    throw ScriptError{applied.error()};
  sort_entries(stack.entries);
  name = stack.name.empty() ? std::filesystem::path(file).stem().string() : stack.name;
  max_error = stack.max_error;
  reference_height = stack.reference_height;
  input_space = stack.input_space;
  gamut = stack.gamut;
  alpha = stack.alpha;
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
  BuildContext assumed;
  assumed.time = assumed.frame / assumed.fps;
  runtime->provisional = true;
  resolve(lua, assumed);
  runtime->provisional = false;
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

bool Preset::State::note(const std::vector<std::string>& inputs) {
  constexpr std::size_t kMost = 1024;  // a script may ask for another one each time
  const std::size_t before = needs.size();
  for (const auto& input : inputs)
    if (needs.size() < kMost && std::find(needs.begin(), needs.end(), input) == needs.end()) needs.push_back(input);
  return needs.size() > before;
}

void Preset::State::note_needs(lua_State* lua, const StackEntry*& current) {
  for (const auto& run : runs) {
    current = &run.entry;
    const bool changes = script::may_change(run, surroundings);
    if (!run.entry.enabled || (!changes && why_inactive(lua, run))) continue;
    note(used_inputs(lua, run));
    std::vector<std::string> of_masks;
    add_mask_inputs(lua, run, MaskInputs::used_later, of_masks);
    note(of_masks);
    // Other settings may ask for other inputs: what an effect asks for by a function cannot be known before.
    needs_unknown = needs_unknown || (changes && asks_by_function(*runtime, run));
    needs_move = needs_move || needs_unknown || mask_inputs_move(*runtime, run);
  }
}

bool Preset::State::note_needs_now(lua_State* lua, const StackEntry*& current) {
  bool more = false;
  for (const auto& run : runs) {
    if (!run.entry.enabled || !script::may_change(run, surroundings)) continue;
    current = &run.entry;
    std::vector<std::string> inputs;
    if (!why_inactive(lua, run)) inputs = used_inputs(lua, run);
    add_mask_inputs(lua, run, MaskInputs::used, inputs);
    more = note(inputs) || more;
  }
  return more;
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
std::optional<bool> Preset::keeps_negative() const {
  return state_->gamut.empty() ? std::nullopt : std::optional(state_->gamut == "keep");
}
std::optional<double> Preset::max_error() const { return state_->max_error; }
const std::vector<PresetArgument>& Preset::arguments() const { return state_->runtime->arguments; }
bool Preset::sees_associated() const { return state_->alpha == "associated"; }
bool Preset::may_change() const { return state_->may_change; }
bool Preset::may_look_back() const {
  return std::ranges::any_of(state_->runtime->box->sources(), [](const Source& source) {
    return !source.library && source.text.find("history") != std::string::npos;
  });
}
const std::vector<StackEntry>& Preset::entries() const { return *state_->loaded; }
const Explanation& Preset::explanation() const { return *state_->loaded_so; }
bool Preset::detailed() const {
  return std::any_of(entries().begin(), entries().end(),
                     [&](const StackEntry& entry) { return entry.enabled && schema(entry.effect).detail; });
}
std::uint64_t Preset::evaluations() const { return state_->evaluations; }
const std::vector<std::string>& Preset::needs() const { return state_->needs; }
std::vector<std::string> Preset::possible_needs() const {
  std::vector<std::string> out = state_->needs;
  for (const auto& input : auxiliary_inputs())
    if (state_->needs_unknown && std::ranges::find(out, input) == out.end()) out.push_back(input);
  return out;
}
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

Result<bool> Preset::note_needs(const BuildContext& context) {
  State& state = *state_;
  if (!state.needs_move) return false;
  bool more = false;
  const StackEntry* current = nullptr;
  auto error = state.runtime->box->run(state.file, [&](lua_State* lua) {
    state.resolve(lua, context);
    more = state.note_needs_now(lua, current);
  });
  if (error) return with_entry(std::move(*error), current);
  return more;
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

BuildContext usual_context(Preset& preset, Size size, double frame, double fps) {
  BuildContext out{.size = size, .auxiliary = {}, .frame = frame, .time = frame / fps, .fps = fps};
  (void)preset.note_needs(out);  // what is wrong there is wrong when it is evaluated
  for (const auto& name : preset.needs()) out.auxiliary[name] = size;
  return out;
}

}  // namespace afterglow
