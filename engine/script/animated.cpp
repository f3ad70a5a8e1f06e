// SPDX-License-Identifier: MIT
#include "script/animated.h"

#include <fmt/format.h>

#include <cmath>

#include "core/text.h"
#include "script/native.h"
#include "script/object.h"
#include "script/read_only.h"
#include "script/runtime.h"
#include "script/setting.h"
#include "script/table_reader.h"

namespace afterglow::script {
namespace {

constexpr std::size_t kMaxCurves = 4096;                // of one state
constexpr std::size_t kMaxKeysOfSettings = 256 * 1024;  // of the curves that settings have
constexpr std::size_t kMaxCurveKeys = 64 * 1024;        // of all its curves: they live outside of Lua's memory

// ---- fx.curve

std::optional<DeclaredCurve::Key> read_key(lua_State* lua, TableReader& table, const TableReader::Key& place) {
  table.push(place);
  DeclaredCurve::Key key;
  bool whole = lua_istable(lua, -1) && lua_rawlen(lua, -1) == 2;
  if (whole) {
    whole = lua_rawgeti(lua, -1, 1) == LUA_TNUMBER && std::isfinite(lua_tonumber(lua, -1));
    key.at = lua_tonumber(lua, -1);
    lua_rawgeti(lua, -2, 2);
    key.value = read_value(lua, -1);
    lua_pop(lua, 2);
  }
  const std::string shown = read_value(lua, -1).shown();
  lua_pop(lua, 1);
  if (whole) return key;
  table.fail(failure(fmt::format("fx.curve: key {} is {}", place.position, shown), {place.name},
                     "{ FRAME, VALUE }, with unit = \"seconds\" { TIME, VALUE }"));
  return {};
}

template <class T>
T read_word(TableReader& table, const char* key, const std::vector<std::pair<std::string, T>>& words) {
  const auto given = table.text(key, 60);
  if (!given) return words.front().second;
  std::vector<std::string> names;
  for (const auto& [name, value] : words) {
    if (name == *given) return value;
    names.push_back(name);
  }
  table.fail(failure(fmt::format("fx.curve: unknown {} '{}'", key, tidy_message(*given)), {key}, join(names),
                     nearest_name(*given, names)));
  return words.front().second;
}

// ---- functions of time

int unknown_moment(lua_State* lua) {
  const std::vector<std::string> names{"fps", "frame", "time"};
  const Value key = read_value(lua, 2);
  throw failure(fmt::format("t has no {}", key.shown()), {}, join(names), nearest_name(key.text, names));
}

void push_moment(lua_State* lua, const BuildContext& context) {
  lua_createtable(lua, 0, 3);
  push_frame(lua, context.frame);
  lua_setfield(lua, -2, "frame");
  const std::pair<const char*, double> fields[] = {{"time", context.time}, {"fps", context.fps}};
  for (const auto& [name, value] : fields) {
    lua_pushnumber(lua, value);
    lua_setfield(lua, -2, name);
  }
  lua_createtable(lua, 0, 1);
  lua_pushcfunction(lua, (&native<unknown_moment, "">));
  lua_setfield(lua, -2, "__index");
  lua_setmetatable(lua, -2);
  make_read_only(lua);
}

SettingValue call_function(lua_State* lua, const Animated& given, const std::string& full_name,
                           const SettingSchema& schema, const BuildContext& context) {
  lua_rawgeti(lua, LUA_REGISTRYINDEX, given.function.ref);
  push_moment(lua, context);
  call(lua, 1, 1);
  const Value value = read_value(lua, -1);
  lua_pop(lua, 1);
  auto checked = check_setting(fmt::format("{} at frame {}", full_name, number_text(context.frame)), schema, value);
  if (checked) return std::move(*checked);
  ScriptError error{checked.error(), {}, {}};
  locate_function(lua, given.function, error.error);
  throw error;
}

}  // namespace

void push_frame(lua_State* lua, double frame) {
  constexpr double kMost = 2147483648;
  if (frame == std::floor(frame) && std::abs(frame) <= kMost)
    lua_pushinteger(lua, static_cast<lua_Integer>(frame));
  else
    lua_pushnumber(lua, frame);
}

int declare_curve(lua_State* lua) {
  Runtime& runtime = Runtime::of(lua);
  if (!runtime.declaring) throw failure("fx.curve can only be used while a script loads");
  if (runtime.curves.size() >= kMaxCurves) throw failure(fmt::format("more than {} curves", kMaxCurves));
  TableReader table(lua, 1, "fx.curve");
  table.allow({"ease", "unit"}, true);
  DeclaredCurve curve;
  curve.ease =
      read_word<Ease>(table, "ease", {{"linear", Ease::linear}, {"smooth", Ease::smooth}, {"step", Ease::step}});
  curve.in_seconds = read_word<bool>(table, "unit", {{"frames", false}, {"seconds", true}});
  for (const auto& place : table.keys()) {
    if (place.position == 0) continue;
    auto key = read_key(lua, table, place);
    if (!key) continue;
    if (!curve.keys.empty() && key->at <= curve.keys.back().at)
      table.fail(failure(fmt::format("fx.curve: key {} is at {}, not after the one before it at {}", place.position,
                                     number_text(key->at), number_text(curve.keys.back().at)),
                         {place.name}));
    curve.keys.push_back(std::move(*key));
  }
  if (curve.keys.empty() && !table.failed()) table.fail(failure("fx.curve has no keys", {}, "{ FRAME, VALUE }, …"));
  table.finish("curve");
  runtime.curve_keys += curve.keys.size();
  if (runtime.curve_keys > kMaxCurveKeys) throw failure(fmt::format("more than {} keys of curves", kMaxCurveKeys));
  runtime.curves.push_back(std::move(curve));
  push_object(lua, kCurveKind, Handle{static_cast<int>(runtime.curves.size()) - 1});
  return 1;
}

Given read_given(lua_State* lua, int index) {
  Given given;
  given.value = read_value(lua, index);
  if (const Handle* handle = to_object<Handle>(lua, index, kCurveKind)) given.curve = handle->index;
  if (lua_isfunction(lua, index) && !lua_iscfunction(lua, index)) {
    lua_pushvalue(lua, index);
    given.function.ref = luaL_ref(lua, LUA_REGISTRYINDEX);
  }
  return given;
}

Result<Animated> check_animated(lua_State* lua, const std::string& full_name, const SettingSchema& schema,
                                const Given& given) {
  Animated animated;
  if (given.function.set()) {
    animated.function = given.function;
    return animated;
  }
  if (given.curve < 0) {
    AFTERGLOW_TRY(animated.fixed, check_setting(full_name, schema, given.value));
    return animated;
  }
  if (schema.type == SettingType::boolean || schema.type == SettingType::enumeration ||
      schema.type == SettingType::file || schema.type == SettingType::text)
    return Error{ErrorKind::script, fmt::format("{} cannot be a curve: it has nothing between its values", full_name),
                 "", 0, allowed_text(schema) + ", a function of t"};
  const DeclaredCurve& declared = Runtime::of(lua).curves[static_cast<std::size_t>(given.curve)];
  Runtime& runtime = Runtime::of(lua);
  runtime.keys_of_settings += declared.keys.size();
  if (runtime.keys_of_settings > kMaxKeysOfSettings)
    return Error{ErrorKind::script,
                 fmt::format("{}: the curves of all settings have more than {} keys", full_name, kMaxKeysOfSettings)};
  Curve& curve = animated.curve.emplace();
  curve.ease = declared.ease;
  curve.in_seconds = declared.in_seconds;
  for (const auto& key : declared.keys) {
    const std::string name = fmt::format("{}: key {} of the curve", full_name, curve.keys.size() + 1);
    AFTERGLOW_TRY(SettingValue value, check_setting(name, schema, key.value));
    curve.keys.push_back({key.at, std::move(value)});
  }
  return animated;
}

namespace {

SettingValue value_of_function(lua_State* lua, const Animated& given, const std::string& full_name,
                               const SettingSchema& schema, const BuildContext& context) {
  SettingValue value = call_function(lua, given, full_name, schema, context);
  const SettingValue again = call_function(lua, given, full_name, schema, context);
  if (value == again) return value;
  ScriptError error = failure(fmt::format("{} is {} and then {} at the same frame; its function must depend on t alone",
                                          full_name, value.text(), again.text()));
  locate_function(lua, given.function, error.error);
  throw error;
}

struct Asked {
  const Animated& given;
  const std::string& full_name;
  const SettingSchema& schema;
  const BuildContext& context;
  SettingValue value;
};

int ask_function(lua_State* lua) {
  Asked& asked = *static_cast<Asked*>(lua_touserdata(lua, 1));
  asked.value = value_of_function(lua, asked.given, asked.full_name, asked.schema, asked.context);
  return 0;
}

}  // namespace

SettingValue evaluate(lua_State* lua, const Animated& given, const std::string& full_name, const SettingSchema& schema,
                      const BuildContext& context) {
  if (given.curve) return given.curve->value(given.curve->in_seconds ? context.time : context.frame);
  if (!given.function.set()) return given.fixed;
  const Runtime& runtime = Runtime::of(lua);
  if (!runtime.provisional) return value_of_function(lua, given, full_name, schema, context);
  Asked asked{given, full_name, schema, context, schema.default_value};
  lua_pushcfunction(lua, (&native<ask_function, "">));
  lua_pushlightuserdata(lua, &asked);
  if (lua_pcall(lua, 1, 0, 0) == LUA_OK) return asked.value;
  lua_pop(lua, 1);
  runtime.box->charge(0);  // what was spent stays so
  return schema.default_value;
}

}  // namespace afterglow::script
