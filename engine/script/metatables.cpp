// SPDX-License-Identifier: MIT
#include "script/metatables.h"

#include <array>

#include "script/native.h"

namespace afterglow::script {
namespace {

const char kCopy = 0;  // its address is a key of each copy

constexpr std::array kEvents{"__index", "__newindex", "__call",   "__tostring", "__name", "__len", "__eq",
                             "__lt",    "__le",       "__concat", "__unm",      "__add",  "__sub", "__mul",
                             "__div",   "__mod",      "__pow",    "__idiv",     "__band", "__bor", "__bxor",
                             "__shl",   "__shr",      "__bnot",   "__close"};

void refuse(lua_State* lua, int metatable, const char* event, const char* why) {
  lua_pushstring(lua, event);
  if (lua_rawget(lua, metatable) != LUA_TNIL) throw failure(why);
  lua_pop(lua, 1);
}

}  // namespace

bool is_protected(lua_State* lua, int index) {
  if (!lua_getmetatable(lua, index)) return false;
  lua_pushliteral(lua, "__metatable");
  const bool hidden = lua_rawget(lua, -2) != LUA_TNIL;
  const bool copy = lua_rawgetp(lua, -2, &kCopy) != LUA_TNIL;
  lua_pop(lua, 3);
  return hidden && !copy;
}

int do_setmetatable(lua_State* lua) {
  luaL_checktype(lua, 1, LUA_TTABLE);
  if (!lua_isnil(lua, 2)) luaL_checktype(lua, 2, LUA_TTABLE);
  if (is_protected(lua, 1)) throw failure("setmetatable: this metatable is protected");
  lua_settop(lua, 2);
  if (lua_isnil(lua, 2)) {
    lua_setmetatable(lua, 1);
    return 1;
  }
  Sandbox::of(lua).charge(kEvents.size());
  refuse(lua, 2, "__gc", "setmetatable: __gc is not allowed");
  refuse(lua, 2, "__mode", "setmetatable: __mode is not allowed (weak tables show when garbage is collected)");
  lua_createtable(lua, 0, 6);
  for (const char* event : kEvents) {
    lua_pushstring(lua, event);
    if (lua_rawget(lua, 2) == LUA_TNIL) {
      lua_pop(lua, 1);
    } else {
      lua_setfield(lua, 3, event);
    }
  }
  lua_getfield(lua, 3, "__call");
  if (!lua_isnil(lua, -1) && !lua_isfunction(lua, -1)) throw failure("setmetatable: __call must be a function");
  lua_pushliteral(lua, "__metatable");
  if (lua_rawget(lua, 2) == LUA_TNIL) {  // not hidden: seen as itself, and may be replaced
    lua_pushboolean(lua, 1);
    lua_rawsetp(lua, 3, &kCopy);
    lua_pushvalue(lua, 2);
  }
  lua_setfield(lua, 3, "__metatable");
  lua_settop(lua, 3);
  lua_setmetatable(lua, 1);
  lua_settop(lua, 1);
  return 1;
}

}  // namespace afterglow::script
