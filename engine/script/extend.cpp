// SPDX-License-Identifier: MIT
// fx.extend("NAME", {…}): another preset's stack with some of it changed.
#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "script/entry_reader.h"
#include "script/object.h"
#include "script/stack.h"

namespace afterglow::script {
namespace {

// { SETTING = VALUE, … } for one entry, or for all entries of one effect.
void change_entries(lua_State* lua, TableReader& table, const TableReader::Key& key, DeclaredStack& stack) {
  const auto named = [&](const DeclaredEntry& e) { return e.entry.name == key.name; };
  const bool by_name = std::any_of(stack.entries.begin(), stack.entries.end(), named);
  bool found = false;
  std::vector<std::string> names;
  table.push(key);
  for (auto& declared : stack.entries) {
    names.push_back(declared.entry.name);
    if (by_name ? !named(declared) : declared.entry.effect != key.name) continue;
    found = true;
    TableReader changes(lua, -1, key.name, table, {key.name});
    const std::string name = declared.entry.name;
    read_entry(lua, changes, Runtime::of(lua).effects[static_cast<std::size_t>(declared.effect)].schema, declared);
    if (declared.name != name)
      changes.fail(
          failure(fmt::format("fx.extend: '{}' cannot be named anew: volumes and --set call it so", name), {"name"}));
  }
  lua_pop(lua, 1);
  if (found) return;
  names.insert(names.end(), stack_keys().begin(), stack_keys().end());
  table.fail(failure(fmt::format("fx.extend: the stack has no entry '{}'", tidy_message(key.name, 60)), {key.name},
                     join(names), nearest_name(key.name, names)));
}

}  // namespace

int declare_extend(lua_State* lua) {
  Runtime& runtime = Runtime::of(lua);
  if (!runtime.declaring) throw failure("fx.extend can only be used while a script loads");
  const Value name = read_value(lua, 1);
  if (name.kind != Value::Kind::text)
    throw failure(fmt::format("fx.extend: {} is not the name of a preset", name.shown()), {},
                  "fx.extend(\"NAME\", { ENTRY = { SETTING = VALUE } })");
  lua_settop(lua, 2);
  if (lua_isnil(lua, 2)) {
    lua_createtable(lua, 0, 0);
    lua_replace(lua, 2);
  }
  DeclaredStack stack = load_named_stack(lua, name.text);
  for (auto& declared : stack.entries) declared.name = declared.entry.name;  // what is added gets other names
  TableReader table(lua, 2, "fx.extend");
  for (const auto& key : table.keys())
    if (key.position == 0 && std::find(stack_keys().begin(), stack_keys().end(), key.name) == stack_keys().end())
      change_entries(lua, table, key, stack);
  read_stack(lua, table, stack);
  table.finish("extend");
  push_stack(lua, std::move(stack));
  return 1;
}

}  // namespace afterglow::script
