// SPDX-License-Identifier: MIT
// Random opacities, blend modes, masks and groups.
#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "script/schema.h"
#include "stress/auxiliary.h"
#include "stress/settings.h"

namespace afterglow::stress {
namespace {

std::string random_part(const std::vector<EffectSchema>& masks, Random& random) {
  const EffectSchema& mask = random.pick(masks);
  std::vector<std::string> keys;
  for (const auto& setting : mask.settings) {
    if (setting.name == "layer") {  // the one that the pictures have
      keys.push_back(fmt::format("layer = \"{}\"", std::string(kMatte).substr(6)));
    } else if (setting.type != SettingType::file && setting.type != SettingType::text && random.chance(0.6)) {
      keys.push_back(fmt::format("{} = {}", setting.name, random_value(setting, random).text()));
    }
  }
  if (random.chance(0.3)) keys.emplace_back("invert = true");
  return fmt::format("fx.mask.{} {{ {} }}", mask.name, join(keys));
}

std::string random_mask(const std::vector<EffectSchema>& masks, Random& random, int depth = 0) {
  if (random.chance(0.1)) return number_text(random.between(-0.5, 1.5));
  if (depth > 2 || random.chance(0.6)) return random_part(masks, random);
  static const std::vector<std::string> kOperators{"+", "-", "*"};
  const std::string a = random_mask(masks, random, depth + 1), b = random_mask(masks, random, depth + 1);
  return fmt::format("({}) {} ({})", a, random.pick(kOperators), b);
}

}  // namespace

void compose(LookEntry& entry, const std::vector<EffectSchema>& masks, Random& random) {
  const auto has = [&](const char* key) {  // a setting of the effect's own stands for the key
    return std::ranges::any_of(entry.settings, [&](const auto& setting) { return setting.first == key; });
  };
  while (entry.composition.empty()) {
    if (!has("opacity") && random.chance(0.5))
      entry.composition.emplace_back("opacity", random.chance(0.1) ? "0" : number_text(random.unit()));
    if (!has("blend") && random.chance(0.5))
      entry.composition.emplace_back("blend",
                                     fmt::format("\"{}\"", random.pick(script::entry_key_schema("blend").choices)));
    if (!masks.empty() && random.chance(0.6)) entry.composition.emplace_back("mask", random_mask(masks, random));
  }
}

std::vector<LookEntry> random_composition(const std::vector<EffectSchema>& effects,
                                          const std::vector<EffectSchema>& masks, const SearchPath& path,
                                          Random& random) {
  std::vector<LookEntry> out;
  const int count = random.chance(0.5) ? 1 : random.between(2, 4);  // one: most often its error is promised
  int depth = 0;
  for (int i = 0; i < count; ++i) {
    if (depth < 2 && random.chance(0.3)) {
      out.push_back({.effect = kGroup, .settings = {}, .at = {}});
      out.back().depth = depth++;
      if (random.chance(0.8)) compose(out.back(), masks, random);
    }
    const EffectSchema& effect = random.pick(effects);
    out.push_back(random_entry(effect, path, random));
    out.back().depth = depth;
    const bool own_keys = std::ranges::any_of(
        effect.settings, [](const SettingSchema& s) { return s.name == "blend" || s.name == "opacity"; });
    if (!own_keys && random.chance(0.6)) compose(out.back(), masks, random);
    if (depth > 0 && random.chance(0.4)) --depth;
  }
  return out;
}

}  // namespace afterglow::stress
