// SPDX-License-Identifier: MIT
#include "script/mask.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>

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
constexpr int kMaxParts = 256;           // of one mask

int add_mask(lua_State* lua, DeclaredMask mask) {
  Runtime& runtime = Runtime::of(lua);
  if (!runtime.declaring) throw failure("masks can only be made while a script loads");
  if (runtime.masks.size() >= kMaxMasks) throw failure(fmt::format("more than {} masks in one preset", kMaxMasks));
  runtime.masks.push_back(std::move(mask));
  return static_cast<int>(runtime.masks.size()) - 1;
}

DeclaredMask number_mask(double number) { return {.kind = Kind::number, .number = number}; }

DeclaredMask combined_mask(const Runtime& runtime, Kind kind, int a, int b) {
  const auto parts = [&](int mask) { return runtime.masks[static_cast<std::size_t>(mask)].parts; };
  if (parts(a) + parts(b) > kMaxParts)
    throw failure(fmt::format("a mask is made of more than {} masks and numbers", kMaxParts));
  return {.kind = kind, .a = a, .b = b, .parts = parts(a) + parts(b)};
}

int copy_mask(Runtime& runtime, int mask) {
  if (mask < 0) return mask;
  DeclaredMask copy = runtime.masks[static_cast<std::size_t>(mask)];
  copy.a = copy_mask(runtime, copy.a);
  copy.b = copy_mask(runtime, copy.b);
  runtime.masks.push_back(std::move(copy));
  return static_cast<int>(runtime.masks.size()) - 1;
}

using PartVisitor = std::function<void(const std::string& name, int mask)>;

void visit_parts(const Runtime& runtime, int mask, MaskNames& names, const PartVisitor& visit) {
  if (mask < 0) return;
  const DeclaredMask& declared = runtime.masks[static_cast<std::size_t>(mask)];
  visit_parts(runtime, declared.a, names, visit);
  visit_parts(runtime, declared.b, names, visit);
  if (declared.kind == Kind::named) visit(names.next(declared.named.entry.effect), mask);
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
  const int a = to_mask(lua, 1), b = to_mask(lua, 2);
  if (a < 0 || b < 0)
    throw failure(fmt::format("a mask cannot be combined with {}", read_value(lua, a < 0 ? 1 : 2).shown()), {},
                  "masks and numbers, by + - *");
  push_object(lua, kMaskKind, Handle{add_mask(lua, combined_mask(Runtime::of(lua), kind, a, b))});
  return 1;
}

// fx.mask.NAME{…}; upvalue: index of its script.
int make_mask(lua_State* lua) {
  Runtime& runtime = Runtime::of(lua);
  const int index = static_cast<int>(lua_tointeger(lua, lua_upvalueindex(1)));
  const EffectSchema& schema = runtime.effects[static_cast<std::size_t>(index)].schema;
  try {
    TableReader table(lua, 1, "fx.mask." + schema.name);
    DeclaredMask mask{.kind = Kind::named, .named = new_entry(runtime, index)};
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
      made = add_mask(lua, combined_mask(runtime, Kind::subtract, one, made));
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

std::string MaskNames::next(const std::string& mask) {
  const int number = ++met_[mask];
  return number == 1 ? "mask." + mask : fmt::format("mask.{}#{}", mask, number);
}

int make_number_mask(Runtime& runtime, double number) {
  runtime.masks.push_back(number_mask(number));
  return static_cast<int>(runtime.masks.size()) - 1;
}

std::vector<std::string> mask_setting_names(const Runtime& runtime, int mask) {
  std::vector<std::string> out;
  MaskNames names;
  visit_parts(runtime, mask, names, [&](const std::string& name, int part) {
    const auto effect = static_cast<std::size_t>(runtime.masks[static_cast<std::size_t>(part)].named.effect);
    for (const auto& setting : runtime.effects[effect].schema.settings) out.push_back(name + "." + setting.name);
  });
  return out;
}

DeclaredEntry* own_mask_part(Runtime& runtime, int& mask, const std::string& part) {
  int copy = copy_mask(runtime, mask), found = -1;
  MaskNames names;
  visit_parts(runtime, copy, names, [&](const std::string& name, int at) {
    if (name == part) found = at;
  });
  if (found < 0) return nullptr;
  mask = copy;
  return &runtime.masks[static_cast<std::size_t>(found)].named;
}

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
