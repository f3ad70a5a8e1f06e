#include "script/mask.h"

#include <fmt/format.h>

#include <cmath>

#include "core/text.h"
#include "script/entry_reader.h"
#include "script/native.h"
#include "script/object.h"
#include "script/read_only.h"
#include "script/runtime.h"
#include "script/table_reader.h"

namespace afterglow::script {
namespace {

using Kind = EntryMask::Kind;

constexpr std::size_t kMaxMasks = 4096;  // of one state

int add_mask(lua_State* lua, DeclaredMask mask) {
  Runtime& runtime = Runtime::of(lua);
  if (!runtime.declaring) throw failure("masks can only be made while a script loads");
  if (runtime.masks.size() >= kMaxMasks) throw failure(fmt::format("more than {} masks in one preset", kMaxMasks));
  runtime.masks.push_back(std::move(mask));
  return static_cast<int>(runtime.masks.size()) - 1;
}

DeclaredMask number_mask(double number) {
  return {.kind = Kind::number, .number = number, .a = -1, .b = -1, .named = {}};
}

// A mask or a number; -1: something else.
int to_mask(lua_State* lua, int index) {
  if (const Handle* mask = to_object<Handle>(lua, index, kMaskKind)) return mask->index;
  const Value value = read_value(lua, index);
  if (value.kind != Value::Kind::number || !std::isfinite(value.number)) return -1;
  return add_mask(lua, number_mask(value.number));
}

template <Kind kind>
int combine(lua_State* lua) {
  DeclaredMask mask{.kind = kind, .number = 0, .a = to_mask(lua, 1), .b = to_mask(lua, 2), .named = {}};
  if (mask.a < 0 || mask.b < 0)
    throw failure(fmt::format("a mask cannot be combined with {}", read_value(lua, mask.a < 0 ? 1 : 2).shown()), {},
                  "masks and numbers, by + - *");
  push_object(lua, kMaskKind, Handle{add_mask(lua, std::move(mask))});
  return 1;
}

// fx.mask.NAME{…}; upvalue: index of its script.
int make_mask(lua_State* lua) {
  Runtime& runtime = Runtime::of(lua);
  const int index = static_cast<int>(lua_tointeger(lua, lua_upvalueindex(1)));
  const EffectSchema& schema = runtime.effects[static_cast<std::size_t>(index)].schema;
  try {
    TableReader table(lua, 1, "fx.mask." + schema.name);
    DeclaredMask mask{.kind = Kind::named, .number = 0, .a = -1, .b = -1, .named = new_entry(runtime, index)};
    const bool invert = table.boolean("invert").value_or(false);
    read_settings_of(lua, table, schema, mask.named, {"invert"});
    table.finish(schema.name.c_str());
    Error place;
    runtime.box->locate(place, runtime.box->caller(lua));
    mask.named.entry.file = place.file;
    mask.named.entry.line = place.line;
    int made = add_mask(lua, std::move(mask));
    if (invert) {
      const int one = add_mask(lua, number_mask(1));
      made = add_mask(lua, {.kind = Kind::subtract, .number = 0, .a = one, .b = made, .named = {}});
    }
    push_object(lua, kMaskKind, Handle{made});
  } catch (ScriptError& error) {
    error.function = schema.name;
    throw;
  }
  return 1;
}

// __index of fx.mask.
int mask_of_name(lua_State* lua) {
  if (lua_type(lua, 2) != LUA_TSTRING) throw failure("fx.mask: the name of a mask must be a text");
  std::size_t size = 0;
  const char* text = lua_tolstring(lua, 2, &size);
  lua_pushinteger(lua, find_effect(lua, std::string(text, size), ScriptKind::mask));
  lua_pushcclosure(lua, (&native<make_mask, "mask">), 1);
  return 1;
}

}  // namespace

void push_masks(lua_State* lua) {
  push_kind(lua, kMaskKind);
  const luaL_Reg operators[] = {{"__add", &native<combine<Kind::add>, "+">},
                                {"__sub", &native<combine<Kind::subtract>, "-">},
                                {"__mul", &native<combine<Kind::multiply>, "*">}};
  for (const auto& [name, function] : operators) {
    lua_pushcfunction(lua, function);
    lua_setfield(lua, -2, name);
  }
  lua_pop(lua, 1);
  lua_createtable(lua, 0, 0);
  lua_createtable(lua, 0, 1);
  lua_pushcfunction(lua, (&native<mask_of_name, "">));
  lua_setfield(lua, -2, "__index");
  lua_setmetatable(lua, -2);
  make_read_only(lua);
}

void read_mask(lua_State* lua, TableReader& table, DeclaredEntry& declared) {
  table.push("mask");
  if (!lua_isnil(lua, -1)) {
    declared.mask = to_mask(lua, -1);
    if (declared.mask < 0)
      table.fail(failure(fmt::format("{}: mask = {} is not a mask", table.what(), read_value(lua, -1).shown()),
                         {"mask"}, "fx.mask.NAME { … }, a number, such combined by + - *"));
  }
  lua_pop(lua, 1);
}

}  // namespace afterglow::script
