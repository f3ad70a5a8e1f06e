// SPDX-License-Identifier: MIT
#include "script/space.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "script/native.h"

namespace afterglow {

const char* space_name(LightSpace space) {
  return space == LightSpace::scene ? "scene-linear" : space == LightSpace::display ? "display-linear" : "any";
}

bool ends_in_view(const std::vector<EntrySpace>& spaces) {
  const auto last = std::ranges::find_if(spaces.rbegin(), spaces.rend(), [](const EntrySpace& space) {
    return space.runs && space.use.makes != LightSpace::any;
  });
  return last != spaces.rend() && last->use.view;
}

namespace script {
namespace {

const std::vector<std::string>& space_names() {
  static const std::vector<std::string> all{"scene", "display"};
  return all;
}

LightSpace space_of(const std::string& what, const Value& given, const KeyPath& place) {
  if (given.kind == Value::Kind::nothing) return LightSpace::any;
  for (std::size_t i = 0; i < space_names().size(); ++i)
    if (given.kind == Value::Kind::text && given.text == space_names()[i])
      return i == 0 ? LightSpace::scene : LightSpace::display;
  throw failure(fmt::format("{} = {} is no space", what, given.shown()), place, join(space_names()),
                given.kind == Value::Kind::text ? nearest_name(given.text, space_names()) : "");
}

// The use in a table; what is wrong with it is noted there.
SpaceUse use_in(TableReader& table) {
  SpaceUse use;
  table.allow({"makes", "needs", "view"}, false);
  use.view = table.boolean("view").value_or(false);
  for (const auto& [key, space] : {std::pair{"needs", &use.needs}, {"makes", &use.makes}}) {
    try {
      *space = space_of(table.what() + ": " + key, table.value(key), {key});
    } catch (ScriptError& error) {
      table.fail(std::move(error));
    }
  }
  return use;
}

// What a function of an effect returned (popped).
SpaceUse pop_use(lua_State* lua, const std::string& what) {
  SpaceUse use;
  if (lua_istable(lua, -1)) {
    TableReader table(lua, -1, what);
    use = use_in(table);
    table.finish("space");
  } else {
    use.needs = space_of(what, read_value(lua, -1), {});
  }
  lua_pop(lua, 1);
  return use;
}

SpaceUse use_of(lua_State* lua, const EntryRun& run) {
  const Effect& effect = Runtime::of(lua).effects[static_cast<std::size_t>(run.effect)];
  if (!effect.space.set()) return effect.schema.space;
  lua_rawgeti(lua, LUA_REGISTRYINDEX, effect.space.ref);
  lua_rawgeti(lua, LUA_REGISTRYINDEX, run.settings_ref);
  call(lua, 1, 1);
  try {
    return pop_use(lua, fmt::format("space of effect '{}'", effect.schema.name));
  } catch (ScriptError& error) {
    locate_function(lua, effect.space, error.error);
    throw;
  }
}

}  // namespace

void read_space(lua_State* lua, TableReader& table, Effect& effect) {
  table.push("space");
  if (lua_isfunction(lua, -1)) {
    effect.space = {luaL_ref(lua, LUA_REGISTRYINDEX)};
    effect.schema.space_by_settings = true;
    return;
  }
  const std::string what = table.what() + ": space";
  if (lua_istable(lua, -1)) {
    TableReader inner(lua, -1, what, table, {"space"});
    effect.schema.space = use_in(inner);
  } else {
    try {
      effect.schema.space.needs = space_of(what, read_value(lua, -1), {"space"});
    } catch (ScriptError& error) {
      table.fail(std::move(error));
    }
  }
  lua_pop(lua, 1);
}

std::vector<EntrySpace> trace_spaces(lua_State* lua, const std::vector<EntryRun>& runs) {
  std::vector<EntrySpace> out(runs.size());
  std::string maker;  // of display light, once it is made
  LightSpace light = LightSpace::scene;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    out[i].use = use_of(lua, runs[i]);
    out[i].runs = runs[i].entry.enabled && !why_inactive(lua, runs[i]);
    out[i].before = out[i].behind = light;
    if (!out[i].runs) continue;
    if (out[i].use.needs == LightSpace::scene && light == LightSpace::display)
      out[i].warning = fmt::format("'{}' is made for scene-linear light, but '{}' before it makes display-linear light",
                                   runs[i].entry.name, maker);
    if (out[i].use.makes == LightSpace::any) continue;
    light = out[i].behind = out[i].use.makes;
    if (light == LightSpace::display) maker = runs[i].entry.name;
  }
  std::string later;  // the entry behind that makes display light
  for (std::size_t i = runs.size(); i-- > 0;) {
    if (!out[i].runs) continue;
    if (out[i].use.needs == LightSpace::display && out[i].before == LightSpace::scene && !later.empty())
      out[i].warning = fmt::format("'{}' is made for display-linear light, but '{}', which makes it, comes behind it",
                                   runs[i].entry.name, later);
    if (out[i].use.makes == LightSpace::display) later = runs[i].entry.name;
  }
  return out;
}

}  // namespace script
}  // namespace afterglow
