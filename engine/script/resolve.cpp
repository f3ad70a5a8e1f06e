// SPDX-License-Identifier: MIT
#include "script/resolve.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "script/composite.h"

namespace afterglow::script {
namespace {

const EffectSchema& schema_of(lua_State* lua, const EntryRun& run) {
  return Runtime::of(lua).effects[static_cast<std::size_t>(run.effect)].schema;
}

const char* kind_of(const Animated& value) {
  return value.curve ? "curve" : value.function.set() ? "function" : "fixed";
}

void find_position(lua_State* lua, const Surroundings& surroundings, const BuildContext& context, Explanation& out) {
  if (surroundings.at) {
    out.position = surroundings.at;
    out.position_from = "--at";
  } else if (surroundings.position) {
    out.position = evaluate(lua, *surroundings.position, "fx.stack: position", position_schema(), context).number;
    out.position_from = "the preset";
  } else if (context.position) {
    out.position = context.position;
    out.position_from = "the picture";
  }
}

VolumeState state_of(lua_State* lua, const DeclaredVolume& volume, const std::optional<Position>& position,
                     const BuildContext& context) {
  VolumeState state{.name = volume.name, .file = volume.file, .line = volume.line, .priority = volume.priority};
  state.weight = evaluate(lua, volume.weight, volume.name + ".weight", weight_schema(), context).number[0];
  if (volume.shape.kind == ShapeKind::global) {
    state.factor = volume_factor(state.weight, 0, 0);
  } else if (position) {
    state.distance = volume.shape.distance_to(*position);
    state.factor = volume_factor(state.weight, *state.distance, volume.blend_distance);
  } else {
    state.reason = "no position is known";
    return state;
  }
  if (state.factor <= 0) state.reason = state.weight <= 0 ? "its weight is 0" : "too far away";
  return state;
}

EntryHistory start_of(lua_State* lua, const EntryRun& run, const BuildContext& context) {
  const EffectSchema& schema = schema_of(lua, run);
  EntryHistory entry{run.entry.name, {}};
  for (std::size_t i = 0; i < schema.settings.size(); ++i)
    entry.settings.push_back(
        history_of(lua, schema.settings[i], run.sources[i], run.entry.name + "." + schema.settings[i].name, context));
  return entry;
}

using Places = std::unordered_map<std::string_view, std::size_t>;  // of entries, by name

void blend_in(lua_State* lua, const DeclaredVolume& volume, const VolumeState& state, const std::vector<EntryRun>& runs,
              const Places& places, const BuildContext& context, std::vector<EntryHistory>& entries) {
  for (const auto& target : volume.targets) {
    const auto place = places.find(target.entry);
    if (place == places.end()) continue;
    const SettingSchema& schema = schema_of(lua, runs[place->second]).settings[target.setting];
    SettingHistory& setting = entries[place->second].settings[target.setting];
    VolumeStep step{.volume = volume.name, .factor = state.factor};
    step.value =
        evaluate(lua, target.value, fmt::format("{}: {}.{}", volume.name, target.entry, schema.name), schema, context);
    setting.value = step.result = interpolate(setting.value, step.value, state.factor, volume.snap_at);
    setting.volumes.push_back(std::move(step));
  }
}

}  // namespace

SettingHistory history_of(lua_State* lua, const SettingSchema& schema, const SettingSource& source,
                          const std::string& full_name, const BuildContext& context) {
  SettingHistory history{.name = schema.name, .default_value = schema.default_value};
  history.value = schema.default_value;
  if (source.preset) {
    history.value = evaluate(lua, *source.preset, full_name, schema, context);
    history.preset = history.value;
    history.kind = kind_of(*source.preset);
    history.place = source.place;
  }
  history.overridden = source.overridden;
  return history;
}

void note_named_in(StackEntry& entry, const SettingHistory& setting, const EffectSchema& effect,
                   const std::vector<VolumeState>& volumes) {
  const SettingType type = setting.value.type;
  if ((type != SettingType::file && type != SettingType::text) || setting.value.choice.empty()) return;
  std::string script = setting.preset ? (setting.place ? setting.place->file : "") : effect.file.string();
  for (const VolumeStep& step : setting.volumes)
    for (const VolumeState& volume : volumes)
      if (volume.name == step.volume && step.result == step.value) script = volume.file;
  if (setting.overridden) script.clear();
  entry.named_in[setting.name] = script;
}

bool may_change(const EntryRun& run, const Surroundings& surroundings) {
  const auto moves = [](const SettingSource& source) { return source.preset && source.preset->moves(); };
  const auto aimed_at = [&](const DeclaredVolume& volume) {
    return std::any_of(volume.targets.begin(), volume.targets.end(),
                       [&](const auto& target) { return target.entry == run.entry.name; });
  };
  return composition_moves(run) || std::any_of(run.sources.begin(), run.sources.end(), moves) ||
         std::any_of(surroundings.volumes.begin(), surroundings.volumes.end(), aimed_at);
}

bool may_change(const std::vector<EntryRun>& runs, const Surroundings& surroundings) {
  return std::any_of(runs.begin(), runs.end(), [&](const EntryRun& run) { return may_change(run, surroundings); });
}

Explanation resolve_settings(lua_State* lua, std::vector<EntryRun>& runs, const Surroundings& surroundings,
                             const BuildContext& context) {
  Explanation out;
  find_position(lua, surroundings, context, out);
  for (const auto& run : runs) out.entries.push_back(start_of(lua, run, context));
  Places places;
  for (std::size_t i = 0; i < runs.size() && !surroundings.volumes.empty(); ++i) places.emplace(runs[i].entry.name, i);
  for (const auto& volume : surroundings.volumes) {
    out.volumes.push_back(state_of(lua, volume, out.position, context));
    blend_in(lua, volume, out.volumes.back(), runs, places, context, out.entries);
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    settle_composition(lua, runs[i], context, out.entries[i]);
    auto& settings = runs[i].entry.settings;
    settings.clear();
    const EffectSchema& schema = schema_of(lua, runs[i]);
    for (auto& history : out.entries[i].settings) {
      if (history.overridden) history.value = *history.overridden;
      settings.emplace_back(history.name, history.value);
      note_named_in(runs[i].entry, history, schema, out.volumes);
    }
  }
  return out;
}

}  // namespace afterglow::script
