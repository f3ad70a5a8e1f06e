// SPDX-License-Identifier: MIT
#include "script/globals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "script/absent.h"
#include "script/metatables.h"
#include "script/native.h"
#include "script/read_only.h"
#include "script/value.h"

namespace afterglow::script {
namespace {

const char kGlobals = 0;         // registry key of the table of globals
constexpr int kMaxPrints = 100;  // lines of `print` that one run may show

int do_error(lua_State* lua) {
  Sandbox& box = Sandbox::of(lua);
  const auto level = luaL_optinteger(lua, 2, 1);
  lua_settop(lua, 1);
  if (lua_type(lua, 1) != LUA_TSTRING) return lua_error(lua);
  std::size_t size = 0;
  const char* text = lua_tolstring(lua, 1, &size);
  Error error{ErrorKind::script, std::string(text, std::min<std::size_t>(size, 2000))};
  // Level 0 passes on a caught message, whose place is in its text.
  if (level <= 0)
    for (std::size_t i = 0; i < box.sources().size() && error.line == 0; ++i) {
      const std::string prefix = box.sources()[i].path + ":";
      if (!error.message.starts_with(prefix)) continue;
      char* end = nullptr;
      const long line = std::strtol(error.message.c_str() + prefix.size(), &end, 10);
      if (line <= 0 || std::strncmp(end, ": ", 2) != 0) continue;
      box.locate(error, {static_cast<int>(i), static_cast<int>(line)});
      error.message.erase(0, static_cast<std::size_t>(end + 2 - error.message.c_str()));
    }
  if (level <= 0 && error.line == 0 && box.blame) locate_blame(box, *box.blame, error);
  if (error.line == 0) box.locate(error, box.caller(lua, static_cast<int>(std::clamp<lua_Integer>(level, 1, 1000))));
  throw ScriptError{std::move(error)};
}

int do_pcall(lua_State* lua) {
  Sandbox& box = Sandbox::of(lua);
  luaL_checkany(lua, 1);
  const int status = lua_pcall(lua, lua_gettop(lua) - 1, LUA_MULTRET, 0);
  if (status == LUA_OK) {
    lua_pushboolean(lua, 1);
    lua_insert(lua, 1);
    return lua_gettop(lua);
  }
  if (status == LUA_ERRMEM) box.memory_failed();
  if (box.exhausted()) box.charge(0);  // raises again
  // Errors of ours are shown as the text that the user would see.
  if (const Error* error = box.raised(lua, -1)) {
    std::string text = error->message;
    if (!error->file.empty()) text = fmt::format("{}:{}: {}", error->file, error->line, text);
    lua_settop(lua, 0);
    lua_pushboolean(lua, 0);
    lua_pushlstring(lua, text.data(), text.size());
    return 2;
  }
  if (lua_type(lua, -1) == LUA_TSTRING) {  // of Lua itself: "@3:17: attempt to …"
    std::string text = lua_tostring(lua, -1);
    Error error{ErrorKind::script, ""};
    box.locate(error, box.take_prefix(text));
    if (!error.file.empty()) text = fmt::format("{}:{}: {}", error.file, error.line, text);
    lua_pop(lua, 1);
    lua_pushlstring(lua, text.data(), text.size());
  }
  lua_pushboolean(lua, 0);
  lua_insert(lua, -2);
  return 2;
}

int do_print(lua_State* lua) {
  Sandbox& box = Sandbox::of(lua);
  const int count = lua_gettop(lua);
  if (!box.diagnostics || ++box.printed > kMaxPrints) return 0;
  std::string line;
  for (int i = 1; i <= count; ++i) {
    push_text(lua, i);
    std::size_t size = 0;
    const char* text = lua_tolstring(lua, -1, &size);
    line.append(i > 1 ? " " : "").append(text, std::min<std::size_t>(size, 500));
    lua_pop(lua, 1);
    if (line.size() > 500) break;
  }
  Error place;
  box.locate(place, box.caller(lua));
  box.diagnostics->print(fmt::format("{}:{}: {}", place.file, place.line, tidy_message(line)));
  return 0;
}

int do_tostring(lua_State* lua) {
  luaL_checkany(lua, 1);
  push_text(lua, 1);
  return 1;
}

int do_tonumber(lua_State* lua) {
  if (lua_type(lua, 1) == LUA_TSTRING) Sandbox::of(lua).charge(lua_rawlen(lua, 1) / 8);
  lua_pushvalue(lua, lua_upvalueindex(1));
  lua_insert(lua, 1);
  call(lua, lua_gettop(lua) - 1, LUA_MULTRET);
  return lua_gettop(lua);
}

int do_rawset(lua_State* lua) {
  luaL_checktype(lua, 1, LUA_TTABLE);
  luaL_checkany(lua, 2);
  luaL_checkany(lua, 3);
  if (is_protected(lua, 1)) throw failure("rawset: this table is protected");
  lua_settop(lua, 3);
  lua_rawset(lua, 1);
  return 1;
}

// ---- pairs in a fixed order: numbers, then texts by their bytes, then false and true

struct Key {
  int rank;  // 0 number, 1 text, 2 boolean
  double number;
  const char* text;  // owned by the table; Lua never moves strings
  std::size_t size;
  lua_Integer integer;  // exact value of integers, tie-break of large ones
  bool is_integer;
};

bool operator<(const Key& a, const Key& b) {
  if (a.rank != b.rank) return a.rank < b.rank;
  if (a.rank == 1) return std::string_view(a.text, a.size) < std::string_view(b.text, b.size);
  if (a.number != b.number) return a.number < b.number;
  return a.integer < b.integer;
}

Key key_at(lua_State* lua, int index) {
  Key key{};
  switch (lua_type(lua, index)) {
    case LUA_TNUMBER:
      key.number = lua_tonumber(lua, index);
      key.is_integer = lua_isinteger(lua, index);
      if (key.is_integer) key.integer = lua_tointeger(lua, index);
      return key;
    case LUA_TSTRING:
      key.rank = 1;
      key.text = lua_tolstring(lua, index, &key.size);
      return key;
    case LUA_TBOOLEAN:
      key.rank = 2;
      key.number = lua_toboolean(lua, index);
      return key;
    default:
      throw failure(fmt::format("pairs: a key is a {}, which has no place in an order", luaL_typename(lua, index)), {},
                    "numbers, texts and booleans as keys");
  }
}

int next_pair(lua_State* lua) {
  // Upvalues: the table, its sorted keys, how many were handed out.
  lua_Integer i = lua_tointeger(lua, lua_upvalueindex(3));
  for (;;) {
    if (lua_rawgeti(lua, lua_upvalueindex(2), ++i) == LUA_TNIL) return 1;
    lua_pushvalue(lua, -1);
    if (lua_rawget(lua, lua_upvalueindex(1)) != LUA_TNIL) break;  // still there
    lua_pop(lua, 2);
  }
  lua_pushinteger(lua, i);
  lua_replace(lua, lua_upvalueindex(3));
  return 2;
}

int do_pairs(lua_State* lua) {
  luaL_checktype(lua, 1, LUA_TTABLE);
  push_real(lua, 1);
  lua_replace(lua, 1);
  lua_settop(lua, 1);
  Sandbox& box = Sandbox::of(lua);
  std::vector<Key> keys;
  lua_pushnil(lua);
  while (lua_next(lua, 1)) {
    lua_pop(lua, 1);
    keys.push_back(key_at(lua, -1));
    if (keys.size() % 1024 == 0) box.charge(1024);
  }
  box.charge(static_cast<std::uint64_t>(static_cast<double>(keys.size()) *
                                        std::log2(1.0 + static_cast<double>(keys.size())) / 4));
  std::sort(keys.begin(), keys.end());
  lua_createtable(lua, static_cast<int>(std::min<std::size_t>(keys.size(), 1u << 24)), 0);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Key& key = keys[i];
    if (key.rank == 1)
      lua_pushlstring(lua, key.text, key.size);
    else if (key.rank == 2)
      lua_pushboolean(lua, key.number != 0);
    else if (key.is_integer)
      lua_pushinteger(lua, key.integer);
    else
      lua_pushnumber(lua, key.number);
    lua_rawseti(lua, -2, static_cast<lua_Integer>(i + 1));
  }
  lua_pushinteger(lua, 0);
  lua_pushcclosure(lua, (&native<next_pair, "">), 3);
  return 1;
}

}  // namespace

