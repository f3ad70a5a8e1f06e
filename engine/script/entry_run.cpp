// SPDX-License-Identifier: MIT
#include "script/entry_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/text.h"
#include "script/declare.h"
#include "script/graph_binding.h"
#include "script/native.h"
#include "script/read_only.h"
#include "script/setting.h"
#include "script/table_reader.h"
#include "script/unread.h"

namespace afterglow::script {
namespace {

const Effect& effect_of(lua_State* lua, const EntryRun& run) {
  return Runtime::of(lua).effects[static_cast<std::size_t>(run.effect)];
}

int unknown_setting(lua_State* lua) {
  const auto index = static_cast<std::size_t>(lua_tointeger(lua, lua_upvalueindex(1)));
  const EffectSchema& schema = Runtime::of(lua).effects[index].schema;
  const Value key = read_value(lua, 2);
  std::vector<std::string> names;
  for (const auto& setting : schema.settings) names.push_back(setting.name);
  static const std::vector<std::string> kOfTheGraph{"filter", "history", "image", "input", "keep",
                                                    "lookup", "ocio",    "pass",  "skip"};
  if (std::ranges::count(kOfTheGraph, key.text) > 0)
    throw failure(fmt::format("effect '{}' has no setting {}; it is one of the graph's", schema.name, key.shown()), {},
                  "build = function(g, s, source), the graph before the settings");
  throw failure(fmt::format("effect '{}' has no setting {}", schema.name, key.shown()), {}, join(names),
                nearest_name(key.text, names));
}

// A failure of a whole function: at the line where the function begins.
[[noreturn]] void fail_in(lua_State* lua, const FunctionRef& function, const std::string& message,
                          const ScriptError* from = nullptr) {
  ScriptError error = from ? *from : failure(message);
  locate_function(lua, function, error.error);
  throw error;
}

// While it lives, errors of level 0 point at the entry.
class Blaming {
 public:
  Blaming(lua_State* lua, const StackEntry& entry)
      : box_(Sandbox::of(lua)), blame_{entry.file, entry.line, entry.effect} {
    box_.blame = &blame_;
  }
  ~Blaming() { box_.blame = nullptr; }
  Blaming(const Blaming&) = delete;
  Blaming& operator=(const Blaming&) = delete;

