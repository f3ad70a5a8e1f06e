// SPDX-License-Identifier: MIT
#include "core/paths.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <set>
#include <system_error>

#include "core/environment.h"
#include "core/file.h"
#include "core/file_record.h"
#include "core/inside.h"
#include "core/near_path.h"
#include "core/own_file.h"
#include "core/pack.h"
#include "core/text.h"
#include "core/user_folders.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

bool is_preset_name(const std::string& name) {
  return !name.empty() && name.size() <= 100 &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
}

void add_pack(SearchPath& path, const fs::path& pack) {
  if (!is_zip(pack)) {
    path.user.push_back(pack);
    return;
  }
  if (path.record) path.record->note(pack, FileProbe::Kind::stamp);
  auto opened = open_zip(pack, cache_folder());
  if (opened)
    path.user.push_back(std::move(opened).value());
  else if (!path.error)
    path.error = std::move(opened).error();
}

// The packs in a folder's packs/, in the order of their names.
void add_packs(SearchPath& path, const fs::path& folder) {
  std::vector<fs::path> packs;
  std::error_code ec;
  if (path.record) path.record->note(folder / "packs", FileProbe::Kind::listing);
  for (fs::directory_iterator it(folder / "packs", ec), end; !ec && it != end; it.increment(ec)) {
    std::error_code ignored;
    if (is_zip(it->path()) || fs::is_directory(it->path(), ignored)) packs.push_back(it->path());
  }
  std::sort(packs.begin(), packs.end());
  const auto before = path.user.size();
  for (const auto& pack : packs) add_pack(path, pack);
  path.packs.insert(path.user.begin() + static_cast<std::ptrdiff_t>(before), path.user.end());
}

// A folder and the packs in it; packs in packs are not looked for.
void add_folder(SearchPath& path, const fs::path& folder) {
  add_pack(path, folder);
  if (!is_zip(folder)) add_packs(path, folder);
}

bool is_installation(const fs::path& folder) { return is_file(folder / "scripts" / "afterglow.lua"); }

}  // namespace

std::vector<fs::path> SearchPath::find_script(const std::string& name, const std::string& kind) const {
  std::vector<fs::path> hits;
  for (const auto& folder : script_folders(kind))
    if (is_file(folder / (name + ".lua"), record.get())) hits.push_back(folder / (name + ".lua"));
  return hits;
}

std::vector<fs::path> SearchPath::find_shader(const std::string& name, const fs::path& from) const {
  std::vector<fs::path> folders, hits;
  const auto add = [&](bool of_packs) {
    for (const auto& root : user)
      if (packs.contains(root) == of_packs) folders.push_back(root / "shaders");
  };
  add(false);
  if (!installation.empty()) folders.push_back(installation / "shaders");
  add(true);
  if (!from.empty()) folders = own_first(std::move(folders), from);
  for (const auto& folder : folders)
    if (is_file(folder / name, record.get())) hits.push_back(folder / name);
  return hits;
}

std::vector<fs::path> SearchPath::folders_of(const fs::path& script) const {
  std::vector<fs::path> folders = user;
  folders.push_back(installation);
  folders = own_first(std::move(folders), script);
  const auto end = std::ranges::find_if(
      folders, [&](const auto& folder) { return folder == installation || !is_named_in(script, folder); });
  folders.erase(end, folders.end());
  return folders;
}

std::vector<fs::path> SearchPath::asset_folders() const {
  std::vector<fs::path> folders = user;
  if (!installation.empty()) folders.push_back(installation / "assets");
  return folders;
}

fs::path SearchPath::find_asset(const std::string& name) const {
  for (const auto& folder : asset_folders())
    if (fs::path file = file_in(folder, name, record.get()); !file.empty()) return file;
  return {};
}

std::vector<fs::path> SearchPath::script_folders(const std::string& kind) const {
  std::vector<fs::path> folders;
  for (const auto& root : user) folders.push_back(root / kind);
  if (!installation.empty()) folders.push_back(installation / "scripts" / kind);
  return folders;
}

std::vector<fs::path> SearchPath::preset_folders() const {
  std::vector<fs::path> folders;
  for (const auto& root : user) {
    folders.push_back(root);
    folders.push_back(root / "presets");
  }
  if (!installation.empty()) folders.push_back(installation / "presets");
  return folders;
}

std::vector<fs::path> SearchPath::find_preset(const std::string& name) const {
  if (!is_preset_name(name)) return {};
  std::vector<fs::path> hits;
  for (const auto& folder : preset_folders())
    for (const auto& file : {folder / (name + ".lua"), folder / name / (name + ".lua")})
      if (is_file(file, record.get())) hits.push_back(file);
  return hits;
}

std::vector<std::string> SearchPath::preset_names() const {
  std::set<std::string> names;
  for (const auto& folder : preset_folders()) {
    std::error_code ec;
    for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
      const std::string name = it->path().stem().string();
      if (!is_preset_name(name)) continue;
      if (it->path().extension() == ".lua" || is_file(it->path() / (name + ".lua"))) names.insert(name);
    }
  }
  return {names.begin(), names.end()};
}