void push_text(lua_State* lua, int index) {
  index = lua_absindex(lua, index);
  const int type = lua_type(lua, index);
  if (type == LUA_TNIL || type == LUA_TBOOLEAN || type == LUA_TNUMBER || type == LUA_TSTRING) {
    luaL_tolstring(lua, index, nullptr);
  } else if (luaL_getmetafield(lua, index, "__tostring") != LUA_TNIL) {
    lua_pushvalue(lua, index);
    call(lua, 1, 1);
    if (lua_type(lua, -1) != LUA_TSTRING) throw failure("tostring: __tostring must return a text");
  } else {
    lua_pushstring(lua, kind_name(lua, index).c_str());
  }
}

void set_global(lua_State* lua, const char* name) {
  lua_rawgetp(lua, LUA_REGISTRYINDEX, &kGlobals);
  lua_insert(lua, -2);
  lua_setfield(lua, -2, name);
  lua_pop(lua, 1);
}

void push_environment(lua_State* lua) {
  lua_createtable(lua, 0, 0);
  lua_createtable(lua, 0, 2);
  lua_rawgetp(lua, LUA_REGISTRYINDEX, &kGlobals);
  lua_setfield(lua, -2, "__index");
  lua_pushboolean(lua, 0);
  lua_setfield(lua, -2, "__metatable");
  lua_setmetatable(lua, -2);
}

