// SPDX-License-Identifier: MIT
#include "window/kept_preset.h"

#include "core/pack.h"
#include "core/paths.h"

namespace afterglow {
namespace fs = std::filesystem;

std::string keeper_of(const fs::path& preset) {
  if (const std::string pack = pack_of(preset, cache_folder()); !pack.empty()) return "the pack " + pack;
  return is_of_installation(preset) ? "the installation" : "";
}

fs::path folder_for_copies(const fs::path& preset) {
  std::error_code ec;
  return keeper_of(preset).empty() ? preset.parent_path() : fs::current_path(ec);
}

}  // namespace afterglow
