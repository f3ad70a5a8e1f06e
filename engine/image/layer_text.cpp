// SPDX-License-Identifier: MIT
// What channels that were chosen are called.
#include <algorithm>
#include <cstddef>

#include "core/text.h"
#include "image/layers.h"

namespace afterglow {

std::string choice_text(const std::vector<FilePart>& parts, const ChannelChoice& choice) {
  std::vector<std::string> names;
  const FilePart& part = parts[static_cast<std::size_t>(choice.part)];
  std::string layer;
  bool letters = true;
  for (const int channel : choice.channels) {
    if (channel < 0) continue;
    const std::string& full = part.channels[static_cast<std::size_t>(channel)];
    const std::size_t cut = full.rfind('.') + 1;  // 0 without a dot
    if (std::ranges::find(names, full.substr(cut)) != names.end()) continue;
    layer = full.substr(0, cut);
    names.push_back(full.substr(cut));
    letters = letters && names.back().size() == 1;
  }
  const std::string of_part = parts.size() > 1 && !part.name.empty() ? part.name + "." : "";
  return of_part + layer + join(names, letters ? "" : ", ");
}

std::string choice_name(const std::vector<FilePart>& parts, const ChannelChoice& choice) {
  if (choice.channels.size() == 1) return choice_text(parts, choice);
  const FilePart& part = parts[static_cast<std::size_t>(choice.part)];
  const auto used = std::ranges::find_if(choice.channels, [](int channel) { return channel >= 0; });
  const std::string& full = part.channels[static_cast<std::size_t>(*used)];
  const std::size_t dot = full.rfind('.');
  const std::string layer = dot == std::string::npos ? "" : full.substr(0, dot);
  if (parts.size() < 2 || part.name.empty()) return layer;
  return layer.empty() ? part.name : part.name + "." + layer;
}

}  // namespace afterglow
