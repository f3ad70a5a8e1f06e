#include "script/stack.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "script/injection.h"
#include "script/object.h"
#include "script/runtime.h"
#include "script/setting.h"
#include "script/table_reader.h"

namespace afterglow::script {
namespace {

constexpr std::size_t kMaxEntries = 1024;  // of one state

const char kEffects = 0;  // registry key of the functions made for effects, by name

bool is_entry_name(const std::string& name) {
  if (name.empty() || name.size() > 64) return false;
  return std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
}

// Keys that every entry has.
void read_entry_keys(TableReader& table, const EffectSchema& schema, DeclaredEntry& declared) {
  StackEntry& entry = declared.entry;
  entry.at = table.text("at").value_or(schema.at);
  if (std::find(injection_points().begin(), injection_points().end(), entry.at) == injection_points().end())
    table.fail(failure(fmt::format("unknown injection point '{}'", tidy_message(entry.at, 60)), {"at"},
                       join(injection_points()), nearest_name(entry.at, injection_points())));
  entry.order = table.integer("order").value_or(schema.order);
  entry.enabled = table.boolean("enabled").value_or(true);
  entry.required = table.boolean("required").value_or(false);
  declared.name = table.text("name");
  if (declared.name && !is_entry_name(*declared.name))
    table.fail(failure(fmt::format("'{}' cannot be the name of an entry", tidy_message(*declared.name, 60)), {"name"},
                       "1 to 64 letters, digits, '_' and '-'"));
}

void read_settings(lua_State* lua, TableReader& table, const EffectSchema& schema, StackEntry& entry) {
  for (const auto& setting : schema.settings) entry.settings.emplace_back(setting.name, setting.default_value);
  for (const auto& key : table.keys()) {
    if (std::find(entry_keys().begin(), entry_keys().end(), key.name) != entry_keys().end()) continue;
    const auto found =
        std::find_if(schema.settings.begin(), schema.settings.end(), [&](const auto& s) { return s.name == key.name; });
    if (found == schema.settings.end()) {
      std::vector<std::string> names;
      for (const auto& setting : schema.settings) names.push_back(setting.name);
      if (key.position > 0) {
        table.fail(
            failure(fmt::format("effect '{}' has a value without a name at position {}", schema.name, key.position),
                    {key.name}, join(names)));
      } else {
        std::vector<std::string> near = names;
        near.insert(near.end(), entry_keys().begin(), entry_keys().end());
        table.fail(failure(fmt::format("effect '{}' has no setting '{}'", schema.name, tidy_message(key.name, 60)),
                           {key.name}, join(names), nearest_name(key.name, near)));
      }
      continue;
    }
    table.push(key);
    auto checked = check_setting(schema.name + "." + key.name, *found, read_value(lua, -1));
    lua_pop(lua, 1);
    if (checked)
      entry.settings[static_cast<std::size_t>(found - schema.settings.begin())].second = *checked;
    else
      table.fail({checked.error(), {key.name}, {}});
  }
  for (const auto& setting : schema.settings)
    if (std::any_of(table.keys().begin(), table.keys().end(),
                    [&](const auto& key) { return key.name == setting.name; }))
      entry.changed.push_back(setting.name);
}

// fx.NAME{…}; upvalue: index of the effect.
int make_entry(lua_State* lua) {
  Runtime& runtime = Runtime::of(lua);
  const int index = static_cast<int>(lua_tointeger(lua, lua_upvalueindex(1)));
  const EffectSchema& schema = runtime.effects[static_cast<std::size_t>(index)].schema;
  try {
    if (!runtime.declaring) throw failure(fmt::format("fx.{} can only be used while a script loads", schema.name));
    if (runtime.entries.size() >= kMaxEntries)
      throw failure(fmt::format("more than {} effects in one preset", kMaxEntries));
    TableReader table(lua, 1, "fx." + schema.name);
    DeclaredEntry declared;
    declared.effect = index;
    declared.entry.effect = schema.name;
    read_entry_keys(table, schema, declared);
    read_settings(lua, table, schema, declared.entry);
    table.finish(schema.name.c_str());
    Error place;
    runtime.box->locate(place, runtime.box->caller(lua));
    declared.entry.file = place.file;
    declared.entry.line = place.line;
    runtime.entries.push_back(std::move(declared));
  } catch (ScriptError& error) {
    error.function = schema.name;
    throw;
  }
  push_object(lua, kEntryKind, Handle{static_cast<int>(runtime.entries.size()) - 1});
  return 1;
}

DeclaredStack read_stack(lua_State* lua, TableReader& table) {
  const Runtime& runtime = Runtime::of(lua);
  DeclaredStack stack;
  stack.name = tidy_message(table.text("name").value_or(""), 100);
  stack.max_error = table.number("max_error");
  if (stack.max_error && *stack.max_error <= 0)
    table.fail(failure(fmt::format("fx.stack: max_error = {} is out of range", number_text(*stack.max_error)),
                       {"max_error"}, "> 0"));
  for (const auto& key : table.keys()) {
    if (key.position == 0) continue;
    table.push(key);
    if (const Handle* handle = to_object<Handle>(lua, -1, kEntryKind))
      stack.entries.push_back(runtime.entries[static_cast<std::size_t>(handle->index)]);
    else if (lua_iscfunction(lua, -1))
      table.fail(failure(fmt::format("fx.stack: position {} is an effect without settings", key.position), {key.name},
                         "fx.NAME { … }"));
    else
      table.fail(
          failure(fmt::format("fx.stack: position {} is {}, not an effect", key.position, read_value(lua, -1).shown()),
                  {key.name}, "fx.NAME { … }"));
    lua_pop(lua, 1);
  }
  return stack;
}

// Gives every entry a name that no other has; "#2" counts effects of one kind that the preset did not name.
void name_entries(TableReader& table, DeclaredStack& stack) {
  std::set<std::string> taken;
  for (const auto& declared : stack.entries)
    if (declared.name && !taken.insert(*declared.name).second) {
      ScriptError error = failure(fmt::format("fx.stack: two entries are named '{}'", *declared.name));
      error.error.file = declared.entry.file;
      error.error.line = declared.entry.line;
      table.fail(std::move(error));
    }
  for (auto& declared : stack.entries) {
    std::string name = declared.name.value_or(declared.entry.effect);
    if (!declared.name)
      for (int n = 2; !taken.insert(name).second; ++n) name = fmt::format("{}#{}", declared.entry.effect, n);
    declared.entry.name = std::move(name);
  }
}

}  // namespace

int declare_stack(lua_State* lua) {
  Runtime& runtime = Runtime::of(lua);
  if (!runtime.declaring) throw failure("fx.stack can only be used while a script loads");
  if (runtime.stacks.size() >= kMaxEntries) throw failure("too many stacks");
  TableReader table(lua, 1, "fx.stack");
  table.allow({"max_error", "name"}, true);
  DeclaredStack stack = read_stack(lua, table);
  name_entries(table, stack);
  table.finish("stack");
  runtime.stacks.push_back(std::move(stack));
  push_object(lua, kStackKind, Handle{static_cast<int>(runtime.stacks.size()) - 1});
  return 1;
}

int library_index(lua_State* lua) {
  // __index of the library's own table: called only for names that the library lacks.
  if (lua_type(lua, 2) != LUA_TSTRING) throw failure("fx: the name of an effect must be a text");
  const std::string name = lua_tostring(lua, 2);
  lua_settop(lua, 0);
  if (lua_rawgetp(lua, LUA_REGISTRYINDEX, &kEffects) != LUA_TTABLE) {
    lua_createtable(lua, 0, 8);
    lua_pushvalue(lua, -1);
    lua_rawsetp(lua, LUA_REGISTRYINDEX, &kEffects);
    lua_replace(lua, 1);
  }
  if (lua_getfield(lua, 1, name.c_str()) != LUA_TNIL) return 1;
  lua_pushinteger(lua, find_effect(lua, name));
  lua_pushcclosure(lua, (&native<make_entry, "effect">), 1);
  lua_pushvalue(lua, -1);
  lua_setfield(lua, 1, name.c_str());
  return 1;
}

}  // namespace afterglow::script
