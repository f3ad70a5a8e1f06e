// SPDX-License-Identifier: MIT
#include <algorithm>
#include <nlohmann/json.hpp>

#include "script/explanation.h"

namespace afterglow {

const char* type_text(SettingType type) {
  switch (type) {
    case SettingType::integer:
      return "int";
    case SettingType::number:
      return "float";
    case SettingType::boolean:
      return "bool";
    case SettingType::enumeration:
      return "enum";
    case SettingType::color:
      return "color";
    case SettingType::vec2:
      return "vec2";
    case SettingType::vec3:
      return "vec3";
    case SettingType::file:
      return "file";
    case SettingType::text:
      return "text";
  }
  return "?";
}

nlohmann::json value_json(const SettingValue& value) {
  switch (value.type) {
    case SettingType::integer:
      return static_cast<long long>(value.number[0]);
    case SettingType::number:
      return value.number[0];
    case SettingType::boolean:
      return value.number[0] != 0;
    case SettingType::enumeration:
    case SettingType::file:
    case SettingType::text:
      return value.choice;
    case SettingType::vec2:
      return {value.number[0], value.number[1]};
    case SettingType::color:
    case SettingType::vec3:
      return {value.number[0], value.number[1], value.number[2]};
  }
  return nullptr;
}

nlohmann::json setting_json(const SettingSchema& setting) {
  nlohmann::json out{{"name", setting.name},
                     {"type", type_text(setting.type)},
                     {"default", value_json(setting.default_value)},
                     {"doc", setting.doc}};
  if (setting.min) out["min"] = *setting.min;
  if (setting.max) out["max"] = *setting.max;
  if (!setting.choices.empty()) out[setting.type == SettingType::file ? "extensions" : "choices"] = setting.choices;
  if (!setting.unit.empty()) out["unit"] = setting.unit;
  return out;
}

nlohmann::ordered_json history_json(const SettingHistory& setting) {
  nlohmann::ordered_json out{{"name", setting.name}, {"default", value_json(setting.default_value)}};
  if (setting.preset) out["preset"] = {{"value", value_json(*setting.preset)}, {"kind", setting.kind}};
  if (setting.preset && setting.place) {
    out["preset"]["file"] = setting.place->file;
    out["preset"]["line"] = setting.place->line;
  }
  out["volumes"] = nlohmann::ordered_json::array();
  for (const auto& step : setting.volumes)
    out["volumes"].push_back({{"volume", step.volume},
                              {"factor", step.factor},
                              {"value", value_json(step.value)},
                              {"result", value_json(step.result)}});
  if (setting.overridden) out["override"] = value_json(*setting.overridden);
  out["final"] = value_json(setting.value);
  return out;
}

void add_composition(nlohmann::ordered_json& entry, const StackEntry& of, const EntryHistory& history) {
  entry["opacity"] = of.opacity;
  entry["blend"] = of.blend;
  if (of.mask) entry["mask"] = of.mask->text();
  entry["composition"] = nlohmann::ordered_json::array();
  for (const auto& setting : history.composition) entry["composition"].push_back(history_json(setting));
}

namespace {

nlohmann::ordered_json volume_json(const VolumeState& volume) {
  nlohmann::ordered_json out{{"name", volume.name},         {"file", volume.file},     {"line", volume.line},
                             {"priority", volume.priority}, {"weight", volume.weight}, {"factor", volume.factor}};
  if (volume.distance) out["distance"] = *volume.distance;
  if (!volume.reason.empty()) out["reason"] = volume.reason;
  return out;
}

}  // namespace

void add_volumes(nlohmann::ordered_json& frame, const Explanation& of) {
  if (of.position) frame["position"] = {{"at", *of.position}, {"from", of.position_from}};
  frame["volumes"] = nlohmann::ordered_json::array();
  for (const auto& volume : of.volumes) frame["volumes"].push_back(volume_json(volume));
}

nlohmann::ordered_json entry_json(const StackEntry& entry, const std::vector<Skipped>& skipped) {
  nlohmann::ordered_json out{{"name", entry.name}, {"effect", entry.effect}};
  const auto found = std::ranges::find(skipped, entry.name, &Skipped::name);
  out["state"] = found == skipped.end() ? "runs" : "skipped";
  if (found != skipped.end()) out["reason"] = found->reason;
  return out;
}

}  // namespace afterglow
