// SPDX-License-Identifier: MIT
#include "script/entry_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "script/animated.h"
#include "script/injection.h"
#include "script/mask.h"
#include "script/overrides.h"

namespace afterglow::script {
namespace {

bool is_entry_name(const std::string& name) {
  if (name.empty() || name.size() > 64) return false;
  return std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
}

bool has_setting(const EffectSchema& schema, const std::string& name) {
  return std::ranges::find(schema.settings, name, &SettingSchema::name) != schema.settings.end();
}

std::shared_ptr<const ScriptPlace> caller_of(lua_State* lua) {
  const Sandbox& box = Sandbox::of(lua);
  Error place;
  box.locate(place, box.caller(lua));
  return std::make_shared<const ScriptPlace>(ScriptPlace{place.file, place.line});
}

// How the entry's result is put over what it was given.
void read_composition(lua_State* lua, TableReader& table, const EffectSchema& schema, DeclaredEntry& declared) {
  read_mask(lua, table, declared);
  const auto place = caller_of(lua);
  const auto read = [&](const char* key, SettingSource& source) {
    if (has_setting(schema, key)) return;
    table.push(key);
    const Given given = read_given(lua, -1);
    lua_pop(lua, 1);
    if (given.value.kind == Value::Kind::nothing) return;
    auto checked = check_animated(lua, schema.name + "." + key, entry_key_schema(key), given);
    if (checked)
      source = {.preset = std::move(*checked), .place = place, .overridden = {}};
    else
      table.fail({checked.error(), {key}, {}});
  };
  read("opacity", declared.opacity);
  read("blend", declared.blend);
}

// Where and whether the entry runs.
void read_place(TableReader& table, DeclaredEntry& declared) {
  StackEntry& entry = declared.entry;
  const auto at = table.text("at");
  const auto order = table.integer("order");
  declared.says_at = declared.says_at || at;
  declared.says_order = declared.says_order || order;
  entry.at = at.value_or(entry.at);
  if (std::find(injection_points().begin(), injection_points().end(), entry.at) == injection_points().end())
    table.fail(failure(fmt::format("unknown injection point '{}'", tidy_message(entry.at, 60)), {"at"},
                       join(injection_points()), nearest_name(entry.at, injection_points())));
  entry.order = order.value_or(entry.order);
  entry.enabled = table.boolean("enabled").value_or(entry.enabled);
  if (const auto required = table.boolean("required")) {
    entry.required = *required;
    entry.can_lack = !*required;
  }
  const auto name = table.text("name");
  if (!name) return;
  declared.name = name;
  if (!is_entry_name(*name))
    table.fail(failure(fmt::format("'{}' cannot be the name of an entry", tidy_message(*name, 60)), {"name"},
                       "1 to 64 letters, digits, '_' and '-'"));
}

void fail_unknown(lua_State* lua, TableReader& table, const EffectSchema& schema, const TableReader::Key& key,
                  const std::vector<std::string>& others) {
  std::vector<std::string> names;
  for (const auto& setting : schema.settings) names.push_back(setting.name);
  const char* what = table.what().starts_with("fx.mask.") ? "mask" : "effect";
  if (key.position > 0) {
    // What is left of `0,2` behind its comma.
    table.push(key);
    const Value value = read_value(lua, -1);
    lua_pop(lua, 1);
    const bool digits = value.kind == Value::Kind::number && value.number == std::floor(value.number) &&
                        value.number >= 0 && table.keys().back().position == 0;
    const std::string point = digits ? fmt::format(": {}; numbers have a point, as 0.5 has", value.shown()) : "";
    table.fail(failure(
        fmt::format("{} '{}' has a value without a name at position {}{}", what, schema.name, key.position, point),
        {key.name}, join(names)));
    return;
  }
  std::vector<std::string> near = names;
  near.insert(near.end(), others.begin(), others.end());
  const std::string hides =
      schema.shadowed.empty() ? "" : fmt::format(" ({}, which hides another one)", schema.file.string());
  table.fail(failure(fmt::format("{} '{}'{} has no setting '{}'", what, schema.name, hides, tidy_message(key.name, 60)),
                     {key.name}, join(names), nearest_name(key.name, near)));
}

}  // namespace

DeclaredEntry new_entry(const Runtime& runtime, int effect) {
  const EffectSchema& schema = runtime.effects[static_cast<std::size_t>(effect)].schema;
  DeclaredEntry declared;
  declared.effect = effect;
  declared.entry.effect = schema.name;
  declared.entry.at = schema.at;
  declared.entry.order = schema.order;
  declared.sources.resize(schema.settings.size());
  return declared;
}

void read_entry_keys(lua_State* lua, TableReader& table, const EffectSchema& schema, DeclaredEntry& declared) {
  read_place(table, declared);
  read_composition(lua, table, schema, declared);
}

void read_entry(lua_State* lua, TableReader& table, const EffectSchema& schema, DeclaredEntry& declared) {
  read_entry_keys(lua, table, schema, declared);
  read_settings_of(lua, table, schema, declared, entry_keys());
}

void read_settings_of(lua_State* lua, TableReader& table, const EffectSchema& schema, DeclaredEntry& declared,
                      const std::vector<std::string>& others) {
  const auto place = caller_of(lua);
  for (const auto& key : table.keys()) {
    if (std::ranges::find(others, key.name) != others.end() && !has_setting(schema, key.name)) continue;
    const auto found =
        std::find_if(schema.settings.begin(), schema.settings.end(), [&](const auto& s) { return s.name == key.name; });
    if (found == schema.settings.end()) {
      fail_unknown(lua, table, schema, key, others);
      continue;
    }
    table.push(key);
    auto checked = check_animated(lua, schema.name + "." + key.name, *found, read_given(lua, -1));
    lua_pop(lua, 1);
    if (checked)
      declared.sources[static_cast<std::size_t>(found - schema.settings.begin())] = {
          .preset = std::move(*checked), .place = place, .overridden = {}};
    else
      table.fail({checked.error(), {key.name}, {}});
  }
}

}  // namespace afterglow::script
