// SPDX-License-Identifier: MIT
#include "api/documents.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "api/words.h"
#include "script/explanation.h"

namespace afterglow::api {
namespace {

using Json = nlohmann::ordered_json;

/// Names of files and texts of scripts are any bytes: what is no UTF-8 becomes U+FFFD.
std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

SettingValue value_of(double number, SettingType type) { return {.type = type, .number = {number}, .choice = {}}; }
SettingValue value_of(const std::string& choice, SettingType type) {
  return {.type = type, .number = {}, .choice = choice};
}

/// A mask that is made of more than a number is a text.
SettingValue value_of(const EntryMask* mask) {
  if (!mask) return value_of(1, SettingType::number);
  if (mask->kind == EntryMask::Kind::number) return value_of(mask->number, SettingType::number);
  return value_of(mask->text(), SettingType::text);
}

}  // namespace

std::optional<SettingValue> entry_value(const StackEntry& entry, const std::string& name) {
  for (const auto& [setting, value] : entry.settings)
    if (setting == name) return value;
  if (name == "enabled") return value_of(entry.enabled ? 1 : 0, SettingType::boolean);
  if (name == "order") return value_of(entry.order, SettingType::integer);
  if (name == "at") return value_of(entry.at, SettingType::enumeration);
  if (name == "opacity") return value_of(entry.opacity, SettingType::number);
  if (name == "blend") return value_of(entry.blend, SettingType::enumeration);
  if (name == "mask") return value_of(entry.mask.get());
  if (!entry.mask) return {};
  for (const EntryMask* part : entry.mask->parts())
    for (const auto& [setting, value] : part->settings)
      if (name == part->part + "." + setting) return value;
  return {};
}

std::string device_document(const Device& device) {
  const DeviceInfo& info = device.info();
  return dumped(Json{{"name", info.name},
                     {"type", info.type},
                     {"driver", info.driver},
                     {"uuid", info.uuid},
                     {"validation_errors", device.validation_errors()},
                     {"validation_messages", device.validation_messages()}});
}

std::string settings_document(Backend& backend) {
  Json out = Json::array();
  for (const auto& entry : backend.entries()) {
    Json item{{"name", entry.name},       {"effect", entry.effect}, {"at", entry.at},    {"order", entry.order},
              {"enabled", entry.enabled}, {"file", entry.file},     {"line", entry.line}};
    item["settings"] = Json::array();
    const EffectSchema& schema = backend.preset().schema(entry.effect);
    for (const auto& declared : schema.settings) {
      Json setting = setting_json(declared);
      const auto found = std::ranges::find(entry.settings, declared.name, [](const auto& pair) { return pair.first; });
      if (found != entry.settings.end()) setting["value"] = value_json(found->second);
      item["settings"].push_back(std::move(setting));
    }
    item["composition"] = Json::array();
    for (const auto& name : backend.preset().setting_names(entry)) {
      if (item.contains(name) ||
          std::ranges::find(schema.settings, name, &SettingSchema::name) != schema.settings.end())
        continue;
      const auto declared = backend.preset().setting_schema(entry, name);
      const auto value = entry_value(entry, name);
      if (!declared || !value) continue;
      Json setting = setting_json(*declared);
      setting["name"] = name;
      setting["value"] = value_json(*value);
      item["composition"].push_back(std::move(setting));
    }
    out.push_back(std::move(item));
  }
  return dumped(out);
}

std::string arguments_document(const Backend& backend) {
  Json out = Json::array();
  for (const auto& argument : backend.preset().arguments()) {
    Json item = setting_json(argument.schema);
    item["value"] = value_json(argument.value);
    item["given"] = argument.given;
    out.push_back(std::move(item));
  }
  return dumped(out);
}

std::string explain_document(Backend& backend) {
  const Explanation& explanation = backend.explanation();
  const std::vector<Skipped> skipped = backend.report().skipped;
  Json out{{"name", backend.preset().name()},
           {"inputs", backend.preset().possible_needs()},
           {"pre_roll", backend.pre_roll()}};
  add_volumes(out, explanation);
  out["entries"] = Json::array();
  const auto& entries = backend.entries();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    Json item = entry_json(entries[i], skipped);
    if (i < explanation.entries.size()) add_composition(item, entries[i], explanation.entries[i]);
    item["settings"] = Json::array();
    if (i < explanation.entries.size())
      for (const auto& setting : explanation.entries[i].settings) item["settings"].push_back(history_json(setting));
    out["entries"].push_back(std::move(item));
  }
  return dumped(out);
}

std::string report_document(const BackendReport& report, std::uint64_t mended) {
  Json out{{"preset", report.preset},
           {"device", report.device},
           {"choice", report.choice},
           {"choice_from", for_hosts(report.choice_from)},
           {"max_error", report.max_error},
           {"kernels", report.kernels},
           {"skipped", Json::array()},
           {"image_memory",
            {{"shared", report.memory.arena}, {"unshared", report.memory.sum}, {"histories", report.memory.histories}}},
           {"clamped_samples", report.clamped},
           {"mended_samples", mended}};
  for (const auto& skipped : report.skipped)
    out["skipped"].push_back({{"name", skipped.name}, {"reason", skipped.reason}});
  Json times{{"script", report.script},         {"compile", report.compile},          {"upload", report.times.upload},
             {"execute", report.times.execute}, {"read_back", report.times.readback}, {"kernels", Json::array()}};
  for (const auto& kernel : report.times.kernels)
    times["kernels"].push_back({{"name", kernel.name}, {"milliseconds", kernel.milliseconds}});
  out["milliseconds"] = std::move(times);
  return dumped(out);
}

}  // namespace afterglow::api
