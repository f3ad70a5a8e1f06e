// SPDX-License-Identifier: MIT
#include "script/absent.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/ascii.h"
#include "core/text.h"
#include "script/native.h"
#include "script/syntax_hint.h"

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
    {"string", " match gmatch gsub ",
     "patterns may run without end; string.find (of plain text) and string.sub are there"},
    {"string", " dump pack unpack packsize ", "presets have the plain parts of Lua alone"},
    {"table", " move ", "a loop does the same"},
};

constexpr std::size_t kMaxNames = 500;  // that a misspelt name is compared with
constexpr std::size_t kMaxName = 64;    // bytes of each

void add_name(std::vector<std::string>& names, std::string_view name) {
  if (names.size() < kMaxNames && name.size() <= kMaxName && !name.starts_with('(')) names.emplace_back(name);
}

void add_keys(lua_State* lua, int table, std::vector<std::string>& names) {
  table = lua_absindex(lua, table);
  std::vector<std::string> keys;
  lua_pushnil(lua);
  while (lua_next(lua, table)) {
    lua_pop(lua, 1);
    if (lua_type(lua, -1) == LUA_TSTRING) add_name(keys, lua_tostring(lua, -1));
    if (keys.size() < kMaxNames) continue;
    lua_pop(lua, 1);
    break;
  }
  std::sort(keys.begin(), keys.end());  // Lua's own order differs from run to run
  for (const auto& key : keys) add_name(names, key);
}

// What the function that asks can see: its variables, those of the functions around it, and the globals of its script.
void add_variables(lua_State* lua, std::vector<std::string>& names) {
  lua_Debug frame{};
  if (!lua_getstack(lua, 1, &frame)) return;
  for (int i = 1; const char* name = lua_getlocal(lua, &frame, i); ++i) {
    add_name(names, name);
    lua_pop(lua, 1);
  }
  lua_getinfo(lua, "f", &frame);
  for (int i = 1; const char* name = lua_getupvalue(lua, -1, i); ++i) {
    if (std::string_view(name) == "_ENV" && lua_istable(lua, -1))
      add_keys(lua, -1, names);
    else
      add_name(names, name);
    lua_pop(lua, 1);
  }
  lua_pop(lua, 1);
}

/// Does a line give this word, and nothing else, to a key: "mode = aces,"? Then it may have been meant as a text.
bool is_given_alone(std::string_view line, std::string_view word) {
  constexpr std::size_t kLongest = 1000;  // of what people write
  if (line.size() > kLongest) return false;
  if (trim(line).starts_with("local ")) return false;
  for (std::size_t at = line.find(word); at != std::string_view::npos; at = line.find(word, at + 1)) {
    const std::string before = trim(line.substr(0, at)), behind = trim(line.substr(at + word.size()));
    const bool given = before.ends_with('=') && before.size() > 1 &&
                       std::string_view("=~<>").find(before[before.size() - 2]) == std::string_view::npos;
    const bool ends =
        behind.empty() || behind[0] == ',' || behind[0] == '}' || behind[0] == ';' || behind.starts_with("--");
    if (given && ends && !(at + word.size() < line.size() && is_name_char(line[at + word.size()]))) return true;
  }
  return false;
}

bool may_be_text(lua_State* lua, std::string_view name) {
  Sandbox& box = Sandbox::of(lua);
  const Location where = box.caller(lua);
  if (where.source < 0) return false;
  const std::string& text = box.sources()[static_cast<std::size_t>(where.source)].text;
  box.charge(text.size() / 16);
  return is_given_alone(line_of(text, where.line), name);
}

// Reads of the table in argument 1 end here for what is not in it.
int absent_name(lua_State* lua) {
  const std::string library = lua_tostring(lua, lua_upvalueindex(1));
  if (lua_type(lua, 2) != LUA_TSTRING) {
    lua_pushnil(lua);
    return 1;
  }
  std::size_t size = 0;
  const char* text = lua_tolstring(lua, 2, &size);
  const std::string name(text, size);
  if (!name.empty() && name.find(' ') == std::string::npos)
    for (const auto& [of, names, why] : kAbsent)
      if (of == library && names.find(" " + name + " ") != std::string_view::npos)
        throw failure(fmt::format("there is no {}{} here: {}", library.empty() ? "" : library + ".", name, why));
  std::vector<std::string> names;
  if (library.empty()) add_variables(lua, names);
  add_keys(lua, 1, names);
  Sandbox::of(lua).charge(100 * (names.size() + 1));
  const std::string shown = tidy_message(name, 60);
  if (library.empty() && name == "fx")
    throw failure("nothing here has the name 'fx': begin the file with local fx = require \"afterglow\"");
  if (library.empty())
    throw failure(fmt::format("nothing here has the name '{}'", shown), {},
                  may_be_text(lua, name)
                      ? fmt::format("words in quotation marks (\"{}\"), and variables and functions "
                                    "that stand above this line",
                                    shown)
                      : "variables and functions that stand above this line, and those of the library",
                  nearest_name(name, names));
  throw failure(fmt::format("there is no {}.{}", library, shown), {}, join(names), nearest_name(name, names));
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
