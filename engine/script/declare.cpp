// SPDX-License-Identifier: MIT
#include "script/declare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/text.h"
#include "script/injection.h"
#include "script/invariant_reader.h"
#include "script/object.h"
#include "script/setting.h"
#include "script/space.h"
#include "script/table_reader.h"

namespace afterglow::script {
namespace {

constexpr std::size_t kMaxDeclared = 4096;  // settings, effects, entries of one state

constexpr const char* kMakers[] = {"int", "float", "bool", "enum", "color", "vec2", "vec3", "file", "text"};

std::vector<std::string> known_keys(SettingType type) {
  switch (type) {
    case SettingType::integer:
    case SettingType::number:
    case SettingType::vec2:
    case SettingType::vec3:
      return {"default", "doc", "max", "min", "unit"};
    case SettingType::file:
      return {"default", "doc", "extensions"};
    default:
      return {"default", "doc"};
  }
}

void read_choices(lua_State* lua, TableReader& table, SettingSchema& schema) {
  for (const auto& key : table.keys()) {
    if (key.position == 0) continue;
    table.push(key);
    const Value given = read_value(lua, -1);
    lua_pop(lua, 1);
    if (given.kind != Value::Kind::text || !is_identifier(given.text))
      table.fail(failure(fmt::format("{}: choice {} is {}", table.what(), key.position, given.shown()), {key.name},
                         "texts of letters, digits and '_'"));
    else if (std::find(schema.choices.begin(), schema.choices.end(), given.text) != schema.choices.end())
      table.fail(failure(fmt::format("{}: '{}' is there twice", table.what(), given.text), {key.name}));
    else
      schema.choices.push_back(given.text);
  }
  if (schema.choices.empty() && !table.failed()) table.fail(failure(fmt::format("{} has no choices", table.what())));
}

// { "cube", "png" }; the texts of a table or of the setting itself.
void read_extensions(lua_State* lua, TableReader& table, SettingSchema& schema) {
  const int top = lua_gettop(lua);
  table.push("extensions");
  if (lua_istable(lua, -1)) {
    const TableReader list(lua, -1, "extensions");
    for (const auto& key : list.keys()) {
      list.push(key);
      const Value given = read_value(lua, -1);
      lua_pop(lua, 1);
      const bool fits =
          key.position > 0 && given.kind == Value::Kind::text && !given.text.empty() &&
          std::ranges::all_of(given.text, [](unsigned char c) { return std::islower(c) || std::isdigit(c); });
      if (!fits)
        table.fail(failure(fmt::format("{}: {} is no extension of a file", table.what(), given.shown()),
                           {"extensions", key.name}, "small letters and digits, without the point"));
      else
        schema.choices.push_back(given.text);
    }
  }
  lua_settop(lua, top);
  if (schema.choices.empty() && !table.failed())
    table.fail(failure(fmt::format("{} needs extensions, those that its files may have", table.what()), {"extensions"},
                       "{ \"cube\" }"));
}

void read_default(TableReader& table, SettingSchema& schema) {
  const Value given = table.value("default");
  if (given.kind == Value::Kind::nothing && (schema.type == SettingType::file || schema.type == SettingType::text)) {
    schema.default_value.type = schema.type;
    return;
  }
  if (given.kind == Value::Kind::nothing) {
    table.fail(failure(fmt::format("{} has no default", table.what()), {}, allowed_text(schema)));
    return;
  }
  auto checked = check_setting(fmt::format("{}: default", table.what()), schema, given);
  if (checked)
    schema.default_value = *checked;
  else
    table.fail({checked.error(), {"default"}, {}});
}

int make_setting(lua_State* lua, SettingType type) {
  Runtime& runtime = Runtime::of(lua);
  const char* maker = kMakers[static_cast<int>(type)];
  const std::string what = fmt::format("fx.{}", maker);
  if (!runtime.declaring) throw failure(what + " can only be used while a script loads");
  if (runtime.settings.size() >= kMaxDeclared) throw failure(fmt::format("more than {} settings", kMaxDeclared));
  TableReader table(lua, 1, what);
  table.allow(known_keys(type), type == SettingType::enumeration);
  SettingSchema schema;
  schema.type = type;
  schema.doc = table.text("doc").value_or("");
  schema.unit = table.text("unit", 20).value_or("");
  schema.min = table.number("min");
  schema.max = table.number("max");
  if (schema.min && schema.max && *schema.min > *schema.max)
    table.fail(failure(
        fmt::format("{}: min {} is above max {}", what, number_text(*schema.min), number_text(*schema.max)), {"min"}));
  if (type == SettingType::color) schema.min = 0;
  if (type == SettingType::enumeration) read_choices(lua, table, schema);
  if (type == SettingType::file) read_extensions(lua, table, schema);
  if (!table.failed()) read_default(table, schema);
  table.finish(maker);
  runtime.settings.push_back({std::move(schema)});
  push_object(lua, kSettingKind, Handle{static_cast<int>(runtime.settings.size()) - 1});
  return 1;
}

void read_settings(lua_State* lua, TableReader& table, EffectSchema& schema) {
  table.push("settings");
  if (lua_isnil(lua, -1)) {
    lua_pop(lua, 1);
    return;
  }
  if (!lua_istable(lua, -1)) {
    table.fail(failure(fmt::format("{}: settings = {} is not a table", table.what(), read_value(lua, -1).shown()),
                       {"settings"}));
    lua_pop(lua, 1);
    return;
  }
  TableReader settings(lua, -1, table.what(), table, {"settings"});
  schema.settings = read_setting_types(lua, settings, entry_keys());
  lua_pop(lua, 1);
}

FunctionRef read_function(lua_State* lua, TableReader& table, const char* name, bool needed) {
  table.push(name);
  if (lua_isfunction(lua, -1)) return {luaL_ref(lua, LUA_REGISTRYINDEX)};
  if (needed && lua_isnil(lua, -1)) {
    // A key that is unknown is this one misspelt, as like as not, and says so at its own line.
    if (!table.failed()) table.fail(failure(fmt::format("{} needs '{}', a function", table.what(), name)));
  } else if (!lua_isnil(lua, -1))
    table.fail(
        failure(fmt::format("{}: {} = {} is not a function", table.what(), name, read_value(lua, -1).shown()), {name}));
  lua_pop(lua, 1);
  return {};
}

// "associated" or "straight": the colour that the effect's pixel shaders see.
std::string read_alpha(TableReader& table) {
  static const std::vector<std::string> kWords{"associated", "straight"};
  const std::string word = table.text("alpha").value_or(kWords.front());
  if (std::find(kWords.begin(), kWords.end(), word) == kWords.end())
    table.fail(failure(fmt::format("fx.effect: alpha cannot be '{}'", tidy_message(word, 60)), {"alpha"}, join(kWords),
                       nearest_name(word, kWords)));
  return word;
}

InputList read_inputs(lua_State* lua, TableReader& table, const char* name) {
  const int top = lua_gettop(lua);
  table.push(name);
  if (lua_isnil(lua, -1)) {
    lua_pop(lua, 1);
    return {};
  }
  if (lua_isfunction(lua, -1)) return {{}, {luaL_ref(lua, LUA_REGISTRYINDEX)}};
  try {
    return {pop_input_names(lua, fmt::format("{}: {}", table.what(), name)), {}};
  } catch (ScriptError& error) {
    lua_settop(lua, top);
    error.key.insert(error.key.begin(), name);
    table.fail(std::move(error));
    return {};
  }
}

}  // namespace

template <SettingType type>
int declare_setting(lua_State* lua) {
  return make_setting(lua, type);
}
template int declare_setting<SettingType::integer>(lua_State*);
template int declare_setting<SettingType::number>(lua_State*);
template int declare_setting<SettingType::boolean>(lua_State*);
template int declare_setting<SettingType::enumeration>(lua_State*);
template int declare_setting<SettingType::color>(lua_State*);
template int declare_setting<SettingType::vec2>(lua_State*);
template int declare_setting<SettingType::vec3>(lua_State*);
template int declare_setting<SettingType::file>(lua_State*);
template int declare_setting<SettingType::text>(lua_State*);

std::vector<std::string> pop_input_names(lua_State* lua, const std::string& what) {
  if (!lua_istable(lua, -1))
    throw failure(fmt::format("{} = {} is not a list of inputs", what, read_value(lua, -1).shown()), {},
                  "{ \"depth\" }");
  const TableReader table(lua, -1, what);
  std::vector<std::string> names;
  for (const auto& key : table.keys()) {
    table.push(key);
    const Value given = read_value(lua, -1);
    lua_pop(lua, 1);
    if (key.position == 0 || given.kind != Value::Kind::text)
      throw failure(fmt::format("{} holds {}, not the name of an input", what, given.shown()), {key.name},
                    join(auxiliary_inputs()));
    const bool layer = given.text.starts_with(kLayerPrefix) && given.text.size() > kLayerPrefix.size();
    if (!layer &&
        std::find(auxiliary_inputs().begin(), auxiliary_inputs().end(), given.text) == auxiliary_inputs().end())
      throw failure(fmt::format("{}: unknown input '{}'", what, tidy_message(given.text, 60)), {key.name},
                    join(auxiliary_inputs()) + ", layer:NAME", nearest_name(given.text, auxiliary_inputs()));
    names.push_back(given.text);
  }
  lua_pop(lua, 1);
  return names;
}

std::vector<SettingSchema> read_setting_types(lua_State* lua, TableReader& table,
                                              const std::vector<std::string>& taken) {
  const Runtime& runtime = Runtime::of(lua);
  std::vector<std::pair<int, SettingSchema>> found;
  for (const auto& key : table.keys()) {
    table.push(key);
    const Handle* handle = to_object<Handle>(lua, -1, kSettingKind);
    const std::string shown = read_value(lua, -1).shown();
    lua_pop(lua, 1);
    if (key.position > 0)
      table.fail(
          failure(fmt::format("{}: a setting needs a name", table.what()), {key.name}, "letters, digits and '_'"));
    else if (!is_identifier(key.name))
      table.fail(
          failure(fmt::format("{}: '{}' cannot be the name of a setting", table.what(), tidy_message(key.name, 60)),
                  {key.name}, "1 to 64 letters, digits and '_', no digit first"));
    else if (std::ranges::count(taken, key.name) > std::ranges::count(replaceable_keys(), key.name))
      table.fail(failure(fmt::format("{}: no setting may be named '{}', which every entry has", table.what(), key.name),
                         {key.name}));
    else if (!handle)
      table.fail(failure(fmt::format("{}: setting '{}' = {} is not a setting type", table.what(), key.name, shown),
                         {key.name},
                         "fx.int, fx.float, fx.bool, fx.enum, fx.color, fx.vec2, fx.vec3, fx.file, fx.text"));
    else
      found.emplace_back(handle->index, runtime.settings[static_cast<std::size_t>(handle->index)].schema).second.name =
          key.name;
  }
  // A table keeps no order; the types were made one after the other, in the order in which they are written.
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<SettingSchema> out;
  for (auto& [order, setting] : found) out.push_back(std::move(setting));
  return out;
}

int declare_effect(lua_State* lua) {
  Runtime& runtime = Runtime::of(lua);
  if (!runtime.declaring) throw failure("fx.effect can only be used while a script loads");
  if (runtime.effects.size() >= kMaxDeclared) throw failure(fmt::format("more than {} effects", kMaxDeclared));
  TableReader table(lua, 1, "fx.effect");
  table.allow({"active", "alpha", "at", "build", "detail", "doc", "holds", "idle", "name", "needs", "optional", "order",
               "settings", "space"},
              false);
  Effect effect;
  EffectSchema& schema = effect.schema;
  schema.name = table.text("name").value_or("");
  if (!is_identifier(schema.name) && !table.failed())
    table.fail(failure("fx.effect needs a name", {"name"}, "letters, digits and '_'"));
  const bool is_mask = Runtime::of(lua).loading.contains("masks." + schema.name);  // which is fx.mask.NAME
  if (!is_mask && std::ranges::find(library_names(), schema.name) != library_names().end())
    table.fail(failure(fmt::format("fx.effect: the name '{}' is taken by the library", schema.name), {"name"}));
  schema.doc = table.text("doc").value_or("");
  schema.at = table.text("at").value_or("post_process");
  if (std::find(injection_points().begin(), injection_points().end(), schema.at) == injection_points().end())
    table.fail(failure(fmt::format("fx.effect: unknown injection point '{}'", tidy_message(schema.at, 60)), {"at"},
                       join(injection_points()), nearest_name(schema.at, injection_points())));
  schema.order = table.integer("order").value_or(0);
  schema.straight = read_alpha(table) == "straight";
  schema.detail = table.boolean("detail").value_or(false);
  read_space(lua, table, effect);
  read_settings(lua, table, schema);
  read_invariants(lua, table, effect);
  effect.active = read_function(lua, table, "active", false);
  effect.build = read_function(lua, table, "build", true);
  effect.idle = read_function(lua, table, "idle", false);
  effect.needs = read_inputs(lua, table, "needs");
  effect.optional = read_inputs(lua, table, "optional");
  schema.needs = {effect.needs.names, effect.needs.function.set()};
  schema.optional = {effect.optional.names, effect.optional.function.set()};
  table.finish("effect");
  runtime.effects.push_back(std::move(effect));
  push_object(lua, kEffectKind, Handle{static_cast<int>(runtime.effects.size()) - 1});
  return 1;
}

}  // namespace afterglow::script
