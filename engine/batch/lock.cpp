// SPDX-License-Identifier: MIT
#include "batch/lock.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "core/file.h"
#include "core/json_text.h"
#include "core/utf8.h"
#include "core/version.h"
#include "image/ocio.h"
#include "shader/execution_config.h"
#include "shader/kernel.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using LockTable = std::map<std::string, std::string>;

constexpr int kVersion = 2;

/// Hashes by names that are the same on every machine.
Result<LockTable> hashes_of(const std::map<std::string, fs::path>& files, FileHashes& hashes) {
  LockTable out;
  for (const auto& [name, file] : files) {
    AFTERGLOW_TRY(const Hash hash, hashes.of(file));
    out[name] = hash.hex();
  }
  return out;
}

/// "a.lua has changed, b.glsl is gone": what differs between two tables, in order.
std::vector<std::string> differences(const LockTable& locked, const LockTable& now, bool values) {
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

/// Those of `locked` that `now` has too: frames that were not asked about use the rest.
LockTable used_now(const LockTable& locked, const LockTable& now) {
  LockTable out;
  for (const auto& [name, value] : locked)
    if (now.contains(name)) out.emplace(name, value);
  return out;
}

/// As far as a lock of version 1 could say it: it knew the files of frame 1 alone, and no variables.
Lock in_version_1(Lock now, const Lock& locked, const fs::path& file, Diagnostics& diagnostics) {
  bool more = !now.environment.empty();
  for (auto& [name, hash] : now.frame_files)
    if (locked.files.contains(name))
      now.files[name] = hash;
    else
      more = true;
  for (LockTable* unknown : {&now.frame_files, &now.environment, &now.generated}) unknown->clear();
  if (more)
    diagnostics.warn(
        fmt::format("{}: a lock of version 1 knows no files of other frames than the first and no variables "
                    "of the environment; a new --lock does",
                    file.string()));
  return now;
}

/// As the file holds it.
LockTable written(const LockTable& table) {
  LockTable out;
  for (const auto& [name, value] : table) out[utf8_text(name)] = utf8_text(value);
  return out;
}

Error not_a_lock(const fs::path& file, const std::string& why) {
  return {ErrorKind::io, fmt::format("this is no lock: {}", why), file.string(), 0, "a file written by --lock"};
}

}  // namespace

Result<Lock> look_lock(const Preset& preset, const fs::path& file_of_preset, const Inventory& inventory,
                       const PixelOptions& options) {
  Lock lock;
  lock.preset = utf8_text(file_of_preset.filename().string());
  const PortableNames names(preset.path());
  FileHashes hashes(preset);
  std::set<fs::path> files = inventory.sources, of_frames;
  for (const auto& [file, name] : inventory.depends.files) (inventory.moves ? of_frames : files).insert(file);
  AFTERGLOW_TRY(lock.files, hashes_of(names.of(files), hashes));
  AFTERGLOW_TRY(lock.frame_files, hashes_of(names.of(of_frames), hashes));
  lock.environment = inventory.depends.environment;
  for (const auto& [name, hash] : inventory.depends.generated) lock.generated[name] = hash.hex();
  for (const auto& [name, value] : options)
    if (!value.empty()) lock.options[name] = value;
  lock.made_with = {{"afterglow", version()}, {"shader compiler", glsl_compiler_version()}};
  if (!lock.generated.empty()) lock.made_with["OpenColorIO"] = ocio_version();
  for (LockTable* table : {&lock.files, &lock.frame_files, &lock.environment, &lock.generated, &lock.options})
    *table = written(*table);
  return lock;
}

Result<Lock> lock_of(Session& session, const Inventory& inventory, const PixelOptions& options) {
  const SessionReport report = session.report();
  AFTERGLOW_TRY(Lock lock, look_lock(session.preset(), report.preset, inventory, options));
  lock.made_with["device"] = report.device;
  lock.made_with["driver"] = report.driver;
  lock.made_with["execution"] = execution_name(report.choice.execution);
  return lock;
}

std::string lock_text(const Lock& lock) {
  const json out{{"afterglow_lock", lock.version},
                 {"look",
                  {{"preset", lock.preset},
                   {"files", lock.files},
                   {"frame_files", lock.frame_files},
                   {"environment", lock.environment},
                   {"generated", lock.generated},
                   {"options", lock.options}}},
                 {"made_with", lock.made_with}};
  return json_text(out);
}

Result<Lock> read_lock(const fs::path& file) {
  AFTERGLOW_TRY(const std::string text, read_named_file(file, 16u << 20));
  try {
    const json in = json::parse(text);
    const int version = in.at("afterglow_lock").get<int>();
    if (version < 1 || version > kVersion)
      return not_a_lock(file, fmt::format("it has version {}, this program reads up to {}", version, kVersion));
    const json& look = in.at("look");
    Lock lock;
    lock.preset = look.at("preset").get<std::string>();
    lock.files = look.at("files").get<LockTable>();
    lock.version = version;
    if (version > 1) {
      lock.frame_files = look.at("frame_files").get<LockTable>();
      lock.environment = look.at("environment").get<LockTable>();
      lock.generated = look.at("generated").get<LockTable>();
    }
    lock.options = look.at("options").get<LockTable>();
    lock.made_with = in.at("made_with").get<LockTable>();
    return lock;
  } catch (const json::exception& error) {
    return not_a_lock(file, error.what());
  }
}

Result<void> hold_against(const Lock& locked, const Lock& given, const fs::path& file, Diagnostics& diagnostics) {
  const Lock now = locked.version == 1 ? in_version_1(given, locked, file, diagnostics) : given;
  std::map<std::string, std::string> made_with;  // that the lock knows
  for (const auto& [name, value] : now.made_with)
    if (locked.made_with.contains(name)) made_with.emplace(name, value);
  for (const auto& difference : differences(locked.made_with, made_with, true))
    diagnostics.warn(fmt::format("{}: {}: pixels may differ within the documented bounds", file.string(), difference));
  std::vector<std::string> found;
  if (locked.preset != now.preset) found.push_back(fmt::format("the preset is {}, was {}", now.preset, locked.preset));
  std::ranges::copy(differences(locked.files, now.files, false), std::back_inserter(found));
  for (const auto& table : {&Lock::frame_files, &Lock::environment})
    std::ranges::copy(differences(used_now(locked.*table, now.*table), now.*table, table == &Lock::environment),
                      std::back_inserter(found));
  std::ranges::copy(differences(locked.options, now.options, true), std::back_inserter(found));
  if (found.empty()) {
    // Of the same files and variables: another version of OpenColorIO, or another processor under it.
    for (const auto& difference : differences(used_now(locked.generated, now.generated), now.generated, false))
      diagnostics.warn(fmt::format("{}: what OpenColorIO makes of {}: pixels may differ", file.string(), difference));
    return {};
  }
  Error error{ErrorKind::script, fmt::format("the look is not the locked one: {}", found.front()), file.string()};
  if (found.size() > 1) error.message += fmt::format(" (and {} more)", found.size() - 1);
  error.trail.assign(found.begin() + 1, found.end());
  error.allowed = "the locked look, or a new --lock";
  return error;
}

}  // namespace afterglow
