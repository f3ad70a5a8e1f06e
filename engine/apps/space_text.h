// SPDX-License-Identifier: MIT
// The light in which an entry runs, as `check` and `explain` tell it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "script/preset.h"

namespace afterglow {

/// "scene-linear light", "scene-linear light to display-linear", "scene-linear light to values of another space".
inline std::string space_text(const EntrySpace& space) {
  const auto name = [](LightSpace of) -> std::string {
    return of == LightSpace::other ? "values of another space" : space_name(of);
  };
  std::string out = name(space.before) + (space.before == LightSpace::other ? "" : " light");
  if (space.behind != space.before) out += " to " + name(space.behind);
  return out;
}

/// { "before": "scene-linear", "behind": "display-linear", "needs": "any" }, and "warning" where there is one.
inline nlohmann::ordered_json space_json(const EntrySpace& space) {
  nlohmann::ordered_json out{{"before", space_name(space.before)},
                             {"behind", space_name(space.behind)},
                             {"needs", space_name(space.use.needs)}};
  if (!space.warning.empty()) out["warning"] = space.warning;
  return out;
}

}  // namespace afterglow
