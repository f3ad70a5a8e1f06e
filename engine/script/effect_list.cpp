// SPDX-License-Identifier: MIT
// Every effect and mask on the search path.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "core/ascii.h"
#include "core/file.h"
#include "script/injection.h"
#include "script/preset.h"
#include "script/runtime.h"

namespace afterglow {

using namespace script;
namespace fs = std::filesystem;

namespace {

Result<EffectSchema> load(Runtime& runtime, const std::string& name, ScriptKind kind) {
  int index = -1;
  auto error = runtime.box->run(name + ".lua", [&](lua_State* lua) { index = find_effect(lua, name, kind); });
  if (error) return *std::move(error);
  return runtime.effects[static_cast<std::size_t>(index)].schema;
}

/// Files that no stack can name.
void warn_unreachable(const SearchPath& path, Diagnostics& diagnostics, ScriptKind kind) {
  const std::string what = kind == ScriptKind::mask ? "mask" : "effect";
  for (const auto& folder : path.script_folders(what + "s"))
    for (const auto& file : names_in(folder)) {
      const fs::path name(file);
      if (name.extension() != ".lua") continue;
      if (!is_identifier(name.stem().string()))
        diagnostics.warn(fmt::format("{} is left out: the name of {} {} has letters, digits and '_' alone",
                                     (folder / name).string(), kind == ScriptKind::mask ? "a" : "an", what));
      else if (kind == ScriptKind::effect && std::ranges::count(library_names(), name.stem().string()) > 0)
        diagnostics.warn(fmt::format("{} is left out: fx.{} is a name of the library", (folder / name).string(),
                                     name.stem().string()));
    }
}

Result<std::vector<EffectSchema>> list_scripts(const SearchPath& path, Diagnostics& diagnostics, ScriptKind kind) {
  std::vector<EffectSchema> schemas;
  warn_unreachable(path, diagnostics, kind);
  for (const auto& name : effect_names(path, kind)) {
    if (kind == ScriptKind::effect && std::ranges::count(library_names(), name) > 0) continue;
    // A state each: an effect that spends its budget or memory takes nothing from the others.
    AFTERGLOW_TRY(const std::unique_ptr<Runtime> runtime, Runtime::create(path, ScriptLimits{}, diagnostics));
    if (auto schema = load(*runtime, name, kind))
      schemas.push_back(std::move(schema).value());
    else
      diagnostics.warn(fmt::format("{} '{}' is left out: {}", kind == ScriptKind::mask ? "mask" : "effect", name,
                                   schema.error().text()));
  }
  return schemas;
}

}  // namespace

Result<std::vector<EffectSchema>> list_effects(const SearchPath& path, Diagnostics& diagnostics) {
  return list_scripts(path, diagnostics, ScriptKind::effect);
}

std::optional<Error> effect_error(const SearchPath& path, const std::string& name) {
  constexpr std::string_view kOfMasks = "mask.";
  const bool mask = name.starts_with(kOfMasks);
  const ScriptKind kind = mask ? ScriptKind::mask : ScriptKind::effect;
  const std::string own = mask ? name.substr(kOfMasks.size()) : name;
  const auto known = effect_names(path, kind);
  if (std::ranges::find(known, own) == known.end()) return std::nullopt;
  Diagnostics silent;
  auto runtime = Runtime::create(path, ScriptLimits{}, silent);
  if (!runtime) return std::move(runtime).error();
  auto schema = load(**runtime, own, kind);
  return schema ? std::nullopt : std::optional(std::move(schema).error());
}

Result<std::vector<EffectSchema>> list_masks(const SearchPath& path, Diagnostics& diagnostics) {
  return list_scripts(path, diagnostics, ScriptKind::mask);
}

}  // namespace afterglow
