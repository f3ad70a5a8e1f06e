// SPDX-License-Identifier: MIT
#include "script/read_only.h"

#include "script/native.h"

namespace afterglow::script {
namespace {

const char kReal = 0;  // its address is the key of the real table in the view's metatable

int refuse_write(lua_State*) { throw failure("this table is read-only"); }

int real_length(lua_State* lua) {
  push_real(lua, 1);
  lua_pushinteger(lua, static_cast<lua_Integer>(lua_rawlen(lua, -1)));
  return 1;
}

}  // namespace

void make_read_only(lua_State* lua) {
  luaL_checkstack(lua, 6, nullptr);
  lua_createtable(lua, 0, 0);  // the view
  lua_createtable(lua, 0, 5);  // its metatable
  lua_pushvalue(lua, -3);
  lua_rawsetp(lua, -2, &kReal);
  lua_pushvalue(lua, -3);
  lua_setfield(lua, -2, "__index");
  lua_pushcfunction(lua, (&native<refuse_write, "">));
  lua_setfield(lua, -2, "__newindex");
  lua_pushcfunction(lua, (&native<real_length, "">));
  lua_setfield(lua, -2, "__len");
  lua_pushboolean(lua, 0);
  lua_setfield(lua, -2, "__metatable");
  lua_setmetatable(lua, -2);
  lua_remove(lua, -2);
}

void push_real(lua_State* lua, int index) {
  index = lua_absindex(lua, index);
  luaL_checkstack(lua, 3, nullptr);
  if (lua_type(lua, index) == LUA_TTABLE && lua_getmetatable(lua, index)) {
    if (lua_rawgetp(lua, -1, &kReal) == LUA_TTABLE) {
      lua_remove(lua, -2);
      return;
    }
    lua_pop(lua, 2);
  }
  lua_pushvalue(lua, index);
}

}  // namespace afterglow::script
