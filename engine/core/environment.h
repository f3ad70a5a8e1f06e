// SPDX-License-Identifier: MIT
// Variables of the environment.
#pragma once

#include <cstdlib>
#include <string>

namespace afterglow {

/// Its value; empty: it is not set.
inline std::string environment(const std::string& name) {
  const char* value = std::getenv(name.c_str());
  return value ? value : "";
}

}  // namespace afterglow
