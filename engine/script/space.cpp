// SPDX-License-Identifier: MIT
#include "script/space.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/text.h"
#include "script/composite.h"
#include "script/native.h"

namespace afterglow {

const char* space_name(LightSpace space) {
  constexpr const char* kNames[] = {"any", "scene-linear", "display-linear", "other"};
  return kNames[static_cast<std::size_t>(space)];
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
  static const std::vector<std::string> all{"scene", "display", "other"};
  return all;
}

LightSpace space_of(const std::string& what, const Value& given, const KeyPath& place) {
  if (given.kind == Value::Kind::nothing) return LightSpace::any;
  for (std::size_t i = 0; i < space_names().size(); ++i)
    if (given.kind == Value::Kind::text && given.text == space_names()[i])
      return std::array{LightSpace::scene, LightSpace::display, LightSpace::other}[i];
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

namespace {

/// Light on its way through a stack.
struct Light {
  LightSpace space = LightSpace::scene;
  std::string maker{};  ///< of display light, and of values of another space
};

class Tracer {
 public:
  Tracer(lua_State* lua, const std::vector<EntryRun>& runs) : lua_(lua), runs_(runs), out_(runs.size()) {}

  std::vector<EntrySpace> run() {
    forwards(0, runs_.size(), {}, true);
    backwards(0, runs_.size(), {});
    return std::move(out_);
  }

 private:
  /// Light behind the entries from `begin` to `end`. `seen`: what is around them runs.
  Light forwards(std::size_t begin, std::size_t end, Light light, bool seen) {
    for (std::size_t i = begin; i < end; i = runs_[i].entry.end_of(i)) {
      const EntryRun& run = runs_[i];
      EntrySpace& space = out_[i];
      space.use = use_of(lua_, run);
      space.runs = seen && run.entry.enabled && !why_unseen(lua_, run) && !why_inactive(lua_, run);
      space.before = light.space;
      if (run.entry.members > 0)
        light = through_members(i, light);
      else if (space.runs)
        light = through(i, light);
      space.behind = light.space;
    }
    return light;
  }

  static bool comes_back(const EntrySpace& space, const Light& light) {
    return space.use.needs == LightSpace::other && light.space == LightSpace::other;
  }

  Light through(std::size_t i, const Light& light) {
    EntrySpace& space = out_[i];
    if (space.use.needs == LightSpace::scene && light.space == LightSpace::display)
      space.warning = fmt::format("'{}' is made for scene-linear light, but '{}' before it makes display-linear light",
                                  runs_[i].entry.name, light.maker);
    const bool shows = space.use.makes == LightSpace::display;
    if (space.use.needs == LightSpace::scene && light.space == LightSpace::other && shows)
      space.warning =
          fmt::format("'{}' is made for scene-linear light, but '{}' before it makes values of another space",
                      runs_[i].entry.name, light.maker);
    if (const auto& entry = runs_[i].entry; comes_back(space, light) && !entry.overtakes.empty())
      space.warning = fmt::format(
          "'{}' comes back from what '{}' makes before '{}', which is written between them, runs: `order` says when",
          entry.name, light.maker, entry.overtakes);
    return space.use.makes == LightSpace::any ? light : Light{space.use.makes, runs_[i].entry.name};
  }

  Light through_members(std::size_t i, const Light& light) {
    const StackEntry& entry = runs_[i].entry;
    const std::size_t first = entry.first_of(i), middle = entry.middle_of(i), end = entry.end_of(i);
    if (!entry.is_mix()) return forwards(first, end, light, out_[i].runs);
    const double amount = entry.settings.front().second.number[0];
    const bool has_first = amount < 1;
    const bool has_second = amount > 0;
    const Light one = forwards(first, middle, light, out_[i].runs && has_first);
    const Light other = forwards(middle, end, light, out_[i].runs && has_second);
    const bool takes_first = has_first && (!has_second || one.space == LightSpace::display);
    return takes_first ? one : other;
  }

  /// `later`: the entry behind that makes display light. Returns that from `begin` on.
  std::string backwards(std::size_t begin, std::size_t end, std::string later) {
    std::vector<std::size_t> units;
    for (std::size_t i = begin; i < end; i = runs_[i].entry.end_of(i)) units.push_back(i);
    for (auto unit = units.rbegin(); unit != units.rend(); ++unit) {
      const std::size_t i = *unit;
      const StackEntry& entry = runs_[i].entry;
      const std::size_t first = entry.first_of(i), middle = entry.middle_of(i), last = entry.end_of(i);
      if (entry.is_mix()) {
        const std::string other = backwards(middle, last, later), one = backwards(first, middle, later);
        later = one != later ? one : other;
      } else if (entry.members > 0) {
        later = backwards(first, last, later);
      } else if (EntrySpace& space = out_[i]; space.runs) {
        if (space.use.needs == LightSpace::display && space.before == LightSpace::scene && !later.empty())
          space.warning = fmt::format(
              "'{}' is made for display-linear light, but '{}', which makes it, comes behind it", entry.name, later);
        if (space.use.makes == LightSpace::display) later = entry.name;
      }
    }
    return later;
  }

  lua_State* lua_;
  const std::vector<EntryRun>& runs_;
  std::vector<EntrySpace> out_;
};

}  // namespace

std::vector<EntrySpace> trace_spaces(lua_State* lua, const std::vector<EntryRun>& runs) {
  return Tracer(lua, runs).run();
}

}  // namespace script
}  // namespace afterglow
