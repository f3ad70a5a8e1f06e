// SPDX-License-Identifier: MIT
#include "exec/calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/file.h"
#include "core/paths.h"
#include "core/text.h"

namespace afterglow {
namespace {

using Json = nlohmann::json;

constexpr const char* kShipped = "calibration/devices.json";
constexpr const char* kAnything = "built in: exact everywhere";

bool matches(const std::string& pattern, const std::string& text) {
  if (pattern.ends_with('*')) return text.starts_with(std::string_view(pattern).substr(0, pattern.size() - 1));
  return pattern.empty() || pattern == text;
}

/// A text of an object; empty when it is not there. Nothing when it is something else.
std::optional<std::string> text_of(const Json& object, const char* name) {
  if (!object.contains(name)) return std::string();
  if (!object[name].is_string()) return std::nullopt;
  return object[name].get<std::string>();
}

Result<CalibratedChoice> read_choice(const Json& json) {
  const auto wrong = [](const char* what) { return Error{ErrorKind::io, what}; };
  if (!json.is_object()) return wrong("a choice is no object");
  if (!json.contains("max_error") || !json["max_error"].is_number()) return wrong("a choice has no number 'max_error'");
  if (!json.contains("choice") || !json["choice"].is_string()) return wrong("a choice has no text 'choice'");
  CalibratedChoice out;
  out.max_error = json["max_error"].get<double>();
  if (!std::isfinite(out.max_error) || out.max_error < 0) return wrong("'max_error' is negative");
  AFTERGLOW_TRY(out.choice, parse_execution(json["choice"].get<std::string>()));
  return out;
}

Result<CalibrationEntry> read_entry(const Json& json) {
  const auto wrong = [](const char* what) { return Error{ErrorKind::io, what}; };
  if (!json.is_object()) return wrong("it is no object");
  const auto device = text_of(json, "device"), driver = text_of(json, "driver"), kind = text_of(json, "kind");
  if (!device || !driver || !kind) return wrong("'device', 'driver' and 'kind' are texts");
  if (!kind->empty() && *kind != "cpu" && *kind != "gpu") return wrong("'kind' is \"cpu\" or \"gpu\"");
  CalibrationEntry entry{.device = *device, .driver = *driver, .kind = *kind, .choices = {}};
  if (!json.contains("choices") || !json["choices"].is_array() || json["choices"].empty())
    return wrong("it has no list of 'choices'");
  for (const auto& one : json["choices"]) {
    AFTERGLOW_TRY(CalibratedChoice choice, read_choice(one));
    entry.choices.push_back(choice);
  }
  std::ranges::stable_sort(entry.choices, {}, &CalibratedChoice::max_error);
  return entry;
}

}  // namespace

bool CalibrationEntry::fits(const DeviceInfo& info) const {
  const bool right_kind = kind.empty() || (kind == "cpu") == (info.type == "cpu");
  return right_kind && matches(device, info.name) && matches(driver, info.driver);
}

std::string CalibrationEntry::name() const {
  if (!device.empty()) return driver.empty() ? device : device + " with " + driver;
  return kind.empty() ? "any device" : "any " + kind;
}

Result<Calibration> Calibration::parse(const std::string& json, const std::string& file) {
  const auto wrong = [&](std::string what) { return Error{ErrorKind::io, std::move(what), file}; };
  const Json root = Json::parse(json, nullptr, false);
  if (root.is_discarded()) return wrong("is not JSON; make one with `afterglow calibrate -o FILE`");
  if (!root.is_object() || !root.contains("devices") || !root["devices"].is_array())
    return wrong("is no calibration: it has no list of 'devices'");
  Calibration table{.file = file, .entries = {}};
  for (const auto& one : root["devices"]) {
    auto entry = read_entry(one);
    if (!entry) {
      Error error = std::move(entry).error();
      error.kind = ErrorKind::io;
      error.file = file;
      error.message = fmt::format("in entry {} of 'devices': {}", table.entries.size() + 1, error.message);
      return error;
    }
    table.entries.push_back(std::move(entry).value());
  }
  return table;
}

Result<Calibration> Calibration::load(const std::filesystem::path& file) {
  AFTERGLOW_TRY(const std::string text, read_named_file(file));
  return parse(text, file.string());
}

Result<Calibration> Calibration::shipped(const std::filesystem::path& installation) {
  const auto file = (installation.empty() ? find_installation() : installation) / kShipped;
  std::error_code none;
  if (!std::filesystem::exists(file, none)) return Calibration{};
  AFTERGLOW_TRY(const std::string text, read_file(file));
  AFTERGLOW_TRY(Calibration table, parse(text, file.string()));
  table.file = kShipped;  // the same in the reports of all machines
  return table;
}

Calibration::Found Calibration::find(const DeviceInfo& info, double max_error) const {
  for (const auto& entry : entries) {
    if (!entry.fits(info)) continue;
    const auto allowed = [&](const CalibratedChoice& c) { return c.max_error <= max_error; };
    const auto best = std::find_if(entry.choices.rbegin(), entry.choices.rend(), allowed);
    if (best != entry.choices.rend()) return {best->choice, fmt::format("{}, {}", file, entry.name())};
  }
  return {ExecutionConfig{}, kAnything};
}

Result<ForcedWays> parse_forced(const std::string& text) {
  static constexpr std::pair<const char*, bool ForcedWays::*> kWays[] = {
      {"staging", &ForcedWays::staging}, {"unmapped", &ForcedWays::unmapped}, {"timestamps", &ForcedWays::timestamps}};
  std::string spaced = text;
  std::ranges::replace_if(
      spaced, [](char c) { return c == ',' || c == '+'; }, ' ');
  ForcedWays out;
  for (const auto& word : split(spaced, ' ')) {
    if (word.empty()) continue;
    const auto way = std::ranges::find(kWays, word, [](const auto& known) { return known.first; });
    if (way != std::end(kWays)) {
      out.*(way->second) = true;
    } else if (parse_execution(word)) {
      out.execution += (out.execution.empty() ? "" : " ") + word;
    } else {
      std::vector<std::string> names;
      for (const auto& [name, member] : kWays) names.emplace_back(name);
      for (auto& name : execution_words()) names.push_back(std::move(name));
      return Error{
          ErrorKind::usage,         fmt::format("AFTERGLOW_FORCE: '{}' is no way to force", word), {}, 0, join(names),
          nearest_name(word, names)};
    }
  }
  return out;
}

}  // namespace afterglow
