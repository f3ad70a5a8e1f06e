// SPDX-License-Identifier: MIT
#include "core/user_folders.h"

#include <cstdlib>

namespace afterglow {
namespace fs = std::filesystem;
namespace {

fs::path absolute_path_in(const char* variable) {
  const char* value = std::getenv(variable);
  const fs::path path = value ? value : "";
  return path.is_absolute() ? path : fs::path();  // the specification ignores relative ones
}

fs::path user_folder(const char* variable, const fs::path& below_home) {
  if (const fs::path given = absolute_path_in(variable); !given.empty()) return given / "afterglow";
  const fs::path home = absolute_path_in("HOME");
  return home.empty() ? fs::path() : home / below_home / "afterglow";
}

}  // namespace

fs::path config_folder() { return user_folder("XDG_CONFIG_HOME", ".config"); }
fs::path user_cache_folder() { return user_folder("XDG_CACHE_HOME", ".cache"); }
fs::path state_folder() { return user_folder("XDG_STATE_HOME", ".local/state"); }

}  // namespace afterglow
