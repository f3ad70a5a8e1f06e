// SPDX-License-Identifier: MIT
#include "script/invariant_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/text.h"
#include "script/entry_run.h"
#include "script/table_reader.h"

namespace afterglow::script {
namespace {

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const auto& kind : invariant_kinds()) names.push_back(kind.name);
  return names;
}

const InvariantKind* find_kind(const std::string& name) {
  const auto& kinds = invariant_kinds();
  const auto found = std::ranges::find(kinds, name, &InvariantKind::name);
  return found == kinds.end() ? nullptr : &*found;
}

std::vector<std::string> parameters_of(const InvariantKind& kind) {
  std::vector<std::string> names{"when"};
  for (const auto& [name, value] : kind.numbers) names.push_back(name);
  names.insert(names.end(), kind.setting_names.begin(), kind.setting_names.end());
  return names;
}

/// Collects one promise from the values that the script gives it.
class InvariantReader {
 public:
  InvariantReader(lua_State* lua, TableReader& table, const EffectSchema& schema, const InvariantKind& kind)
      : lua_(lua), table_(table), schema_(schema), kind_(kind) {
    hold_.schema.stated.name = kind.name;
    for (const auto& [name, value] : kind.numbers) hold_.schema.stated.numbers[name] = value;
  }

  /// The value on top of the stack (popped) for a parameter; `place` is its key in `holds`.
  void take(const std::string& name, const KeyPath& place) {
    const bool is_setting = std::ranges::find(kind_.setting_names, name) != kind_.setting_names.end();
    if (!is_setting && lua_isfunction(lua_, -1)) {
      const FunctionRef function{luaL_ref(lua_, LUA_REGISTRYINDEX)};
      if (name == "when") {
        hold_.when = function;
        hold_.schema.conditional = true;
      } else {
        hold_.computed[name] = function;
        hold_.schema.computed.push_back(name);
        hold_.schema.stated.numbers.erase(name);
      }
      return;
    }
    const Value given = read_value(lua_, -1);
    lua_pop(lua_, 1);
    if (is_setting) return take_setting(name, given, place);
    if (name != "when" && given.kind == Value::Kind::number && std::isfinite(given.number)) {
      hold_.schema.stated.numbers[name] = given.number;
      return;
    }
    if (name != "when" && name != kind_.main && given.kind == Value::Kind::boolean && given.number == 0) {
      hold_.schema.stated.numbers[name] = std::numeric_limits<double>::infinity();  // no bound
      return;
    }
    const char* wanted = name == "when"       ? "a function"
                         : name == kind_.main ? "a number, function(s, source)"
                                              : "a number, false, function(s, source)";
    table_.fail(
        failure(fmt::format("{}: holds: {}: {} = {}", table_.what(), kind_.name, name, given.shown()), place, wanted));
  }

  void finish(Effect& effect, const KeyPath& place) {
    for (const auto& [name, value] : hold_.schema.stated.numbers)
      if (std::isnan(value) && name != "from" && name != "to")
        table_.fail(failure(fmt::format("{}: holds: {} needs {}", table_.what(), kind_.name, name), place));
    for (const auto& name : kind_.setting_names)
      if (name == kind_.main && !hold_.schema.stated.settings.contains(name))
        table_.fail(failure(fmt::format("{}: holds: {} needs {}", table_.what(), kind_.name, name), place));
    effect.schema.invariants.push_back(hold_.schema);
    effect.invariants.push_back(std::move(hold_));
  }

 private:
  void take_setting(const std::string& name, const Value& given, const KeyPath& place) {
    std::vector<std::string> numbers;
    for (const auto& setting : schema_.settings)
      if (setting.type == SettingType::number || setting.type == SettingType::integer) numbers.push_back(setting.name);
    if (given.kind == Value::Kind::text && std::ranges::find(numbers, given.text) != numbers.end()) {
      hold_.schema.stated.settings[name] = given.text;
      return;
    }
    table_.fail(failure(fmt::format("{}: holds: {}: {} = {} is no setting that is a number", table_.what(), kind_.name,
                                    name, given.shown()),
                        place, join(numbers), nearest_name(given.text, numbers)));
  }

  lua_State* lua_;
  TableReader& table_;
  const EffectSchema& schema_;
  const InvariantKind& kind_;
  DeclaredInvariant hold_;
};

void fail_unknown(TableReader& table, const std::string& shown, const std::string& name, const KeyPath& place) {
  const auto names = kind_names();
  table.fail(failure(fmt::format("{}: holds: unknown promise {}", table.what(), shown), place, join(names),
                     nearest_name(name, names)));
}

