// SPDX-License-Identifier: MIT
// Lua's headers. A Lua library exports C names or, built as C++, on some systems C++ names; <lua.hpp> always says C.
// CMake asks the linker and defines AFTERGLOW_LUA_C_NAMES (cmake/lua.cmake).
#pragma once

#ifdef AFTERGLOW_LUA_C_NAMES
extern "C" {
#endif
#include <lauxlib.h>
#include <lua.h>
#include <lualib.h>
#ifdef AFTERGLOW_LUA_C_NAMES
}
#endif
