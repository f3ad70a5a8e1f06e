// SPDX-License-Identifier: MIT
#include "script/unread.h"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>

#include "core/ascii.h"
#include "script/native.h"

namespace afterglow::script {
namespace {

// __index of a view; upvalues: the settings, the names that were read.
int noted_index(lua_State* lua) {
  if (lua_type(lua, 2) == LUA_TSTRING) {
    lua_pushvalue(lua, 2);
    lua_pushboolean(lua, 1);
    lua_rawset(lua, lua_upvalueindex(2));
  }
  lua_settop(lua, 2);
  lua_gettable(lua, lua_upvalueindex(1));
  return 1;
}

bool was_read(lua_State* lua, const EntryRun& run, const std::string& setting) {
  if (run.reads_ref == LUA_NOREF) return true;
  lua_rawgeti(lua, LUA_REGISTRYINDEX, run.reads_ref);
  lua_pushlstring(lua, setting.data(), setting.size());
  lua_rawget(lua, -2);
  const bool read = !lua_isnil(lua, -1);
  lua_pop(lua, 2);
  return read;
}

/// How often a word stands in a script, its texts included and its comments left out.
int count_word(std::string_view text, std::string_view word) {
  int count = 0;
  for (std::size_t i = 0; i < text.size();) {
    if (text.substr(i).starts_with("--")) {
      const bool is_long = text.substr(i).starts_with("--[[");
      const std::size_t end = text.find(is_long ? "]]" : "\n", i);
      i = end == std::string_view::npos ? text.size() : end + 1;
    } else if (is_name_char(text[i])) {
      std::size_t end = i;
      while (end < text.size() && is_name_char(text[end])) ++end;
      count += text.substr(i, end - i) == word;
      i = end;
    } else {
      ++i;
    }
  }
  return count;
}

/// Texts that may read the effect's settings: its own, and those of modules.
std::vector<std::string_view> readers(const Runtime& runtime, const std::filesystem::path& effect) {
  std::vector<std::string_view> out;
  for (const Source& source : runtime.box->sources())
    if (source.path == effect.string() ||
        std::ranges::find(runtime.modules, std::filesystem::path(source.path)) != runtime.modules.end())
      out.push_back(source.text);
  return out;
}

int mentions(const std::vector<std::string_view>& texts, std::string_view word) {
  int count = 0;
  for (const std::string_view text : texts) count += count_word(text, word);
  return count;
}

}  // namespace

void note_reads(lua_State* lua, EntryRun& run) {
  if (run.reads_ref == LUA_NOREF) {
    lua_createtable(lua, 0, 0);
    run.reads_ref = luaL_ref(lua, LUA_REGISTRYINDEX);
  }
  lua_getmetatable(lua, -1);
  lua_getfield(lua, -1, "__index");
  lua_rawgeti(lua, LUA_REGISTRYINDEX, run.reads_ref);
  lua_pushcclosure(lua, (&native<noted_index, "">), 2);
  lua_setfield(lua, -2, "__index");
  lua_pop(lua, 1);
}

std::vector<UnreadSetting> unread_settings(lua_State* lua, const std::vector<EntryRun>& runs, const Graph& graph) {
  const Runtime& runtime = Runtime::of(lua);
  std::vector<UnreadSetting> out;
  std::set<int> seen;
  for (const EntryRun& run : runs) {
    const Effect& effect = runtime.effects[static_cast<std::size_t>(run.effect)];
    const bool ran = std::ranges::find(graph.skipped, run.entry.name, &Skipped::name) == graph.skipped.end();
    if (effect.is_group() || !ran || !seen.insert(run.effect).second) continue;
    const auto texts = readers(runtime, effect.schema.file);
    if (mentions(texts, "pairs") > 0) continue;  // it may read all of them without a name
    for (const SettingSchema& setting : effect.schema.settings)
      if (!was_read(lua, run, setting.name) && mentions(texts, setting.name) < 2)
        out.push_back({effect.schema.name, setting.name});
  }
  return out;
}

}  // namespace afterglow::script