 private:
  Sandbox& box_;
  Blame blame_;
};

void call_with_settings(lua_State* lua, const FunctionRef& function, const EntryRun& run, int results) {
  const Blaming blaming(lua, run.entry);
  lua_rawgeti(lua, LUA_REGISTRYINDEX, function.ref);
  lua_rawgeti(lua, LUA_REGISTRYINDEX, run.settings_ref);
  lua_pushnumber(lua, run.length_scale);
  call(lua, 2, results);
}

std::vector<std::string> input_names(lua_State* lua, const EntryRun& run, const InputList& list, const char* what) {
  if (!list.function.set()) return list.names;
  call_with_settings(lua, list.function, run, 1);
  const std::string name = fmt::format("{} of effect '{}'", what, run.entry.effect);
  if (lua_isnil(lua, -1)) {
    lua_pop(lua, 1);
    return {};
  }
  try {
    return pop_input_names(lua, name);
  } catch (ScriptError& error) {
    fail_in(lua, list.function, "", &error);
  }
}

// A length of the delivered picture as one of the picture that runs.
SettingValue scaled(SettingValue value, const SettingSchema& schema, double scale) {
  if (schema.unit != "px" || scale == 1) return value;
  const bool whole = schema.type == SettingType::integer;
  for (double& number : value.number) {
    number *= scale;
    if (whole) number = std::max(std::round(number), schema.min.value_or(std::numeric_limits<double>::lowest()));
  }
  return value;
}

}  // namespace

void make_settings(lua_State* lua, EntryRun& run, double length_scale) {
  const EffectSchema& schema = effect_of(lua, run).schema;
  run.length_scale = length_scale;
  luaL_unref(lua, LUA_REGISTRYINDEX, run.settings_ref);
  run.settings_ref = LUA_NOREF;
  lua_createtable(lua, 0, static_cast<int>(run.entry.settings.size()));
  for (std::size_t i = 0; i < run.entry.settings.size(); ++i) {
    const auto& [name, value] = run.entry.settings[i];
    push_setting(lua, scaled(value, schema.settings[i], length_scale));
    lua_setfield(lua, -2, name.c_str());
  }
  lua_createtable(lua, 0, 1);
  lua_pushinteger(lua, run.effect);
  lua_pushcclosure(lua, (&native<unknown_setting, "">), 1);
  lua_setfield(lua, -2, "__index");
  lua_setmetatable(lua, -2);
  make_read_only(lua);
  if (Runtime::of(lua).note_reads) note_reads(lua, run);
  run.settings_ref = luaL_ref(lua, LUA_REGISTRYINDEX);
}

std::optional<Inactive> why_inactive(lua_State* lua, const EntryRun& run) {
  const Effect& effect = effect_of(lua, run);
  if (!effect.active.set()) return {};
  call_with_settings(lua, effect.active, run, 3);
  const Value active = read_value(lua, -3), reason = read_value(lua, -2);
  const bool told = lua_toboolean(lua, -1) != 0;
  lua_pop(lua, 3);
  if (active.kind != Value::Kind::boolean)
    fail_in(lua, effect.active,
            fmt::format("active of effect '{}' returned {}, not true or false", effect.schema.name, active.shown()));
  if (active.number != 0) return {};
  const bool given = reason.kind == Value::Kind::text;
  return Inactive{given ? tidy_message(reason.text, 200) : "its settings leave the picture as it is", told};
}

bool asks_by_function(const Runtime& runtime, const EntryRun& run) {
  const Effect& effect = runtime.effects[static_cast<std::size_t>(run.effect)];
  return effect.needs.function.set() || effect.optional.function.set();
}

std::vector<std::string> needed_inputs(lua_State* lua, const EntryRun& run) {
  return input_names(lua, run, effect_of(lua, run).needs, "needs");
}

std::vector<std::string> optional_inputs(lua_State* lua, const EntryRun& run) {
  return input_names(lua, run, effect_of(lua, run).optional, "optional");
}

std::vector<std::string> used_inputs(lua_State* lua, const EntryRun& run) {
  std::vector<std::string> inputs = needed_inputs(lua, run);
  for (auto& input : optional_inputs(lua, run)) inputs.push_back(std::move(input));
  return inputs;
}

std::optional<double> idle_limit(lua_State* lua, const EntryRun& run, const ImageRef& source) {
  const Effect& effect = effect_of(lua, run);
  if (!effect.idle.set()) return {};
  {
    const Blaming blaming(lua, run.entry);
    lua_rawgeti(lua, LUA_REGISTRYINDEX, effect.idle.ref);
    lua_rawgeti(lua, LUA_REGISTRYINDEX, run.settings_ref);
    push_image(lua, source);
    lua_pushnumber(lua, run.length_scale);
    call(lua, 3, 1);
  }
  const std::string what = fmt::format("idle of effect '{}'", effect.schema.name);
  const Value given = read_value(lua, -1);
  if (given.kind == Value::Kind::nothing) {
    lua_pop(lua, 1);
    return {};
  }
  if (!lua_istable(lua, -1))
    fail_in(lua, effect.idle, fmt::format("{} returned {}, not a condition: {{ brightest = L }}", what, given.shown()));
  Value limit;
  try {
    TableReader table(lua, -1, what);
    table.allow({"brightest"}, false);
    limit = table.value("brightest");
    table.finish("idle");
  } catch (ScriptError& error) {
    fail_in(lua, effect.idle, "", &error);
  }
  lua_pop(lua, 1);
  if (limit.kind != Value::Kind::number || !std::isfinite(static_cast<float>(limit.number)))
    fail_in(lua, effect.idle, fmt::format("{}: brightest = {} is not a finite number", what, limit.shown()));
  return limit.number;
}

ImageRef run_build(lua_State* lua, const EntryRun& run, GraphBuilder& graph, const ImageRef& source) {
  const Effect& effect = effect_of(lua, run);
  const Blaming blaming(lua, run.entry);
  lua_rawgeti(lua, LUA_REGISTRYINDEX, effect.build.ref);
  push_graph(lua, graph);
  lua_rawgeti(lua, LUA_REGISTRYINDEX, run.settings_ref);
  push_image(lua, source);
  call(lua, 3, 1);
  const ImageRef* result = to_image(lua, -1);
  if (!result)
    fail_in(
        lua, effect.build,
        fmt::format("build of effect '{}' returned {}, not an image", effect.schema.name, read_value(lua, -1).shown()));
  if (result->build != graph.build())
    fail_in(lua, effect.build,
            fmt::format("build of effect '{}' returned an image of another run", effect.schema.name));
  const ImageRef image = *result;
  lua_pop(lua, 1);
  if (image.size != source.size)
    fail_in(lua, effect.build,
            fmt::format("build of effect '{}' returned an image of {}×{} for a picture of {}×{}", effect.schema.name,
                        image.size.width, image.size.height, source.size.width, source.size.height));
  if (graph.skip_reason() && image.id != source.id)
    fail_in(lua, effect.build,
            fmt::format("build of effect '{}' called g:skip, but did not return its source", effect.schema.name));
  return image;
}

}  // namespace afterglow::script
