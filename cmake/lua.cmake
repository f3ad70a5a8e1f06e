# SPDX-License-Identifier: MIT
# Finds Lua 5.4 as PkgConfig::AFTERGLOW_LUA. Built as C++ it runs destructors when an error unwinds, so such a build is preferred;
# a C build works too, but a script's error then leaks what the functions on its way had allocated.
# AFTERGLOW_LUA_MODULE: the pkg-config module to use instead of the first one that is found.
include(CMakePushCheckState)
include(CheckCXXSourceCompiles)

set(AFTERGLOW_LUA_MODULE "" CACHE STRING "pkg-config module of Lua 5.4 (empty: the first one that is found)")
if(AFTERGLOW_LUA_MODULE)
  pkg_check_modules(AFTERGLOW_LUA REQUIRED IMPORTED_TARGET ${AFTERGLOW_LUA_MODULE}>=5.4)
else()
  pkg_search_module(AFTERGLOW_LUA REQUIRED IMPORTED_TARGET lua5.4-c++>=5.4 lua-c++>=5.4 lua5.4>=5.4 lua-5.4>=5.4 lua54>=5.4 lua>=5.4)
endif()
if(AFTERGLOW_LUA_VERSION VERSION_GREATER_EQUAL 5.5)
  message(FATAL_ERROR "pkg-config finds Lua ${AFTERGLOW_LUA_VERSION}; 5.4 is needed")
endif()

# A Lua built as C++ exports C names on some systems and C++ names on others. The linker knows; engine/script/lua.h reads the answer.
function(afterglow_lua_links variable definition)
  cmake_push_check_state(RESET)
  set(CMAKE_REQUIRED_QUIET ON)
  set(CMAKE_REQUIRED_LIBRARIES PkgConfig::AFTERGLOW_LUA)
  set(CMAKE_REQUIRED_DEFINITIONS ${definition})
  check_cxx_source_compiles("
    #ifdef AFTERGLOW_LUA_C_NAMES
    extern \"C\" {
    #endif
    #include <lua.h>
    #include <lauxlib.h>
    #ifdef AFTERGLOW_LUA_C_NAMES
    }
    #endif
    int main() { lua_close(luaL_newstate()); }" ${variable})
  cmake_pop_check_state()
endfunction()
string(MAKE_C_IDENTIFIER "AFTERGLOW_LINKS_${AFTERGLOW_LUA_LINK_LIBRARIES}" links)
afterglow_lua_links(${links}_BY_C_NAMES -DAFTERGLOW_LUA_C_NAMES)
if(${links}_BY_C_NAMES)
  target_compile_definitions(PkgConfig::AFTERGLOW_LUA INTERFACE AFTERGLOW_LUA_C_NAMES)
else()
  afterglow_lua_links(${links}_BY_CXX_NAMES "")
  if(NOT ${links}_BY_CXX_NAMES)
    message(FATAL_ERROR "A program with ${AFTERGLOW_LUA_LINK_LIBRARIES} does not link, neither by C names nor by C++ names")
  endif()
endif()
