// SPDX-License-Identifier: MIT
// The tables `string`, `table` and `math` of scripts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "core/saturated.h"
#include "script/absent.h"
#include "script/globals.h"
#include "script/metatables.h"
#include "script/native.h"
#include "script/read_only.h"

namespace afterglow::script {
namespace {

// Copies fields of the library on top of the stack into a new table, which replaces it.
void pick(lua_State* lua, std::initializer_list<const char*> names) {
  lua_createtable(lua, 0, static_cast<int>(names.size()) + 4);
  for (const char* name : names) {
    lua_getfield(lua, -2, name);
    lua_setfield(lua, -2, name);
  }
  lua_remove(lua, -2);
}

void set(lua_State* lua, const char* name, lua_CFunction function) {
  lua_pushcfunction(lua, function);
  lua_setfield(lua, -2, name);
}

/// Lua's own messages about functions that are called by those below name them by this table, on top of the stack:
/// "bad argument #2 to 'string.format'". Scripts do not reach it there.
void name_functions(lua_State* lua, const char* library) {
  luaL_getsubtable(lua, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
  lua_pushvalue(lua, -2);
  lua_setfield(lua, -2, library);
  lua_pop(lua, 1);
}

// ---- string

int string_format(lua_State* lua) {
  std::size_t size = 0;
  const char* format = luaL_checklstring(lua, 1, &size);
  const std::string_view text(format, size);
  for (std::size_t i = 0; i + 1 < size; ++i) {
    if (text[i] != '%') continue;
    do ++i;
    while (i < size && std::string_view("-+ #0123456789.").find(text[i]) != std::string_view::npos);
    if (i < size && text[i] == 'p')
      throw failure("string.format: %p is not allowed (addresses differ from run to run)");
  }
  for (int i = 2; i <= lua_gettop(lua); ++i) {
    const int type = lua_type(lua, i);
    if (type == LUA_TNUMBER || type == LUA_TSTRING || type == LUA_TBOOLEAN || type == LUA_TNIL) continue;
    push_text(lua, i);
    lua_replace(lua, i);
  }
  lua_pushvalue(lua, lua_upvalueindex(1));
  lua_insert(lua, 1);
  call(lua, lua_gettop(lua) - 1, 1);
  return 1;
}

// Nothing, a million times over: Lua's own runs a loop that no limit ends.
int string_rep(lua_State* lua) {
  std::size_t size = 0, separator = 0;
  luaL_checklstring(lua, 1, &size);
  const lua_Integer count = luaL_checkinteger(lua, 2);
  luaL_optlstring(lua, 3, "", &separator);
  if (size + separator == 0) {
    lua_pushliteral(lua, "");
    return 1;
  }
  if (count > 0)
    Sandbox::of(lua).will_hold(lua, saturated_product({static_cast<std::uint64_t>(count), size + separator}));
  lua_pushvalue(lua, lua_upvalueindex(1));
  lua_insert(lua, 1);
  call(lua, lua_gettop(lua) - 1, 1);
  return 1;
}

// Lua's own without patterns.
int string_find(lua_State* lua) {
  std::size_t size = 0, wanted_size = 0;
  const char *text = luaL_checklstring(lua, 1, &size), *wanted = luaL_checklstring(lua, 2, &wanted_size);
  const std::string_view in(text, size), what(wanted, wanted_size);
  if (!lua_toboolean(lua, 4) && what.find_first_of("^$*+?.([%-") != std::string_view::npos)
    throw failure(fmt::format("string.find: '{}' is a pattern, which may run without end", tidy_message(wanted, 60)),
                  {}, "plain text; with true behind it every sign stands for itself: text:find(\"a.b\", 1, true)");
  Sandbox::of(lua).charge(size / 8);
  lua_Integer from = luaL_optinteger(lua, 3, 1);
  if (from < 0) from = std::max<lua_Integer>(static_cast<lua_Integer>(size) + from + 1, 1);
  const std::size_t first = from < 1 ? 0 : static_cast<std::size_t>(from) - 1;
  const std::size_t at = first > size ? std::string_view::npos : in.find(what, first);
  if (at == std::string_view::npos) {
    lua_pushnil(lua);
    return 1;
  }
  lua_pushinteger(lua, static_cast<lua_Integer>(at) + 1);
  lua_pushinteger(lua, static_cast<lua_Integer>(at + what.size()));
  return 2;
}

// ---- table: like Lua's, on the table itself (no metamethods, whose loops could run unseen), and counted

lua_Integer length(lua_State* lua) {
  luaL_checktype(lua, 1, LUA_TTABLE);
  if (is_protected(lua, 1)) throw failure("this table is read-only");
  return static_cast<lua_Integer>(lua_rawlen(lua, 1));
}

int table_insert(lua_State* lua) {
  const lua_Integer size = length(lua);
  const int arguments = lua_gettop(lua);
  if (arguments != 2 && arguments != 3) throw failure("table.insert: needs a table, an optional position and a value");
  lua_Integer position = size + 1;
  if (arguments == 3) {
    position = luaL_checkinteger(lua, 2);
    if (position < 1 || position > size + 1)
      throw failure(fmt::format("table.insert: position {} is out of range", position), {},
                    fmt::format("1…{}", size + 1));
    Sandbox::of(lua).charge(static_cast<std::uint64_t>(size + 1 - position));
    for (lua_Integer i = size; i >= position; --i) {
      lua_rawgeti(lua, 1, i);
      lua_rawseti(lua, 1, i + 1);
    }
  }
  lua_settop(lua, arguments);
  lua_rawseti(lua, 1, position);
  return 0;
}

int table_remove(lua_State* lua) {
  const lua_Integer size = length(lua);
  const lua_Integer position = luaL_optinteger(lua, 2, size);
  if (size == 0 && (position == 0 || position == 1)) return 0;
  if (position < 1 || position > size + 1)
    throw failure(fmt::format("table.remove: position {} is out of range", position), {}, fmt::format("1…{}", size));
  Sandbox::of(lua).charge(static_cast<std::uint64_t>(size + 1 - position));
  lua_settop(lua, 1);
  lua_rawgeti(lua, 1, position);
  for (lua_Integer i = position; i <= size; ++i) {
    lua_rawgeti(lua, 1, i + 1);
    lua_rawseti(lua, 1, i);
  }
  return 1;
}

int table_concat(lua_State* lua) {
  luaL_checktype(lua, 1, LUA_TTABLE);
  std::size_t separator_size = 0;
  const char* separator = luaL_optlstring(lua, 2, "", &separator_size);
  push_real(lua, 1);
  lua_replace(lua, 1);
  const lua_Integer size = static_cast<lua_Integer>(lua_rawlen(lua, 1));
  const lua_Integer first = luaL_optinteger(lua, 3, 1);
  const lua_Integer last = luaL_optinteger(lua, 4, size);
  Sandbox& box = Sandbox::of(lua);
  luaL_Buffer buffer;
  luaL_buffinit(lua, &buffer);
  for (lua_Integer i = first; i <= last; ++i) {
    box.charge(1);
    const int type = lua_rawgeti(lua, 1, i);
    if (type != LUA_TSTRING && type != LUA_TNUMBER)
      throw failure(fmt::format("table.concat: item {} is a {}", i, luaL_typename(lua, -1)), {}, "texts and numbers");
    luaL_addvalue(&buffer);
    if (i < last) luaL_addlstring(&buffer, separator, separator_size);
    if (i == LUA_MAXINTEGER) break;
  }
  luaL_pushresult(&buffer);
  return 1;
}

int table_unpack(lua_State* lua) {
  const lua_Integer first = luaL_optinteger(lua, 2, 1);
  const lua_Integer last = lua_isnoneornil(lua, 3) ? luaL_len(lua, 1) : luaL_checkinteger(lua, 3);
  // Ranges that run over an integer are too long for Lua's own, which says so.
  if (first <= last)
    Sandbox::of(lua).charge(
        std::min<std::uint64_t>(static_cast<std::uint64_t>(last) - static_cast<std::uint64_t>(first), 1u << 20));
  lua_settop(lua, 3);
  lua_pushvalue(lua, lua_upvalueindex(1));
  lua_insert(lua, 1);
  call(lua, 3, LUA_MULTRET);
  return lua_gettop(lua);
}

int table_sort(lua_State* lua) {
  const double size = static_cast<double>(length(lua));
  lua_settop(lua, 2);
  // __len could claim any size, __index make up what is sorted: C loops that no instruction counts.
  if (lua_getmetatable(lua, 1)) throw failure("table.sort: a table with a metatable cannot be sorted");
  Sandbox::of(lua).charge(static_cast<std::uint64_t>(size * std::log2(1.0 + size)));
  lua_pushvalue(lua, lua_upvalueindex(1));
  lua_insert(lua, 1);
  call(lua, 2, 0);
  return 0;
}

}  // namespace

void push_string_library(lua_State* lua) {
  luaopen_string(lua);
  name_functions(lua, "string");
  lua_getfield(lua, -1, "format");
  lua_pushcclosure(lua, (&native<string_format, "format">), 1);
  lua_getfield(lua, -2, "rep");
  lua_pushcclosure(lua, (&native<string_rep, "rep">), 1);
  lua_rotate(lua, -3, 2);
  pick(lua, {"byte", "char", "len", "lower", "reverse", "sub", "upper"});
  lua_rotate(lua, -3, 1);
  lua_setfield(lua, -3, "rep");
  lua_setfield(lua, -2, "format");
  set(lua, "find", &native<string_find, "find">);
  name_absent(lua, "string");
  make_read_only(lua);
  // Methods of strings come from the same table, and nobody may replace them.
  lua_pushliteral(lua, "");
  lua_getmetatable(lua, -1);
  lua_pushvalue(lua, -3);
  lua_setfield(lua, -2, "__index");
  lua_pushboolean(lua, 0);
  lua_setfield(lua, -2, "__metatable");
  lua_pop(lua, 2);
}

void push_table_library(lua_State* lua) {
  luaopen_table(lua);
  name_functions(lua, "table");
  lua_getfield(lua, -1, "sort");
  lua_pushcclosure(lua, (&native<table_sort, "sort">), 1);
  lua_insert(lua, -2);
  lua_getfield(lua, -1, "unpack");
  lua_pushcclosure(lua, (&native<table_unpack, "unpack">), 1);
  lua_insert(lua, -2);
  pick(lua, {"pack"});
  lua_rotate(lua, -3, 1);
  lua_setfield(lua, -3, "unpack");
  lua_setfield(lua, -2, "sort");
  set(lua, "insert", &native<table_insert, "insert">);
  set(lua, "remove", &native<table_remove, "remove">);
  set(lua, "concat", &native<table_concat, "concat">);
  name_absent(lua, "table");
  make_read_only(lua);
}

void push_math_library(lua_State* lua) {
  luaopen_math(lua);
  pick(lua, {"deg",   "rad",  "abs",  "acos", "asin",      "atan",       "ceil", "cos",        "exp",
             "floor", "fmod", "huge", "log",  "max",       "maxinteger", "min",  "mininteger", "modf",
             "pi",    "sin",  "sqrt", "tan",  "tointeger", "type",       "ult"});
  name_absent(lua, "math");
  make_read_only(lua);
}

}  // namespace afterglow::script
