// SPDX-License-Identifier: MIT
#include "script/numbers.h"

#include <fmt/format.h>

#include <algorithm>

#include "script/read_only.h"
#include "script/value.h"

namespace afterglow::script {
namespace {

std::string row_text(std::size_t columns) { return columns == 0 ? "a number" : fmt::format("a table of {}", columns); }

/// Adds the row on top of the stack. False: it is none, or another than those before.
bool add_row(lua_State* lua, Numbers& out) {
  const Value value = read_value(lua, -1);
  const bool plain = value.kind == Value::Kind::number;
  if (!plain && value.kind != Value::Kind::list) {
    out.fault = fmt::format("has {} at {}", value.shown(), out.rows + 1);
    return false;
  }
  const auto columns = plain ? std::size_t{0} : static_cast<std::size_t>(value.count);
  if (out.rows > 0 && columns != out.columns) {
    out.fault = fmt::format("has {} at {}, and {} before", row_text(columns), out.rows + 1, row_text(out.columns));
    return false;
  }
  out.columns = columns;
  ++out.rows;
  if (plain)
    out.values.push_back(value.number);
  else
    out.values.insert(out.values.end(), value.list.begin(), value.list.begin() + value.count);
  return true;
}

/// The first key of the table on top of the stack that is none of 1 … rows; empty: there is none.
std::string other_key(lua_State* lua, std::size_t rows) {
  std::string other;
  lua_pushnil(lua);
  while (lua_next(lua, -2)) {
    lua_pop(lua, 1);
    const bool place = lua_isinteger(lua, -1) && lua_tointeger(lua, -1) >= 1 &&
                       lua_tointeger(lua, -1) <= static_cast<lua_Integer>(rows);
    if (place) continue;
    other = read_value(lua, -1).shown();
    lua_pop(lua, 1);
    break;
  }
  return other;
}

}  // namespace

Numbers read_numbers(lua_State* lua, int index, std::size_t most) {
  if (lua_type(lua, index) != LUA_TTABLE) return {};
  Numbers out;
  push_real(lua, index);
  const std::size_t all = lua_rawlen(lua, -1), rows = std::min<std::size_t>(all, most + 1);
  const std::string other = other_key(lua, all);
  if (!other.empty()) out.fault = fmt::format("has the key {}; keys are 1, 2, …", other);
  bool good = other.empty();
  for (std::size_t row = 1; good && row <= rows; ++row) {
    lua_rawgeti(lua, -1, static_cast<lua_Integer>(row));
    good = add_row(lua, out);
    lua_pop(lua, 1);
  }
  lua_pop(lua, 1);
  if (!good) out.rows = 0;
  return out;
}

}  // namespace afterglow::script
