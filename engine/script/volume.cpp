// SPDX-License-Identifier: MIT
#include "script/volume.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "script/native.h"
#include "script/object.h"
#include "script/runtime.h"
#include "script/setting.h"
#include "script/table_reader.h"

namespace afterglow::script {
namespace {

constexpr std::size_t kMaxVolumes = 1024;       // of one state
constexpr std::size_t kMaxTargets = 64 * 1024;  // settings of entries that they set
constexpr std::size_t kMaxWanted = 16 * 1024;   // settings of all its volumes
const std::vector<std::string> kShapes{"global", "box", "sphere"};

SettingSchema schema_of(SettingType type, std::optional<double> min = {}, std::optional<double> max = {}) {
  SettingSchema schema;
  schema.type = type;
  schema.min = min;
  schema.max = max;
  return schema;
}

// A value of the table that cannot move; `otherwise` when it is not there.
SettingValue read_fixed(TableReader& table, const char* key, const SettingSchema& schema, SettingValue otherwise) {
  const Value given = table.value(key);
  if (given.kind == Value::Kind::nothing) return otherwise;
  auto checked = check_setting(fmt::format("{}: {}", table.what(), key), schema, given);
  if (checked) return std::move(*checked);
  table.fail({checked.error(), {key}, {}});
  return otherwise;
}

double read_number(TableReader& table, const char* key, double min, double max, double otherwise) {
  return read_fixed(table, key, schema_of(SettingType::number, min, max), {SettingType::number, {otherwise}, {}})
      .number[0];
}

Position read_position(TableReader& table, const char* key, std::optional<double> min, const Position& otherwise) {
  return read_fixed(table, key, schema_of(SettingType::vec3, min), {SettingType::vec3, otherwise, {}}).number;
}

// "sphere", or { "sphere", center = …, radius = … }.
VolumeShape read_shape(lua_State* lua, TableReader& volume) {
  VolumeShape shape;
  volume.push("shape");
  const int top = lua_gettop(lua);
  Value kind = read_value(lua, top);
  if (kind.kind == Value::Kind::nothing) {
    lua_settop(lua, top - 1);
    return shape;
  }
  const bool is_table = lua_istable(lua, top);
  if (is_table) {
    lua_rawgeti(lua, top, 1);
    kind = read_value(lua, -1);
  }
  const auto found = std::find(kShapes.begin(), kShapes.end(), kind.text);
  if (kind.kind != Value::Kind::text || found == kShapes.end()) {
    volume.fail(failure(fmt::format("{}: unknown shape {}", volume.what(), kind.shown()), {"shape"},
                        "\"global\", { \"box\", … }, { \"sphere\", … }", nearest_name(kind.text, kShapes)));
  } else {
    shape.kind = static_cast<ShapeKind>(found - kShapes.begin());
    if (is_table) {
      TableReader table(lua, top, "shape", volume, {"shape"});
      const std::vector<std::string> keys[] = {{}, {"center", "rotation", "size"}, {"center", "radius"}};
      for (const auto& key : table.keys())
        if (key.position > 1) table.fail(failure("shape has a value without a name", {key.name}));
      table.allow(keys[static_cast<int>(shape.kind)], true);
      shape.center = read_position(table, "center", {}, shape.center);
      if (shape.kind == ShapeKind::box) {
        shape.size = read_position(table, "size", 0, shape.size);
        shape.rotation = read_position(table, "rotation", {}, shape.rotation);
      }
      if (shape.kind == ShapeKind::sphere) shape.radius = read_number(table, "radius", 0, 1e30, shape.radius);
    }
  }
  lua_settop(lua, top - 1);
  return shape;
}

Animated read_weight(lua_State* lua, TableReader& table) {
  table.push("weight");
  const Given given = read_given(lua, -1);
  lua_pop(lua, 1);
  Animated whole;
  whole.fixed.number[0] = 1;
  if (given.value.kind == Value::Kind::nothing) return whole;
  auto checked = check_animated(lua, "fx.volume: weight", weight_schema(), given);
  if (checked) return std::move(*checked);
  table.fail({checked.error(), {"weight"}, {}});
  return whole;
}

void read_wanted(lua_State* lua, TableReader& volume, DeclaredVolume& declared) {
  volume.push("settings");
  const TableReader entries(lua, -1, "settings", volume, {"settings"});
  for (const auto& entry : entries.keys()) {
    if (entry.position > 0) {
      volume.fail(failure("fx.volume: settings has a value without a name", {"settings", entry.name},
                          "ENTRY = { SETTING = VALUE, … }"));
      continue;
    }
    entries.push(entry);
    const TableReader settings(lua, -1, "settings." + entry.name, volume, {"settings", entry.name});
    for (const auto& setting : settings.keys()) {
      if (setting.position > 0) {
        volume.fail(failure(fmt::format("fx.volume: settings.{} has a value without a name", entry.name),
                            {"settings", entry.name, setting.name}, "SETTING = VALUE"));
        continue;
      }
      settings.push(setting);
      declared.wanted.push_back({entry.name, setting.name, read_given(lua, -1)});
      lua_pop(lua, 1);
    }
    lua_pop(lua, 1);
  }
  lua_pop(lua, 1);
}

// A failure of a volume that was made elsewhere: at its key there.
[[noreturn]] void fail_volume(const Sandbox& box, const DeclaredVolume& volume, ScriptError error) {
  error.error.file = volume.file;
  error.error.line = line_of_key(box, volume.file, volume.line, "volume", error.key);
  throw error;
}

void aim(lua_State* lua, DeclaredVolume& volume, const DeclaredVolume::Wanted& wanted, const DeclaredEntry& declared) {
  const Sandbox& box = Sandbox::of(lua);
  const KeyPath key{"settings", wanted.entry, wanted.setting};
  const EffectSchema& schema = Runtime::of(lua).effects[static_cast<std::size_t>(declared.effect)].schema;
  std::vector<std::string> names;
  for (const auto& setting : schema.settings) names.push_back(setting.name);
  const auto found = std::find(names.begin(), names.end(), wanted.setting);
  if (found == names.end())
    fail_volume(box, volume,
                failure(fmt::format("fx.volume: effect '{}' has no setting '{}'", schema.name,
                                    tidy_message(wanted.setting, 60)),
                        key, join(names), nearest_name(wanted.setting, names)));
  const auto index = static_cast<std::size_t>(found - names.begin());
  auto checked = check_animated(lua, fmt::format("fx.volume: {}.{}", wanted.entry, wanted.setting),
                                schema.settings[index], wanted.value);
  if (!checked) fail_volume(box, volume, {checked.error(), key, {}});
  volume.targets.push_back({declared.entry.name, index, std::move(*checked)});
}

}  // namespace

const SettingSchema& weight_schema() {
  static const SettingSchema schema = schema_of(SettingType::number);
  return schema;
}

const SettingSchema& position_schema() {
  static const SettingSchema schema = schema_of(SettingType::vec3);
  return schema;
}

void aim_volume(lua_State* lua, DeclaredVolume& volume, const std::vector<DeclaredEntry>& entries) {
  Runtime& runtime = Runtime::of(lua);
  for (const auto& wanted : volume.wanted) {
    runtime.box->charge(entries.size());
    const auto named = [&](const DeclaredEntry& e) { return e.entry.name == wanted.entry; };
    const bool by_name = std::any_of(entries.begin(), entries.end(), named);
    bool found = false;
    for (const auto& declared : entries) {
      if (by_name ? !named(declared) : declared.entry.effect != wanted.entry) continue;
      found = true;
      if (++runtime.targets > kMaxTargets)
        fail_volume(*runtime.box, volume,
                    failure(fmt::format("volumes set more than {} settings of entries", kMaxTargets),
                            {"settings", wanted.entry, wanted.setting}));
      aim(lua, volume, wanted, declared);
    }
    std::vector<std::string> names;
    for (std::size_t i = 0; !found && i < entries.size(); ++i) names.push_back(entries[i].entry.name);
    if (!found)
      fail_volume(Sandbox::of(lua), volume,
                  failure(fmt::format("fx.volume: the stack has no entry '{}'", tidy_message(wanted.entry, 60)),
                          {"settings", wanted.entry}, join(names), nearest_name(wanted.entry, names)));
  }
  volume.wanted.clear();
}

int declare_volume(lua_State* lua) {
  Runtime& runtime = Runtime::of(lua);
  if (!runtime.declaring) throw failure("fx.volume can only be used while a script loads");
  if (runtime.volumes.size() >= kMaxVolumes) throw failure(fmt::format("more than {} volumes", kMaxVolumes));
  TableReader table(lua, 1, "fx.volume");
  table.allow({"blend_distance", "name", "priority", "settings", "shape", "snap_at", "weight"}, false);
  DeclaredVolume volume;
  volume.name = tidy_message(table.text("name").value_or(""), 60);
  volume.priority = table.number("priority").value_or(0);
  volume.weight = read_weight(lua, table);
  volume.shape = read_shape(lua, table);
  volume.blend_distance = read_number(table, "blend_distance", 0, 1e30, 0);
  volume.snap_at = read_number(table, "snap_at", 0, 1, volume.snap_at);
  read_wanted(lua, table, volume);
  table.finish("volume");
  runtime.wanted += volume.wanted.size();
  if (runtime.wanted > kMaxWanted) throw failure(fmt::format("more than {} settings of volumes", kMaxWanted));
  Error place;
  runtime.box->locate(place, runtime.box->caller(lua));
  volume.file = place.file;
  volume.line = place.line;
  runtime.volumes.push_back(std::move(volume));
  push_object(lua, kVolumeKind, Handle{static_cast<int>(runtime.volumes.size()) - 1});
  return 1;
}

}  // namespace afterglow::script
