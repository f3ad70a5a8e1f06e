// SPDX-License-Identifier: MIT
#include "script/numbers.h"

#include <algorithm>

#include "script/read_only.h"
#include "script/value.h"

namespace afterglow::script {
namespace {

/// Adds the row on top of the stack. False: it is none, or another than those before.
bool add_row(lua_State* lua, Numbers& out) {
  const Value value = read_value(lua, -1);
  const bool plain = value.kind == Value::Kind::number;
  if (!plain && value.kind != Value::Kind::list) return false;
  const auto columns = plain ? std::size_t{0} : static_cast<std::size_t>(value.count);
  if (out.rows > 0 && columns != out.columns) return false;
  out.columns = columns;
  ++out.rows;
  if (plain)
    out.values.push_back(value.number);
  else
    out.values.insert(out.values.end(), value.list.begin(), value.list.begin() + value.count);
  return true;
}

}  // namespace

Numbers read_numbers(lua_State* lua, int index, std::size_t most) {
  if (lua_type(lua, index) != LUA_TTABLE) return {};
  Numbers out;
  push_real(lua, index);
  const std::size_t rows = std::min<std::size_t>(lua_rawlen(lua, -1), most + 1);
  bool good = true;
  for (std::size_t row = 1; good && row <= rows; ++row) {
    lua_rawgeti(lua, -1, static_cast<lua_Integer>(row));
    good = add_row(lua, out);
    lua_pop(lua, 1);
  }
  lua_pop(lua, 1);
  return good ? out : Numbers{};
}

}  // namespace afterglow::script