/// `mean = 1e-3`, `mean = { within = 1e-3, when = … }`; the value is on top of the stack (popped).
void read_named(lua_State* lua, TableReader& table, Effect& effect, const std::string& name) {
  const KeyPath place{"holds", name};
  const InvariantKind* kind = find_kind(name);
  if (!kind) {
    lua_pop(lua, 1);
    return fail_unknown(table, "'" + tidy_message(name, 60) + "'", name, place);
  }
  InvariantReader reader(lua, table, effect.schema, *kind);
  if (!lua_istable(lua, -1)) {
    reader.take(kind->main, place);
  } else {
    TableReader parameters(lua, -1, fmt::format("{}: holds: {}", table.what(), name), table, place);
    const auto known = parameters_of(*kind);
    for (const auto& key : parameters.keys()) {
      if (key.position > 0 || std::ranges::find(known, key.name) == known.end()) {
        parameters.fail(
            failure(fmt::format("{}: holds: {} has no '{}'", table.what(), name, tidy_message(key.name, 60)),
                    {key.name}, join(known), nearest_name(key.name, known)));
        continue;
      }
      parameters.push(key);
      KeyPath inside = place;
      inside.push_back(key.name);
      reader.take(key.name, inside);
    }
    lua_pop(lua, 1);
  }
  reader.finish(effect, place);
}

/// Calls a function of a promise with the entry's settings and the picture's size; leaves its result on the stack.
void call_promise(lua_State* lua, const FunctionRef& function, const EntryRun& run, Size size) {
  lua_rawgeti(lua, LUA_REGISTRYINDEX, function.ref);
  lua_rawgeti(lua, LUA_REGISTRYINDEX, run.settings_ref);
  lua_createtable(lua, 0, 2);
  lua_pushinteger(lua, size.width);
  lua_setfield(lua, -2, "width");
  lua_pushinteger(lua, size.height);
  lua_setfield(lua, -2, "height");
  call(lua, 2, 1);
}

[[noreturn]] void fail_result(lua_State* lua, const FunctionRef& function, const EntryRun& run, const std::string& what,
                              const Value& given, const char* wanted) {
  ScriptError error = failure(
      fmt::format("{} of holds of effect '{}' returned {}, not {}", what, run.entry.effect, given.shown(), wanted));
  locate_function(lua, function, error.error);
  throw error;
}

Value result_of(lua_State* lua, const FunctionRef& function, const EntryRun& run, Size size) {
  call_promise(lua, function, run, size);
  Value given = read_value(lua, -1);
  lua_pop(lua, 1);
  return given;
}

}  // namespace

void read_invariants(lua_State* lua, TableReader& table, Effect& effect) {
  table.push("holds");
  if (lua_isnil(lua, -1)) return lua_pop(lua, 1);
  const TableReader list(lua, -1, "holds", table, {"holds"});
  for (const auto& key : list.keys()) {
    list.push(key);
    if (key.position == 0) {
      read_named(lua, table, effect, key.name);
      continue;
    }
    const Value given = read_value(lua, -1);
    lua_pop(lua, 1);
    const InvariantKind* kind = given.kind == Value::Kind::text ? find_kind(given.text) : nullptr;
    if (!kind)
      fail_unknown(table, given.shown(), given.text, {"holds", key.name});
    else
      InvariantReader(lua, table, effect.schema, *kind).finish(effect, {"holds", key.name});
  }
  lua_pop(lua, 1);
}

std::vector<Invariant> invariants_of(lua_State* lua, const EntryRun& run, Size size) {
  std::vector<Invariant> out;
  for (const DeclaredInvariant& hold : Runtime::of(lua).effects[static_cast<std::size_t>(run.effect)].invariants) {
    Invariant one = hold.schema.stated;
    if (hold.when.set()) {
      const Value given = result_of(lua, hold.when, run, size);
      if (given.kind != Value::Kind::boolean && given.kind != Value::Kind::nothing)
        fail_result(lua, hold.when, run, "when", given, "true or false");
      if (given.kind == Value::Kind::nothing || given.number == 0) continue;
    }
    for (const auto& [name, function] : hold.computed) {
      const Value given = result_of(lua, function, run, size);
      if (given.kind != Value::Kind::number || !std::isfinite(given.number))
        fail_result(lua, function, run, name, given, "a finite number");
      one.numbers[name] = given.number;
    }
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace afterglow::script