void open_globals(lua_State* lua) {
  lua_createtable(lua, 0, 32);
  name_absent(lua, "");
  lua_rawsetp(lua, LUA_REGISTRYINDEX, &kGlobals);

  luaL_requiref(lua, LUA_GNAME, luaopen_base, 0);
  for (const char* name : {"assert", "getmetatable", "ipairs", "rawequal", "rawget", "rawlen", "select", "type"}) {
    lua_getfield(lua, -1, name);
    set_global(lua, name);
  }
  lua_getfield(lua, -1, "tonumber");
  lua_pushcclosure(lua, (&native<do_tonumber, "tonumber">), 1);
  set_global(lua, "tonumber");
  lua_pop(lua, 1);

  const luaL_Reg functions[] = {
      {"error", &native<do_error, "error">},         {"pairs", &native<do_pairs, "pairs">},
      {"pcall", &native<do_pcall, "pcall">},         {"print", &native<do_print, "print">},
      {"rawset", &native<do_rawset, "rawset">},      {"setmetatable", &native<do_setmetatable, "setmetatable">},
      {"tostring", &native<do_tostring, "tostring">}};
  for (const auto& [name, function] : functions) {
    lua_pushcfunction(lua, function);
    set_global(lua, name);
  }
  lua_createtable(lua, 0, 2);  // in place of Lua's
  lua_setfield(lua, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
  push_string_library(lua);
  set_global(lua, "string");
  push_table_library(lua);
  set_global(lua, "table");
  push_math_library(lua);
  set_global(lua, "math");

  // The global table that Lua itself knows stays empty: chunks get environments of their own.
  lua_createtable(lua, 0, 0);
  lua_rawseti(lua, LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
}

}  // namespace afterglow::script
