// SPDX-License-Identifier: MIT
#include "script/absent.h"

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "script/native.h"

namespace afterglow::script {
namespace {

struct Names {
  std::string_view library, names, why;  ///< names with a space before and behind each
};
constexpr Names kAbsent[] = {
    {"", " io os package debug ", "presets reach no files, processes or clocks"},
    {"", " load loadfile loadstring dofile ", "scripts come from files on the search path; require reads them"},
    {"", " coroutine xpcall collectgarbage warn utf8 next getfenv ", "presets have the plain parts of Lua alone"},
    {"math", " random randomseed ",
     "every run must give the same pictures; make numbers of t.frame, g.frame or a setting"},
    {"string", " find match gmatch gsub ", "patterns may run without end; string.sub and comparisons are there"},
    {"string", " dump pack unpack packsize ", "presets have the plain parts of Lua alone"},
    {"table", " move ", "a loop does the same"},
};

int absent_name(lua_State* lua) {
  const std::string library = lua_tostring(lua, lua_upvalueindex(1));
  std::size_t size = 0;
  const char* text = lua_type(lua, 2) == LUA_TSTRING ? lua_tolstring(lua, 2, &size) : "";
  const std::string name(text, size);
  if (!name.empty() && name.find(' ') == std::string::npos)
    for (const auto& [of, names, why] : kAbsent)
      if (of == library && names.find(" " + name + " ") != std::string_view::npos)
        throw failure(fmt::format("there is no {}{} here: {}", library.empty() ? "" : library + ".", name, why));
  lua_pushnil(lua);
  return 1;
}

}  // namespace

void name_absent(lua_State* lua, const char* library) {
  lua_createtable(lua, 0, 1);
  lua_pushstring(lua, library);
  lua_pushcclosure(lua, (&native<absent_name, "">), 1);
  lua_setfield(lua, -2, "__index");
  lua_setmetatable(lua, -2);
}

}  // namespace afterglow::script
