// The completion file of lua-language-server for effects: one class of settings each, and `fx.NAME` as a function.
#include <fmt/format.h>

#include "core/text.h"
#include "script/preset.h"
#include "script/script_error.h"
#include "script/setting.h"

namespace afterglow {
namespace {

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
  std::string out;
  for (const auto& choice : setting.choices) out += (out.empty() ? "\"" : "|\"") + choice + '"';
  return out + "|afterglow.OfTime";
}

// Docs are one line each in the file.
std::string one_line(const std::string& doc) { return script::tidy_message(doc, 1000); }

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

std::string settings_class(const EffectSchema& effect) {
  std::string out;
  if (!effect.doc.empty()) out += fmt::format("---{}\n", one_line(effect.doc));
  out += fmt::format("---@class afterglow.settings.{} : afterglow.EntryKeys\n", effect.name);
  for (const auto& setting : effect.settings)
    out += fmt::format("---@field {}? {}  {}\n", setting.name, lua_type(setting), setting_doc(setting));
  return out;
}

}  // namespace

std::string completion_text(const std::vector<EffectSchema>& effects) {
  std::string out =
      "---@meta _\n"
      "-- Generated from the effects, not to be edited: AFTERGLOW_UPDATE=1 ctest -R Completion.FileIsUpToDate\n"
      "\n"
      "---Keys that every effect of a stack takes besides its settings.\n"
      "---@class afterglow.EntryKeys\n"
      "---@field at? \"after_opaque_and_sky\"|\"before_post_process\"|\"post_process\"|\"after_post_process\"  "
      "injection point\n"
      "---@field order? integer     place among the effects of the injection point, smaller first\n"
      "---@field enabled? boolean   false: left out, default true\n"
      "---@field required? boolean  true: a missing input (depth, normal) is an error, default false\n"
      "---@field name? string       how messages and --set call it, default: the effect's name\n"
      "---@field opacity? number|afterglow.Moving  how much of the result counts, 0…1; at 0 the effect does not run, "
      "default 1\n"
      "---@field blend? \"normal\"|\"add\"|\"screen\"|\"multiply\"|\"overlay\"|\"soft_light\"|\"lighten\"|\"darken\"  "
      "how it "
      "is put over what the effect was given\n"
      "---@field mask? afterglow.Mask|number  where it counts, default everywhere\n";
  for (const auto& effect : effects) out += "\n" + settings_class(effect);
  out += "\n---@class afterglow\n";
  for (const auto& effect : effects)
    out += fmt::format("---@field {0} fun(settings: afterglow.settings.{0}): afterglow.Entry  {1}\n", effect.name,
                       one_line(effect.doc));
  return out;
}

}  // namespace afterglow
