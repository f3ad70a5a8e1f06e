// SPDX-License-Identifier: MIT
// The presets that can be opened beside the one that is played.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "script/preset.h"

namespace afterglow {

struct ListedPreset {
  std::string name;
  std::filesystem::path file;
  std::string story;  ///< the first sentence of the comment at the file's beginning; or empty
};

inline constexpr std::size_t kMostListedPresets = 500;

/// Those of the search path of `preset` (its own folder, --path, AFTERGLOW_PATH, packs, the installation), by name, and
/// no more than kMostListedPresets. Of several with one name the one that `afterglow run NAME` would take. Their
/// scripts are not run: a file that is no preset is listed too.
std::vector<ListedPreset> list_presets(const std::filesystem::path& preset, const PresetOptions& options);

/// The first sentence of the comment that a script begins with; its licence line does not count.
std::string story_of(std::string_view text);

/// Every word of a search in the name or the story; those whose name begins with the search come first.
std::vector<const ListedPreset*> found_presets(const std::vector<ListedPreset>& all, const std::string& search);

}  // namespace afterglow
