// SPDX-License-Identifier: MIT
// Every effect and mask on the search path.
#include <fmt/format.h>

#include "script/preset.h"
#include "script/runtime.h"

namespace afterglow {

using namespace script;

namespace {

Result<std::vector<EffectSchema>> list_scripts(const SearchPath& path, Diagnostics& diagnostics, ScriptKind kind) {
  std::vector<EffectSchema> schemas;
  for (const auto& name : effect_names(path, kind)) {
    // A state each: an effect that spends its budget or memory takes nothing from the others.
    AFTERGLOW_TRY(const std::unique_ptr<Runtime> runtime, Runtime::create(path, ScriptLimits{}, diagnostics));
    int index = -1;
    const auto error = runtime->box->run(name + ".lua", [&](lua_State* lua) { index = find_effect(lua, name, kind); });
    if (error)
      diagnostics.warn(
          fmt::format("{} '{}' is left out: {}", kind == ScriptKind::mask ? "mask" : "effect", name, error->text()));
    else
      schemas.push_back(runtime->effects[static_cast<std::size_t>(index)].schema);
  }
  return schemas;
}

}  // namespace

Result<std::vector<EffectSchema>> list_effects(const SearchPath& path, Diagnostics& diagnostics) {
  return list_scripts(path, diagnostics, ScriptKind::effect);
}

Result<std::vector<EffectSchema>> list_masks(const SearchPath& path, Diagnostics& diagnostics) {
  return list_scripts(path, diagnostics, ScriptKind::mask);
}

}  // namespace afterglow
