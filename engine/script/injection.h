// Injection points, auxiliary inputs, names that are taken: the words that presets and effects may use.
#pragma once

#include <string>
#include <vector>

namespace afterglow::script {

/// In the order of execution.
inline const std::vector<std::string>& injection_points() {
  static const std::vector<std::string> points{"after_opaque_and_sky", "before_post_process", "post_process",
                                               "after_post_process"};
  return points;
}

/// Images besides the picture that an effect may ask for.
inline const std::vector<std::string>& auxiliary_inputs() {
  static const std::vector<std::string> inputs{"depth", "normal", "motion"};
  return inputs;
}

/// Keys of an entry besides settings; no setting may have such a name.
inline const std::vector<std::string>& entry_keys() {
  static const std::vector<std::string> keys{"at", "enabled", "name", "order", "required"};
  return keys;
}

/// What `fx` itself holds; an effect of such a name could never be reached.
inline const std::vector<std::string>& library_names() {
  static const std::vector<std::string> names{"bool", "color", "curve", "effect", "enum", "extend", "filters",
                                              "file", "float", "int",   "stack",  "vec2", "vec3",   "volume"};
  return names;
}

}  // namespace afterglow::script
