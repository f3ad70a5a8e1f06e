// SPDX-License-Identifier: MIT
#include "script/table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "script/read_only.h"

namespace afterglow::script {
namespace {

constexpr std::size_t kMaxKeys = 4096;  // in one table

/// fx:stack { … } hands the library, or fx.mask, over as the table.
bool is_called_with_colon(lua_State* lua, int index) {
  push_real(lua, index);
  const bool view = !lua_rawequal(lua, -1, index);
  lua_pushliteral(lua, "stack");
  const bool library = view && lua_rawget(lua, -2) == LUA_TFUNCTION;
  lua_pop(lua, 2);
  return library || (view && lua_istable(lua, index + 1));
}

/// The table is the call's last argument.
void check_arguments(lua_State* lua, int index, const std::string& what) {
  const std::string call = what.substr(what.find_last_of(' ') + 1);
  if (is_called_with_colon(lua, index))
    throw failure(fmt::format("{} is called with a colon", call), {}, call + " { … }, with a point");
  if (lua_gettop(lua) > index)
    throw failure(fmt::format("{} takes one table; behind it stands {}", what, read_value(lua, index + 1).shown()), {},
                  call + " { … }");
}

}  // namespace

TableReader::TableReader(lua_State* lua, int index, std::string what)
    : lua_(lua), index_(lua_absindex(lua, index)), what_(std::move(what)) {
  luaL_checkstack(lua, 10, nullptr);
  if (!lua_istable(lua, index_))
    throw failure(fmt::format("{} takes a table, not {}", what_, read_value(lua, index_).shown()), {},
                  what_.substr(what_.find_last_of(' ') + 1) + " { … }");
  if (index > 0) check_arguments(lua, index, what_);
  read_keys();
}

TableReader::TableReader(lua_State* lua, int index, std::string what, TableReader& parent, KeyPath place)
    : lua_(lua), index_(lua_absindex(lua, index)), what_(std::move(what)), parent_(&parent), place_(std::move(place)) {
  luaL_checkstack(lua, 10, nullptr);
  if (lua_istable(lua, index_)) {
    read_keys();
    return;
  }
  fail(failure(fmt::format("{}: {} = {} is not a table", parent.what(), what_, read_value(lua, index_).shown())));
  index_ = 0;
}

void TableReader::fail(ScriptError error) {
  if (parent_) {
    error.key.insert(error.key.begin(), place_.begin(), place_.end());
    parent_->fail(std::move(error));
  } else if (failures_.size() < kMaxFailures) {
    failures_.push_back(std::move(error));
  }
}

void TableReader::read_keys() {
  lua_State* const lua = lua_;
  lua_pushnil(lua);
  while (lua_next(lua, index_)) {
    lua_pop(lua, 1);
    if (keys_.size() == kMaxKeys) throw failure(fmt::format("{} has more than {} keys", what_, kMaxKeys));
    if (lua_type(lua, -1) == LUA_TSTRING) {
      std::size_t size = 0;
      const char* name = lua_tolstring(lua, -1, &size);
      keys_.push_back({std::string(name, size), 0});
    } else if (lua_isinteger(lua, -1) && lua_tointeger(lua, -1) >= 1) {
      keys_.push_back({fmt::format("#{}", lua_tointeger(lua, -1)), lua_tointeger(lua, -1)});
    } else {
      fail(failure(fmt::format("{} has a key that is {}", what_, read_value(lua, -1).shown())));
    }
  }
  std::sort(keys_.begin(), keys_.end(), [](const Key& a, const Key& b) {
    if ((a.position == 0) != (b.position == 0)) return a.position != 0;
    return a.position != b.position ? a.position < b.position : a.name < b.name;
  });
}

void TableReader::push(const Key& key) const {
  if (key.position > 0) {
    lua_rawgeti(lua_, index_, key.position);
  } else {
    lua_pushlstring(lua_, key.name.data(), key.name.size());
    lua_rawget(lua_, index_);
  }
}

void TableReader::push(const char* name) const {
  if (index_ == 0) return lua_pushnil(lua_);
  lua_pushstring(lua_, name);
  lua_rawget(lua_, index_);
}

Value TableReader::value(const char* name) const {
  push(name);
  Value value = read_value(lua_, -1);
  lua_pop(lua_, 1);
  return value;
}

std::optional<std::string> TableReader::text(const char* name, std::size_t limit) {
  Value given = value(name);
  if (given.kind == Value::Kind::nothing) return {};
  if (given.kind != Value::Kind::text) {
    fail(failure(fmt::format("{}: {} = {} is not a text", what_, name, given.shown()), {name}));
    return {};
  }
  if (given.text.size() <= limit) return std::move(given.text);
  fail(failure(fmt::format("{}: {} is too long", what_, name), {name},
               fmt::format("a text of at most {} bytes", limit)));
  return {};
}

std::optional<double> TableReader::number(const char* name) {
  const Value given = value(name);
  if (given.kind == Value::Kind::nothing) return {};
  if (given.kind == Value::Kind::number && std::isfinite(given.number)) return given.number;
  fail(failure(fmt::format("{}: {} = {} is not a finite number", what_, name, given.shown()), {name}));
  return {};
}

std::optional<int> TableReader::integer(const char* name) {
  constexpr int kLimit = 1'000'000;
  const Value given = value(name);
  if (given.kind == Value::Kind::nothing) return {};
  if (given.kind == Value::Kind::number && std::abs(given.number) <= kLimit && given.number == std::floor(given.number))
    return static_cast<int>(given.number);
  fail(failure(fmt::format("{}: {} = {} is not an integer", what_, name, given.shown()), {name},
               "integer −1000000…1000000"));
  return {};
}

std::optional<bool> TableReader::boolean(const char* name) {
  const Value given = value(name);
  if (given.kind == Value::Kind::nothing) return {};
  if (given.kind == Value::Kind::boolean) return given.number != 0;
  fail(failure(fmt::format("{}: {} = {} is not a boolean", what_, name, given.shown()), {name}, "true, false"));
  return {};
}

void TableReader::allow(const std::vector<std::string>& known, bool positions) {
  for (const Key& key : keys_) {
    if (failures_.size() == kMaxFailures) return;  // what follows would not be kept
    if (key.position > 0 ? positions : std::find(known.begin(), known.end(), key.name) != known.end()) continue;
    if (key.position > 0)
      fail(failure(fmt::format("{} has a value without a name at position {}", what_, key.position), {key.name},
                   join(known)));
    else
      fail(failure(fmt::format("{} has no '{}'", what_, tidy_message(key.name, 60)), {key.name}, join(known),
                   nearest_name(key.name, known)));
  }
}

void TableReader::finish(const char* function) {
  if (failures_.empty()) return;
  for (auto& error : failures_) locate_failure(lua_, error, function);
  throw *std::min_element(failures_.begin(), failures_.end(),
                          [](const ScriptError& a, const ScriptError& b) { return a.error.line < b.error.line; });
}

}  // namespace afterglow::script
