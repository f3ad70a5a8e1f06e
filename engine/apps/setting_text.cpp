// SPDX-License-Identifier: MIT
#include "apps/setting_text.h"

#include <fmt/format.h>

#include "core/text.h"

namespace afterglow {

std::string allowed_text(const SettingSchema& setting) {
  const std::string unit = setting.unit.empty() ? "" : " " + setting.unit;
  if (setting.type == SettingType::boolean) return "true, false";
  if (setting.type == SettingType::enumeration) return join(setting.choices);
  if (setting.type == SettingType::text) return "a text";
  if (setting.type == SettingType::file) return "." + join(setting.choices, ", .");
  if (setting.min && setting.max)
    return fmt::format("{} to {}{}", number_text(*setting.min), number_text(*setting.max), unit);
  if (setting.min) return fmt::format("at least {}{}", number_text(*setting.min), unit);
  if (setting.max) return fmt::format("at most {}{}", number_text(*setting.max), unit);
  return "any" + unit;
}

std::string composition_text(const StackEntry& entry) {
  std::string out;
  if (entry.opacity != 1) out += ", opacity " + number_text(entry.opacity);
  if (entry.blend != "normal") out += ", blend " + entry.blend;
  if (entry.mask) out += ", mask " + entry.mask->text();
  return out;
}

bool is_said(const SettingHistory& setting) {
  return setting.preset || setting.overridden || setting.name.starts_with("mask.");
}

}  // namespace afterglow
