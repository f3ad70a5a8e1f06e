// SPDX-License-Identifier: MIT
// The library table `fx`: scripts/afterglow.lua over the native functions given to it as `core`.
#include <fmt/format.h>

#include "core/made_shaders.h"
#include "core/text.h"
#include "script/arguments.h"
#include "script/declare.h"
#include "script/globals.h"
#include "script/items.h"
#include "script/mask.h"
#include "script/native.h"
#include "script/object.h"
#include "script/read_only.h"
#include "script/runtime.h"
#include "script/stack.h"
#include "script/value.h"

namespace afterglow::script {
namespace {

// core.fail(message, allowed): an error at the line of whoever called the library.
int fail(lua_State* lua) {
  const Value message = read_value(lua, 1), allowed = read_value(lua, 2);
  throw failure(message.text, {}, allowed.text);
}

// core.show(value): the value as messages show it.
int show(lua_State* lua) {
  const std::string text = read_value(lua, 1).shown();
  lua_pushlstring(lua, text.data(), text.size());
  return 1;
}

// __index of a table made by core.read_only; upvalue 1: what its fields are.
int unknown_field(lua_State* lua) {
  const std::string what = lua_tostring(lua, lua_upvalueindex(1));
  std::vector<std::string> names;
  lua_pushnil(lua);
  while (lua_next(lua, 1)) {
    lua_pop(lua, 1);
    if (lua_type(lua, -1) == LUA_TSTRING) names.emplace_back(lua_tostring(lua, -1));
  }
  std::sort(names.begin(), names.end());
  const Value name = read_value(lua, 2);
  throw failure(fmt::format("unknown {} {}", what, name.shown()), {}, join(names), nearest_name(name.text, names));
}

// core.read_only(table, what): the table for reading only; `what` names its fields in messages.
int read_only(lua_State* lua) {
  luaL_checktype(lua, 1, LUA_TTABLE);
  luaL_checktype(lua, 2, LUA_TSTRING);
  lua_createtable(lua, 0, 1);
  lua_pushvalue(lua, 2);
  lua_pushcclosure(lua, (&native<unknown_field, "">), 1);
  lua_setfield(lua, -2, "__index");
  lua_setmetatable(lua, 1);
  lua_settop(lua, 1);
  make_read_only(lua);
  return 1;
}

void push_core(lua_State* lua) {
  const luaL_Reg functions[] = {
      {"stack", &native<declare_stack, "stack">},
      {"effect", &native<declare_effect, "effect">},
      {"int", &native<declare_setting<SettingType::integer>, "int">},
      {"float", &native<declare_setting<SettingType::number>, "float">},
      {"bool", &native<declare_setting<SettingType::boolean>, "bool">},
      {"enum", &native<declare_setting<SettingType::enumeration>, "enum">},
      {"color", &native<declare_setting<SettingType::color>, "color">},
      {"vec2", &native<declare_setting<SettingType::vec2>, "vec2">},
      {"vec3", &native<declare_setting<SettingType::vec3>, "vec3">},
      {"file", &native<declare_setting<SettingType::file>, "file">},
      {"text", &native<declare_setting<SettingType::text>, "text">},
      {"curve", &native<declare_curve, "curve">},
      {"extend", &native<declare_extend, "extend">},
      {"args", &native<declare_arguments, "args">},
      {"group", &native<declare_group, "group">},
      {"mix", &native<declare_mix, "mix">},
      {"volume", &native<declare_volume, "volume">},
      {"fail", &native<fail, "fail">},
      {"show", &native<show, "show">},
      {"read_only", &native<read_only, "read_only">},
  };
  lua_createtable(lua, 0, static_cast<int>(std::size(functions)));
  for (const auto& [name, function] : functions) {
    lua_pushcfunction(lua, function);
    lua_setfield(lua, -2, name);
  }
  push_masks(lua);
  lua_setfield(lua, -2, "mask");
}

}  // namespace

void push_library(lua_State* lua) {
  const Runtime& runtime = Runtime::of(lua);
  load_chunk(lua, runtime.path.installation / "scripts" / "afterglow.lua", true);
  push_core(lua);
  call(lua, 1, 1);
  luaL_checktype(lua, -1, LUA_TTABLE);
  lua_createtable(lua, 0, 1);
  lua_pushcfunction(lua, (&native<library_index, "">));
  lua_setfield(lua, -2, "__index");
  lua_setmetatable(lua, -2);
  make_read_only(lua);
}

Result<std::unique_ptr<Runtime>> Runtime::create(SearchPath path, const ScriptLimits& limits,
                                                 Diagnostics& diagnostics) {
  if (path.error) return *path.error;
  if (path.installation.empty())
    return Error{ErrorKind::script,
                 "the installation with scripts/afterglow.lua was not found (AFTERGLOW_HOME names its folder)"};
  AFTERGLOW_TRY(std::unique_ptr<Sandbox> box, Sandbox::create(limits));
  auto runtime = std::make_unique<Runtime>();
  runtime->path = std::move(path);
  runtime->path.made = std::make_shared<MadeShaders>();
  runtime->box = std::move(box);
  runtime->box->owner = runtime.get();
  runtime->box->diagnostics = &diagnostics;
  const std::string file = (runtime->path.installation / "scripts" / "afterglow.lua").string();
  if (auto error = runtime->box->run(file, [](lua_State* lua) {
        push_require(lua);
        set_global(lua, "require");
      }))
    return std::move(*error);
  return runtime;
}

}  // namespace afterglow::script
