// SPDX-License-Identifier: MIT
#include "script/stack.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "image/input_space.h"
#include "script/entry_reader.h"
#include "script/items.h"
#include "script/object.h"
#include "script/requirement.h"
#include "script/runtime.h"
#include "script/table_reader.h"

namespace afterglow::script {
namespace {

constexpr std::size_t kMaxEntries = 1024;            // of one state
constexpr std::size_t kMaxStackEntries = 64 * 1024;  // of all its stacks

const char kEffects = 0;  // registry key of the functions made for effects, by name

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
    DeclaredEntry declared = new_entry(runtime, index);
    read_entry(lua, table, schema, declared);
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

void read_position(lua_State* lua, TableReader& table, DeclaredStack& stack) {
  table.push("position");
  const Given given = read_given(lua, -1);
  lua_pop(lua, 1);
  if (given.value.kind == Value::Kind::nothing) return;
  auto checked = check_animated(lua, table.what() + ": position", position_schema(), given);
  if (checked)
    stack.position = std::move(*checked);
  else
    table.fail({checked.error(), {"position"}, {}});
}

// Gives every entry and volume a name that no other has; "#2" counts those of one kind that the preset did not name.
void name_entries(TableReader& table, DeclaredStack& stack) {
  std::set<std::string> taken;
  for (const auto& declared : stack.entries)
    if (declared.name && !taken.insert(*declared.name).second) {
      ScriptError error = failure(fmt::format("{}: two entries are named '{}'", table.what(), *declared.name));
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
  std::set<std::string> volumes;
  for (auto& volume : stack.volumes) {
    const std::string wanted = volume.name.empty() ? "volume" : volume.name;
    volume.name = wanted;
    for (int n = 2; !volumes.insert(volume.name).second; ++n) volume.name = fmt::format("{}#{}", wanted, n);
  }
}

/// One of the words, or another, which is noted as a failure; empty: not said.
std::string read_word(TableReader& table, const char* key, const std::vector<std::string>& words) {
  const auto word = table.text(key);
  if (word && std::ranges::find(words, *word) == words.end())
    table.fail(failure(fmt::format("{}: {} = \"{}\"", table.what(), key, tidy_message(*word, 40)), {key}, join(words),
                       nearest_name(*word, words)));
  return word.value_or("");
}

}  // namespace

void read_stack(lua_State* lua, TableReader& table, DeclaredStack& stack) {
  if (const auto name = table.text("name")) stack.name = tidy_message(*name, 100);
  if (const auto oldest = table.text("requires"); oldest && !parse_version(*oldest))
    table.fail(failure(fmt::format("{}: requires = \"{}\" is no version", table.what(), tidy_message(*oldest, 40)),
                       {"requires"}, "\"0.2\" or \"0.2.1\": the oldest Afterglow that runs the preset"));
  if (const auto max_error = table.number("max_error")) stack.max_error = max_error;
  if (stack.max_error && *stack.max_error <= 0)
    table.fail(failure(fmt::format("{}: max_error = {} is out of range", table.what(), number_text(*stack.max_error)),
                       {"max_error"}, "> 0"));
  if (const auto space = table.text("input_space")) {
    stack.input_space = *space;
    if (const auto found = find_input_space(*space); !found)
      table.fail(failure(fmt::format("{}: input_space: {}", table.what(), found.error().message), {"input_space"},
                         found.error().allowed, found.error().nearest));
  }
  stack.gamut = read_word(table, "gamut", {"cut", "keep"});
  stack.alpha = read_word(table, "alpha", {"straight", "associated"});
  if (const auto height = table.integer("reference_height")) stack.reference_height = height;
  if (stack.reference_height && (*stack.reference_height < 1 || *stack.reference_height > 16384))
    table.fail(failure(fmt::format("{}: reference_height = {} is out of range", table.what(), *stack.reference_height),
                       {"reference_height"}, "1…16384"));
  read_position(lua, table, stack);
  read_items(lua, table, stack.entries, &stack.volumes);
  if (!table.failed()) name_entries(table, stack);
}

void push_stack(lua_State* lua, DeclaredStack stack) {
  Runtime& runtime = Runtime::of(lua);
  if (runtime.stacks.size() >= kMaxEntries) throw failure("too many stacks");
  runtime.stack_entries += stack.entries.size();
  if (runtime.stack_entries > kMaxStackEntries)
    throw failure(fmt::format("more than {} effects in all stacks", kMaxStackEntries));
  for (auto& volume : stack.volumes) aim_volume(lua, volume, stack.entries);
  runtime.stacks.push_back(std::move(stack));
  push_object(lua, kStackKind, Handle{static_cast<int>(runtime.stacks.size()) - 1});
}

const std::vector<std::string>& stack_keys() {
  static const std::vector<std::string> keys{"alpha", "gamut",    "input_space",      "max_error",
                                             "name",  "position", "reference_height", "requires"};
  return keys;
}

int declare_stack(lua_State* lua) {
  if (!Runtime::of(lua).declaring) throw failure("fx.stack can only be used while a script loads");
  TableReader table(lua, 1, "fx.stack");
  table.allow(stack_keys(), true);
  DeclaredStack stack;
  read_stack(lua, table, stack);
  table.finish("stack");
  push_stack(lua, std::move(stack));
  return 1;
}

int library_index(lua_State* lua) {
  // __index of the library's own table: called only for names that the library lacks.
  if (lua_type(lua, 2) != LUA_TSTRING) throw failure("fx: the name of an effect must be a text");
  std::size_t size = 0;
  const char* text = lua_tolstring(lua, 2, &size);
  const std::string name(text, size);  // with any NUL in it, which no effect's name has
  lua_settop(lua, 0);
  if (lua_rawgetp(lua, LUA_REGISTRYINDEX, &kEffects) != LUA_TTABLE) {
    lua_createtable(lua, 0, 8);
    lua_pushvalue(lua, -1);
    lua_rawsetp(lua, LUA_REGISTRYINDEX, &kEffects);
    lua_replace(lua, 1);
  }
  lua_pushlstring(lua, name.data(), name.size());
  if (lua_rawget(lua, 1) != LUA_TNIL) return 1;
  lua_pushinteger(lua, find_effect(lua, name));
  lua_pushcclosure(lua, (&native<make_entry, "effect">), 1);
  lua_pushvalue(lua, -1);
  lua_setfield(lua, 1, name.c_str());
  return 1;
}

}  // namespace afterglow::script
