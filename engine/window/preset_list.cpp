// SPDX-License-Identifier: MIT
#include "window/preset_list.h"

#include <algorithm>

#include "core/file.h"
#include "core/paths.h"
#include "core/text.h"

namespace afterglow {

std::string story_of(std::string_view text) {
  std::string out;
  for (const std::string& raw : split(std::string(text.substr(0, 4096)), '\n')) {
    std::string line = trim(raw);
    if (!line.starts_with("--")) break;
    line = trim(line.substr(2));
    if (line.starts_with("SPDX-License-Identifier")) continue;
    if (line.empty() && out.empty()) continue;
    if (line.empty()) break;
    out += (out.empty() ? "" : " ") + line;
    const auto end = out.find(". ");
    if (end != std::string::npos) return out.substr(0, end + 1);
  }
  return out;
}

std::vector<ListedPreset> list_presets(const std::filesystem::path& preset, const PresetOptions& options) {
  const SearchPath path = search_path_for(preset, options.paths, nullptr, options.installation);
  std::vector<ListedPreset> out;
  for (const std::string& name : path.preset_names()) {
    const auto files = path.find_preset(name);
    if (files.empty()) continue;
    if (out.size() == kMostListedPresets) break;
    const auto text = read_file(files.front());
    out.push_back({name, files.front(), text ? story_of(*text) : ""});
  }
  return out;
}

std::vector<const ListedPreset*> found_presets(const std::vector<ListedPreset>& all, const std::string& search) {
  const std::string begin = lower(search);
  const auto words = split(begin, ' ');
  std::vector<const ListedPreset*> out;
  for (const ListedPreset& preset : all) {
    const std::string text = lower(preset.name + " " + preset.story);
    if (std::ranges::all_of(words, [&](const std::string& word) { return text.find(word) != std::string::npos; }))
      out.push_back(&preset);
  }
  std::ranges::stable_sort(out, [&](const ListedPreset* a, const ListedPreset* b) {
    return lower(a->name).starts_with(begin) && !lower(b->name).starts_with(begin);
  });
  return out;
}

}  // namespace afterglow
