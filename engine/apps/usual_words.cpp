// SPDX-License-Identifier: MIT
#include "apps/usual_words.h"

#include "core/diagnostics.h"
#include "core/paths.h"
#include "image/input_space.h"
#include "image/video_writer.h"
#include "image/writer.h"
#include "script/preset.h"

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

}  // namespace

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
