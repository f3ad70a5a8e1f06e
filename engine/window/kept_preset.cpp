// SPDX-License-Identifier: MIT
#include "window/kept_preset.h"

#include "core/pack.h"
#include "core/paths.h"

namespace afterglow {
namespace fs = std::filesystem;

std::string keeper_of(const fs::path& preset) {
  if (const std::string pack = pack_of(preset, cache_folder()); !pack.empty()) return "the pack " + pack;
  const fs::path installation = find_installation();
  if (installation.empty()) return {};
  std::error_code ec;
  const fs::path inside = fs::weakly_canonical(preset, ec).lexically_relative(fs::weakly_canonical(installation, ec));
  const std::string folder = inside.empty() ? "" : inside.begin()->string();
  return folder == "presets" || folder == "packs" ? "the installation" : "";
}

fs::path folder_for_copies(const fs::path& preset) {
  std::error_code ec;
  return keeper_of(preset).empty() ? preset.parent_path() : fs::current_path(ec);
}

}  // namespace afterglow
