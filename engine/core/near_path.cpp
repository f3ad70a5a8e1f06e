// SPDX-License-Identifier: MIT
#include "core/near_path.h"

#include <algorithm>
#include <set>
#include <span>
#include <utility>

#include "core/decomposed.h"
#include "core/file.h"
#include "core/pack.h"
#include "core/text.h"

namespace afterglow {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostFolders = 8;
constexpr int kMostTries = 64;  // folders that are looked into

std::string ending_of(const std::string& name) { return lower(fs::path(name).extension().string()); }

/// The names in all `folders` that may be `part` of a name, the last one or a folder.
std::vector<std::string> names_like(const std::vector<fs::path>& folders, const std::string& part, bool is_last) {
  std::set<std::string> names;
  for (const auto& folder : folders)
    for (std::string& name : names_in(folder)) {
      std::error_code ec;
      const bool may_be = is_last ? ending_of(name) == ending_of(part) : fs::is_directory(folder / name, ec);
      if (may_be) names.insert(std::move(name));
    }
  return {names.begin(), names.end()};
}

/// The names below `folders` that are spelled like `parts`, joined. A folder that is there may still be another than
/// the one that is meant.
std::string near_parts(const std::vector<fs::path>& folders, std::span<const std::string> parts, int& tries) {
  const std::string& part = parts.front();
  const bool is_last = parts.size() == 1;
  auto names = names_like(folders, part, is_last);
  if (is_last) return nearest_name(part, names);
  while (++tries <= kMostTries) {
    const bool is_there = std::ranges::find(names, part) != names.end();
    const std::string name = is_there ? part : nearest_name(part, names);
    if (name.empty()) return {};
    std::vector<fs::path> inside;
    for (const auto& folder : folders) inside.push_back(folder / name);
    if (const std::string near = near_parts(inside, parts.subspan(1), tries); !near.empty()) return name + "/" + near;
    std::erase(names, name);
  }
  return {};
}

}  // namespace

fs::path file_in(const fs::path& folder, const std::string& name, FileRecord* record) {
  if (is_file(folder / name, record)) return folder / name;
  for (const std::string& other : {put_together(name), taken_apart(name)})
    if (other != name && is_file(folder / other, record)) return folder / other;
  return {};
}

bool is_tidy_path(const std::string& name) { return is_safe_entry(name, kMostFolders); }

std::string near_path(const std::vector<fs::path>& folders, const std::string& name) {
  const auto parts = split(name, '/');
  int tries = 0;
  return parts.size() > kMostFolders + 1 ? "" : near_parts(folders, parts, tries);
}

std::string tidy_path(const std::string& name) {
  std::string slashes = trim(name);
  std::ranges::replace(slashes, '\\', '/');
  std::vector<std::string> parts = split(slashes, '/');
  if (parts.front().empty()) return {};  // of the whole system
  std::erase_if(parts, [](const std::string& part) { return part.empty() || part == "."; });
  std::string tidy = join(parts, "/");
  return is_tidy_path(tidy) ? tidy : "";
}

}  // namespace afterglow
