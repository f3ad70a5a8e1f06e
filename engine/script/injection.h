// SPDX-License-Identifier: MIT
// Injection points, auxiliary inputs, names that are taken: the words that presets and effects may use.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace afterglow::script {

/// In the order of execution.
inline const std::vector<std::string>& injection_points() {
  static const std::vector<std::string> points{"after_opaque_and_sky", "before_post_process", "post_process",
                                               "after_post_process"};
  return points;
}

/// A layer of the picture, by its name: "layer:albedo".
inline constexpr std::string_view kLayerPrefix = "layer:";

/// Images besides the picture that an effect may ask for; layers by name too.
inline const std::vector<std::string>& auxiliary_inputs() {
  static const std::vector<std::string> inputs{"depth", "normal", "motion"};
  return inputs;
}

/// How an entry's result is put over what it was given (math.md §20).
inline const std::vector<std::string>& blend_modes() {
  static const std::vector<std::string> modes{"normal",  "add",    "screen",     "multiply", "overlay",   "soft_light",
                                              "lighten", "darken", "hard_light", "color",    "luminosity"};
  return modes;
}

/// Keys of an entry besides settings; no setting may have such a name, but for those below.
inline const std::vector<std::string>& entry_keys() {
  static const std::vector<std::string> keys{"at", "blend", "enabled", "mask", "name", "opacity", "order", "required"};
  return keys;
}

/// Keys of an entry that an effect may have as settings of its own: its entries then have no others.
inline const std::vector<std::string>& replaceable_keys() {
  static const std::vector<std::string> keys{"blend", "opacity"};
  return keys;
}

/// What `fx` itself holds; an effect of such a name could never be reached.
inline const std::vector<std::string>& library_names() {
  static const std::vector<std::string> names{"args",  "bool",    "color", "curve", "effect", "enum", "extend",
                                              "file",  "filters", "float", "group", "int",    "mask", "mix",
                                              "stack", "text",    "vec2",  "vec3",  "volume"};
  return names;
}

}  // namespace afterglow::script
