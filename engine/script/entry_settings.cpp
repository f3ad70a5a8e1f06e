// SPDX-License-Identifier: MIT
// The settings of an entry by name: those of its effect, of how it is put over what it was given, of its mask's parts.
#include <fmt/format.h>

#include <algorithm>

#include "script/explanation.h"
#include "script/overrides.h"

namespace afterglow {

using namespace script;

std::string EntryMask::text() const {
  const auto operand = [](const EntryMask& mask) {
    const bool simple = mask.kind == Kind::named || mask.kind == Kind::number;
    return simple ? mask.text() : "(" + mask.text() + ")";
  };
  switch (kind) {
    case Kind::named:
      return name;
    case Kind::number:
      return fmt::format("{:.6g}", number);
    case Kind::add:
      return operand(*a) + " + " + operand(*b);
    case Kind::subtract:
      return operand(*a) + " - " + operand(*b);
    case Kind::multiply:
      return operand(*a) + " * " + operand(*b);
  }
  return {};
}

std::vector<const EntryMask*> EntryMask::parts() const {
  if (kind == Kind::named) return {this};
  std::vector<const EntryMask*> out;
  for (const auto& side : {a, b}) {
    if (!side) continue;
    const auto more = side->parts();
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

const SettingHistory* EntryHistory::find(const std::string& setting) const {
  for (const auto* list : {&settings, &composition})
    for (const auto& history : *list)
      if (history.name == setting) return &history;
  return nullptr;
}

std::optional<SettingSchema> Preset::setting_schema(const StackEntry& entry, const std::string& setting) const {
  const auto of = [](const EffectSchema& schema, const std::string& name) -> std::optional<SettingSchema> {
    const auto found = std::ranges::find(schema.settings, name, &SettingSchema::name);
    return found == schema.settings.end() ? std::nullopt : std::optional(*found);
  };
  if (auto own = of(schema(entry.effect), setting)) return own;
  if (std::ranges::find(settable_keys(), setting) != settable_keys().end()) return entry_key_schema(setting);
  const auto [part, name] = split_mask_setting(setting);
  if (entry.mask && !part.empty())
    for (const EntryMask* mask : entry.mask->parts())
      if (mask->part == part) return of(schema("mask " + mask->name), name);
  return {};
}

std::vector<std::string> Preset::setting_names(const StackEntry& entry) const {
  std::vector<std::string> names;
  for (const auto& [name, value] : entry.settings) names.push_back(name);
  for (const auto& key : settable_keys())
    if (std::ranges::find(names, key) == names.end()) names.push_back(key);
  if (entry.mask)
    for (const EntryMask* mask : entry.mask->parts())
      for (const auto& [name, value] : mask->settings) names.push_back(mask->part + "." + name);
  return names;
}

}  // namespace afterglow
