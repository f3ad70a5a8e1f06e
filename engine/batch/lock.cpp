// SPDX-License-Identifier: MIT
#include "batch/lock.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "core/file.h"
#include "core/json_text.h"
#include "core/text.h"
#include "core/version.h"
#include "shader/execution_config.h"
#include "shader/kernel.h"
#include "shader/library.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kVersion = 1;

/// The same on every machine: relative to the folder of the search path that holds it.
std::string portable_name(const fs::path& file, const SearchPath& path) {
  std::error_code ec;
  const fs::path whole = fs::weakly_canonical(file, ec);
  const auto below = [&](const fs::path& folder) -> std::string {
    if (folder.empty()) return {};
    const fs::path relative = whole.lexically_relative(fs::weakly_canonical(folder, ec));
    return relative.empty() || *relative.begin() == ".." ? std::string() : relative.generic_string();
  };
  for (const auto& folder : path.user)
    if (const std::string name = below(folder); !name.empty()) return name;
  if (const std::string name = below(path.installation); !name.empty()) return "installation: " + name;
  return whole.generic_string();
}

/// Every file that the look is made of.
Result<std::set<fs::path>> files_of(const Preset& preset, const Graph& graph) {
  std::set<fs::path> files(preset.files().begin(), preset.files().end());
  ShaderLibrary shaders(preset.path());
  std::vector<std::string> names;
  for (const auto& pass : graph.passes)
    for (auto& name : shaders_of(pass)) names.push_back(std::move(name));
  for (const auto& name : names) {
    AFTERGLOW_TRY(const auto shader, shaders.find(name));
    for (const auto& file : shader->files()) files.insert(file);
  }
  // Other frames may have other passes: then all shaders of these effects' folders count.
  if (preset.may_change())
    for (const auto& name : shaders.names())
      if (const auto shader = shaders.find(name))
        for (const auto& file : (*shader)->files()) files.insert(file);
  return files;
}

/// "a.lua has changed, b.glsl is gone": what differs between two tables, in order.
std::vector<std::string> differences(const std::map<std::string, std::string>& locked,
                                     const std::map<std::string, std::string>& now, bool values) {
  std::vector<std::string> out;
  for (const auto& [name, value] : locked) {
    const auto found = now.find(name);
    if (found == now.end())
      out.push_back(values ? fmt::format("{} was {}", name, value) : fmt::format("{} is not used any more", name));
    else if (found->second != value)
      out.push_back(values ? fmt::format("{} is {}, was {}", name, found->second, value)
                           : fmt::format("{} has changed", name));
  }
  for (const auto& [name, value] : now)
    if (!locked.contains(name))
      out.push_back(values ? fmt::format("{} is {}, was not given", name, value) : fmt::format("{} is new", name));
  return out;
}

Error not_a_lock(const fs::path& file, const std::string& why) {
  return {ErrorKind::io, fmt::format("this is no lock: {}", why), file.string(), 0, "a file written by --lock"};
}

}  // namespace

Result<Lock> look_lock(const Preset& preset, const fs::path& file_of_preset, const Graph& graph,
                       const PixelOptions& options) {
  Lock lock;
  lock.preset = file_of_preset.filename().string();
  AFTERGLOW_TRY(const auto files, files_of(preset, graph));
  for (const auto& file : files) {
    AFTERGLOW_TRY(const std::string text, read_file(file));
    lock.files[portable_name(file, preset.path())] = hash_text(text).hex();
  }
  for (const auto& [name, value] : options)
    if (!value.empty()) lock.options[name] = value;
  lock.made_with = {{"afterglow", version()}, {"shader compiler", glsl_compiler_version()}};
  return lock;
}

Result<Lock> lock_of(Session& session, const Graph& graph, const PixelOptions& options) {
  const SessionReport report = session.report();
  AFTERGLOW_TRY(Lock lock, look_lock(session.preset(), report.preset, graph, options));
  lock.made_with["device"] = report.device;
  lock.made_with["driver"] = report.driver;
  lock.made_with["execution"] = execution_name(report.choice.execution);
  return lock;
}

std::string lock_text(const Lock& lock) {
  const json out{{"afterglow_lock", kVersion},
                 {"look", {{"preset", lock.preset}, {"files", lock.files}, {"options", lock.options}}},
                 {"made_with", lock.made_with}};
  return json_text(out);
}

Result<Lock> read_lock(const fs::path& file) {
  AFTERGLOW_TRY(const std::string text, read_named_file(file, 16u << 20));
  try {
    const json in = json::parse(text);
    const int version = in.at("afterglow_lock").get<int>();
    if (version != kVersion)
      return not_a_lock(file, fmt::format("it has version {}, this program reads version {}", version, kVersion));
    Lock lock;
    lock.preset = in.at("look").at("preset").get<std::string>();
    lock.files = in.at("look").at("files").get<std::map<std::string, std::string>>();
    lock.options = in.at("look").at("options").get<std::map<std::string, std::string>>();
    lock.made_with = in.at("made_with").get<std::map<std::string, std::string>>();
    return lock;
  } catch (const json::exception& error) {
    return not_a_lock(file, error.what());
  }
}

Result<void> hold_against(const Lock& locked, const Lock& now, const fs::path& file, Diagnostics& diagnostics) {
  std::map<std::string, std::string> made_with;  // that the lock knows
  for (const auto& [name, value] : now.made_with)
    if (locked.made_with.contains(name)) made_with.emplace(name, value);
  for (const auto& difference : differences(locked.made_with, made_with, true))
    diagnostics.warn(fmt::format("{}: {}: pixels may differ within the documented bounds", file.string(), difference));
  std::vector<std::string> found;
  if (locked.preset != now.preset) found.push_back(fmt::format("the preset is {}, was {}", now.preset, locked.preset));
  std::ranges::copy(differences(locked.files, now.files, false), std::back_inserter(found));
  std::ranges::copy(differences(locked.options, now.options, true), std::back_inserter(found));
  if (found.empty()) return {};
  Error error{ErrorKind::script, fmt::format("the look is not the locked one: {}", found.front()), file.string()};
  if (found.size() > 1) error.message += fmt::format(" (and {} more)", found.size() - 1);
  error.trail.assign(found.begin() + 1, found.end());
  error.allowed = "the locked look, or a new --lock";
  return error;
}

}  // namespace afterglow