fs::path find_installation() {
  if (const auto home = environment("AFTERGLOW_HOME"); !home.empty()) return home;
  constexpr int kMostLevels = 4;  // PREFIX/lib/x86_64-linux-gnu/afterglow/module.so
  fs::path folder = own_file().parent_path();
  for (int level = 0; level < kMostLevels && folder.has_relative_path(); ++level, folder = folder.parent_path())
    if (is_installation(folder / "share" / "afterglow")) return folder / "share" / "afterglow";
  folder =
      is_in_build_folder() ? fs::path(AFTERGLOW_SOURCE_FOLDER) : fs::path(AFTERGLOW_PREFIX) / "share" / "afterglow";
  return is_installation(folder) ? folder : fs::path();
}

bool is_of_installation(const fs::path& preset) {
  const fs::path installation = find_installation();
  if (installation.empty()) return false;
  std::error_code ec;
  const fs::path inside = fs::weakly_canonical(preset, ec).lexically_relative(fs::weakly_canonical(installation, ec));
  const std::string folder = inside.empty() ? "" : inside.begin()->string();
  return folder == "presets" || folder == "packs";
}

namespace {

std::vector<fs::path> folders_of(const fs::path& preset, FileRecord* record) {
  std::vector<fs::path> folders{preset.has_parent_path() ? preset.parent_path() : fs::path(".")};
  const fs::path above = folders[0].parent_path();
  if (folders[0].filename() != "presets") return folders;
  bool is_pack = false;
  for (const char* const part : {"effects", "shaders", "luts"}) {
    if (record) record->note(above / part, FileProbe::Kind::existence);
    std::error_code ec;
    is_pack |= fs::is_directory(above / part, ec);
  }
  if (is_pack) folders.push_back(above);
  return folders;
}

}  // namespace

std::vector<fs::path> folders_of_preset(const fs::path& preset) { return folders_of(preset, nullptr); }

SearchPath search_path_for(const fs::path& preset, const std::vector<fs::path>& extra,
                           std::shared_ptr<FileRecord> record, const fs::path& installation) {
  SearchPath path;
  path.record = std::move(record);
  path.installation = installation.empty() ? find_installation() : installation;
  if (!preset.empty())
    for (const auto& folder : folders_of(preset, path.record.get())) add_folder(path, folder);
  for (const auto& folder : extra) add_folder(path, folder);
  if (const auto list = environment("AFTERGLOW_PATH"); !list.empty())
    for (const auto& entry : split(list, ':'))
      if (!entry.empty()) add_folder(path, entry);
  if (!path.installation.empty()) add_packs(path, path.installation);
  return path;
}

Result<fs::path> find_preset_file(const std::string& given, const std::vector<fs::path>& extra,
                                  const fs::path& installation) {
  std::error_code ec;
  SearchPath path;
  std::string name = given;
  const bool is_pack = is_zip(given) || fs::is_directory(given, ec);
  if (is_pack) {
    add_pack(path, given);
    name = fs::path(given).lexically_normal().stem().string();
  } else {
    if (fs::exists(given, ec) || !is_preset_name(given)) return fs::path(given);
    path = search_path_for({}, extra, nullptr, installation);
  }
  if (path.error) return *path.error;
  if (const auto hits = path.find_preset(name); !hits.empty()) return hits.front();
  const auto names = path.preset_names();
  if (is_pack && names.size() == 1) return path.find_preset(names[0]).front();
  if (is_pack)
    return Error{ErrorKind::script, names.empty() ? "the pack holds no preset" : "the pack holds several presets",
                 given, 0, names.empty() ? "" : "--path " + given + " and one of: " + join(names)};
  if (!is_installation(path.installation))
    return Error{ErrorKind::script,
                 fmt::format("is no installation of Afterglow, where the preset '{}' was looked for", given),
                 path.installation.empty() ? "share/afterglow" : path.installation.string(), 0,
                 "a folder with scripts/ and shaders/ (AFTERGLOW_HOME)"};
  // A file that lies there and only lacks its ending is what was meant.
  const bool beside = fs::exists(given + ".lua", ec);
  return Error{ErrorKind::script, fmt::format("there is no preset '{}'", given),       "", 0,
               join(names),       beside ? given + ".lua" : nearest_name(given, names)};
}

namespace {

/// Could it be made and written to, as far as permissions say?
bool is_writable(fs::path folder) {
  std::error_code ec;
  while (!fs::exists(folder, ec) && folder.has_relative_path()) folder = folder.parent_path();
  return fs::is_directory(folder, ec) && access(folder.c_str(), W_OK | X_OK) == 0;
}

/// Makes the folder, or finds that it is this user's and nobody else may write to it: what lies in a cache is run.
bool claim(const fs::path& folder) {
  if (mkdir(folder.c_str(), 0700) == 0) return true;
  struct stat status {};
  return errno == EEXIST && lstat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) &&
         status.st_uid == geteuid() && (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

/// Anybody may have made a folder of this name before.
fs::path make_temporary_cache() {
  std::error_code ec;
  const fs::path folder = fs::temp_directory_path(ec) / fmt::format("afterglow-{}", geteuid());
  if (claim(folder)) return folder;
  std::string own = folder.string() + "-XXXXXX";
  if (mkdtemp(own.data())) return own;
  return "/dev/null/afterglow";  // cannot be made: there is no cache
}

}  // namespace

fs::path cache_folder() {
  if (const auto own = environment("AFTERGLOW_CACHE"); !own.empty()) return own;
  const fs::path users = user_cache_folder();
  if (!users.empty() && is_writable(users)) return users;
  static const fs::path temporary = make_temporary_cache();
  return temporary;
}

}  // namespace afterglow
