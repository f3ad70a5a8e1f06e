// SPDX-License-Identifier: MIT
#include "stress/reproducer.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/file.h"
#include "core/process.h"
#include "core/text.h"
#include "stress/auxiliary.h"
#include "stress/picture_file.h"

namespace afterglow::stress {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kInput = "input.exr";
constexpr const char* kCase = "case.json";
constexpr const char* kPreset = "preset.lua";

json as_json(const Look& look) {
  json out{{"entries", json::array()}, {"paths", json::array()}};
  for (const auto& path : look.paths) out["paths"].push_back(fs::absolute(path).string());
  for (const auto& entry : look.entries) {
    json one{{"effect", entry.effect}, {"settings", json::array()}};
    if (!entry.at.empty()) one["at"] = entry.at, one["order"] = entry.order;
    if (!entry.composition.empty()) one["composition"] = entry.composition;
    if (entry.depth > 0) one["depth"] = entry.depth;
    for (const auto& [name, value] : entry.settings)
      one["settings"].push_back(
          {{"name", name}, {"type", static_cast<int>(value.type)}, {"number", value.number}, {"choice", value.choice}});
    out["entries"].push_back(std::move(one));
  }
  return out;
}

Look look_of(const json& from) {
  Look look;
  for (const auto& path : from.at("paths")) look.paths.emplace_back(path.get<std::string>());
  for (const auto& one : from.at("entries")) {
    LookEntry entry{
        .effect = one.at("effect"), .settings = {}, .at = one.value("at", ""), .order = one.value("order", 0)};
    entry.composition = one.value("composition", entry.composition);
    entry.depth = one.value("depth", 0);
    for (const auto& setting : one.at("settings")) {
      SettingValue value{.type = static_cast<SettingType>(setting.at("type").get<int>())};
      value.number = setting.at("number").get<std::array<double, 3>>();
      value.choice = setting.at("choice").get<std::string>();
      entry.set(setting.at("name"), value);
    }
    look.entries.push_back(std::move(entry));
  }
  return look;
}

std::string read_me(const fs::path& folder, const Situation& s, const Outcome& outcome) {
  std::string paths;
  for (const auto& path : s.look.paths) paths += " --path " + shell_word(fs::absolute(path).string());
  const std::string here = fs::absolute(folder).string();
  return fmt::format(
      "{}: {}\n{}\n\nThe check again:\n  afterglow stress --repeat {}\nThe picture alone:\n  afterglow run {} {} -o "
      "out.exr{}\n",
      s.check, find_check(s.check)->doc, outcome.what, shell_word(here), shell_word(here + "/" + kPreset),
      shell_word(here + "/" + kInput), paths);
}

}  // namespace

Result<void> write_reproducer(const fs::path& folder, const Situation& situation, const Outcome& outcome,
                              const Provenance& provenance) {
  std::error_code ec;
  fs::create_directories(folder, ec);
  if (ec) return Error{ErrorKind::io, "cannot be made: " + ec.message(), folder.string()};
  const Size size = situation.picture.color.size();
  const json text{
      {"check", situation.check},
      {"promise", find_check(situation.check)->promise ? json(find_check(situation.check)->promise) : json()},
      {"what", outcome.what},
      {"measured", outcome.measured},
      {"allowed", outcome.allowed},
      {"stack", as_json(situation.look)},
      {"frame", situation.frame},
      {"check_seed", situation.seed},
      {"width", size.width},
      {"height", size.height},
      {"found",
       {{"version", provenance.version},
        {"device", provenance.device},
        {"driver", provenance.driver},
        {"seed", provenance.seed},
        {"trial", provenance.trial}}},
      {"command", fmt::format("afterglow stress --repeat {}", shell_word(fs::absolute(folder).string()))}};
  AFTERGLOW_CHECK(write_picture_file(situation.picture, folder / kInput));
  AFTERGLOW_CHECK(write_file_atomically(folder / kPreset, situation.look.text()));
  AFTERGLOW_CHECK(write_file_atomically(folder / "README.txt", read_me(folder, situation, outcome)));
  return write_file_atomically(folder / kCase, text.dump(2) + "\n");
}

Result<Situation> read_reproducer(const fs::path& folder, Diagnostics& diagnostics) {
  AFTERGLOW_TRY(const std::string text, read_file(folder / kCase));
  Situation out;
  try {
    const json from = json::parse(text);
    out.check = from.at("check");
    out.look = look_of(from.at("stack"));
    out.frame = from.at("frame");
    out.seed = from.at("check_seed");
  } catch (const std::exception& error) {
    return Error{ErrorKind::io, fmt::format("is no case of `afterglow stress`: {}", error.what()),
                 (folder / kCase).string()};
  }
  if (!find_check(out.check)) {
    std::vector<std::string> names;
    for (const auto& check : checks()) names.emplace_back(check.name);
    return Error{ErrorKind::io,
                 fmt::format("unknown check '{}'", out.check),
                 (folder / kCase).string(),
                 0,
                 join(names),
                 nearest_name(out.check, names)};
  }
  AFTERGLOW_TRY(out.picture, read_picture_file(folder / kInput, diagnostics));
  for (const char* name : {"depth", "normal", "motion", kMatte})
    if (!out.picture.auxiliary.contains(name))
      return Error{ErrorKind::io, fmt::format("has no {}", name), (folder / kInput).string()};
  return out;
}

}  // namespace afterglow::stress
