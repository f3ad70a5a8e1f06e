// SPDX-License-Identifier: MIT
#include "apps/usual_words.h"

#include "core/diagnostics.h"
#include "core/paths.h"
#include "image/input_space.h"
#include "image/video_writer.h"
#include "image/writer.h"
#include "script/preset.h"
#include "shader/library.h"

namespace afterglow {
namespace {

std::vector<std::string> effects() {
  std::vector<std::string> names;
  Diagnostics quiet;
  if (const auto found = list_effects(search_path_for({}, {}), quiet))
    for (const auto& effect : *found) names.push_back(effect.name);
  if (const auto found = list_masks(search_path_for({}, {}), quiet))
    for (const auto& mask : *found) names.push_back("mask." + mask.name);
  return names;
}

std::vector<std::string> output_formats() {
  std::vector<std::string> names{"y4m", "raw"};  // of streams
  for (const auto& extension : picture_extensions()) names.push_back(extension.substr(1));
  return names;
}

std::vector<std::string> settings_of(const Preset& preset) {
  std::vector<std::string> out;
  for (const StackEntry& entry : preset.entries())
    for (const auto& setting : preset.setting_names(entry)) out.push_back(entry.name + "." + setting + "=");
  return out;
}

std::optional<Preset> preset_of(const std::string& word) {
  Diagnostics quiet;
  const auto file = find_preset_file(word, {});
  if (!file) return {};
  ShaderLibrary shaders(search_path_for(*file, {}));
  auto preset = Preset::load(*file, {}, shaders, quiet);
  return preset ? std::optional(std::move(preset).value()) : std::nullopt;
}

}  // namespace

std::vector<std::string> setting_words(const std::vector<std::string>& words) {
  for (const auto& word : words)
    if (const auto preset = preset_of(word)) return settings_of(*preset);
  std::vector<std::string> out;
  Diagnostics quiet;
  if (const auto effects = list_effects(search_path_for({}, {}), quiet))
    for (const auto& effect : *effects)
      for (const auto& setting : effect.settings) out.push_back(effect.name + "." + setting.name + "=");
  return out;
}

std::vector<std::string> usual_words(const std::string& kind) {
  if (kind == "PRESET") return search_path_for({}, {}).preset_names();
  if (kind == "EFFECT") return effects();
  if (kind == "SPACE") return input_space_names();
  if (kind == "EXTENSION") return output_formats();
  if (kind == "CODEC") return video_codecs();
  if (kind == "COMPRESSION") return compression_names();
  return {};
}

}  // namespace afterglow
