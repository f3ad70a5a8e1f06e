// SPDX-License-Identifier: MIT
#include "script/ocio_variables.h"

#include <algorithm>

#include "core/ascii.h"

namespace afterglow::script {
namespace {

/// The name that stands from there on; empty: none.
std::string name_at(const std::string& text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && is_name_char(text[end])) ++end;
  return text.substr(at, end - at);
}

}  // namespace

std::set<std::string> ocio_variables(const std::string& config) {
  std::set<std::string> names{"OCIO_ACTIVE_DISPLAYS", "OCIO_ACTIVE_VIEWS", "OCIO_INACTIVE_COLORSPACES",
                              "OCIO_OPTIMIZATION_FLAGS"};
  for (std::size_t at = config.find_first_of("$%"); at != std::string::npos; at = config.find_first_of("$%", at + 1)) {
    const bool braces = config[at] == '$' && config.compare(at + 1, 1, "{") == 0;
    const std::string name = name_at(config, at + (braces ? 2 : 1));
    const bool closed = config[at] == '$' || config.compare(at + 1 + name.size(), 1, "%") == 0;
    if (!name.empty() && closed) names.insert(name);
  }
  return names;
}

}  // namespace afterglow::script
