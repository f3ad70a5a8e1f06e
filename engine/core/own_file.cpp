// SPDX-License-Identifier: MIT
#include "core/own_file.h"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <system_error>

namespace afterglow {
namespace fs = std::filesystem;

namespace {

fs::path find_own_file() {
  Dl_info info{};
  link_map* map = nullptr;
  const auto* here = reinterpret_cast<const void*>(&own_file);
  std::error_code ec;
  fs::path file = "/proc/self/exe";  // a program has no name in its own map
  if (dladdr1(here, &info, reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP) && map && map->l_name && *map->l_name)
    file = map->l_name;
  file = fs::canonical(file, ec);
  return ec ? fs::path() : file;
}

}  // namespace

fs::path own_file() {
  static const fs::path found = find_own_file();
  return found;
}

bool is_in_build_folder() {
  const fs::path build = AFTERGLOW_BUILD_FOLDER, own = own_file();
  return !build.empty() && std::mismatch(build.begin(), build.end(), own.begin(), own.end()).first == build.end();
}

}  // namespace afterglow
