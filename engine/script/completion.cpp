// SPDX-License-Identifier: MIT
// The completion file of lua-language-server for effects and masks: one class of settings each, and `fx.NAME` or
// `fx.mask.NAME` as a function.
#include <fmt/format.h>

#include "core/text.h"
#include "script/injection.h"
#include "script/preset.h"
#include "script/script_error.h"
#include "script/setting.h"

namespace afterglow {
namespace {

// "normal"|"add"|…
std::string one_of(const std::vector<std::string>& choices) {
  std::string out;
  for (const auto& choice : choices) out += (out.empty() ? "\"" : "|\"") + choice + '"';
  return out;
}

std::string lua_type(const SettingSchema& setting) {
  switch (setting.type) {
    case SettingType::integer:
      return "integer|afterglow.Moving";
    case SettingType::number:
      return "number|afterglow.Moving";
    case SettingType::boolean:
      return "boolean|afterglow.OfTime";
    case SettingType::color:
      return "number[]|string|afterglow.Moving";
    case SettingType::vec2:
    case SettingType::vec3:
      return "number[]|afterglow.Moving";
    case SettingType::file:
    case SettingType::text:
      return "string|afterglow.OfTime";
    case SettingType::enumeration:
      break;
  }
  return one_of(setting.choices) + "|afterglow.OfTime";
}

// Docs are one line each in the file.
std::string one_line(const std::string& doc) { return tidy_message(doc, 1000); }

// "How much is added. 0…1 EV, default 0.2"
std::string setting_doc(const SettingSchema& setting) {
  std::string out = one_line(setting.doc);
  if (!out.empty()) out += ' ';
  if (setting.type != SettingType::boolean && setting.type != SettingType::enumeration && (setting.min || setting.max))
    out += script::allowed_text(setting) + (setting.unit.empty() ? "" : " " + setting.unit) + ", ";
  else if (!setting.unit.empty())
    out += setting.unit + ", ";
  return out + "default " + setting.default_value.text();
}

std::string settings_class(const EffectSchema& effect, const char* folder, const char* base) {
  std::string out;
  if (!effect.doc.empty()) out += fmt::format("---{}\n", one_line(effect.doc));
  out += fmt::format("---@class afterglow.{}.{} : afterglow.{}\n", folder, effect.name, base);
  for (const auto& setting : effect.settings)
    out += fmt::format("---@field {}? {}  {}\n", setting.name, lua_type(setting), setting_doc(setting));
  return out;
}

}  // namespace

std::string completion_text(const std::vector<EffectSchema>& effects, const std::vector<EffectSchema>& masks) {
  std::string out = fmt::format(
      "---@meta _\n"
      "-- SPDX-License-Identifier: MIT\n"
      "-- Generated from effects and masks, not to be edited: AFTERGLOW_UPDATE=1 ctest -R Completion.FileIsUpToDate\n"
      "\n"
      "---@alias afterglow.Blend {}\n"
      "\n"
      "---Keys that every effect of a stack takes besides its settings.\n"
      "---@class afterglow.EntryKeys\n"
      "---@field at? {}  injection point\n"
      "---@field order? integer     place among the effects of the injection point, smaller first\n"
      "---@field enabled? boolean   false: left out, default true\n"
      "---@field required? boolean  true: a missing input (depth, normal) is an error; false: single frames may lack it\n"
      "---@field name? string       how messages and --set call it, default: the effect's name\n"
      "---@field opacity? number|afterglow.Moving  how much of the result counts, 0…1; at 0 the effect does not run, "
      "default 1\n"
      "---@field blend? afterglow.Blend|afterglow.OfTime  how it is put over what the effect was given, default "
      "\"normal\"\n"
      "---@field mask? afterglow.Mask|number  where it counts, default everywhere\n"
      "\n"
      "---Keys that every mask takes besides its settings.\n"
      "---@class afterglow.MaskKeys\n"
      "---@field invert? boolean  true: what it does not select, default false\n",
      one_of(script::blend_modes()), one_of(script::injection_points()));
  for (const auto& effect : effects) out += "\n" + settings_class(effect, "settings", "EntryKeys");
  for (const auto& mask : masks) out += "\n" + settings_class(mask, "masks", "MaskKeys");
  const auto functions = [&](const std::vector<EffectSchema>& list, const char* folder, const char* made) {
    for (const auto& effect : list)
      out += fmt::format("---@field {0} fun(settings: afterglow.{1}.{0}): afterglow.{2}  {3}\n", effect.name, folder,
                         made, one_line(effect.doc));
  };
  out += "\n---@class afterglow\n";
  functions(effects, "settings", "Entry");
  out += "\n---What `fx.mask` holds; masks of yours are masks/NAME.lua.\n---@class afterglow.Masks\n";
  functions(masks, "masks", "Mask");
  return out;
}

}  // namespace afterglow
