#include "core/paths.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <set>
#include <system_error>

#include "core/text.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

bool is_file(const fs::path& path) {
  std::error_code ec;
  return fs::is_regular_file(path, ec);
}

bool is_preset_name(const std::string& name) {
  return !name.empty() && name.size() <= 100 &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
}

bool is_installation(const fs::path& folder) { return is_file(folder / "scripts" / "afterglow.lua"); }

}  // namespace

std::vector<fs::path> SearchPath::find_effect(const std::string& name) const {
  std::vector<fs::path> hits;
  for (const auto& folder : effect_folders())
    if (is_file(folder / (name + ".lua"))) hits.push_back(folder / (name + ".lua"));
  return hits;
}

std::vector<fs::path> SearchPath::find_shader(const std::string& name) const {
  std::vector<fs::path> hits;
  for (const auto& root : user)
    if (is_file(root / "shaders" / name)) hits.push_back(root / "shaders" / name);
  if (!installation.empty() && is_file(installation / "shaders" / name))
    hits.push_back(installation / "shaders" / name);
  return hits;
}

std::vector<fs::path> SearchPath::effect_folders() const {
  std::vector<fs::path> folders;
  for (const auto& root : user) folders.push_back(root / "effects");
  if (!installation.empty()) folders.push_back(installation / "scripts" / "effects");
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
      if (is_file(file)) hits.push_back(file);
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
  std::error_code ec;
  const fs::path binary = fs::read_symlink("/proc/self/exe", ec);
  if (!ec) {
    const fs::path shared = binary.parent_path().parent_path() / "share" / "afterglow";
    if (is_installation(shared)) return shared;
  }
#ifdef AFTERGLOW_SOURCE_FOLDER
  if (is_installation(AFTERGLOW_SOURCE_FOLDER)) return AFTERGLOW_SOURCE_FOLDER;
#endif
  return {};
}

SearchPath search_path_for(const fs::path& preset, const std::vector<fs::path>& extra) {
  SearchPath path;
  if (!preset.empty()) path.user.push_back(preset.has_parent_path() ? preset.parent_path() : fs::path("."));
  path.user.insert(path.user.end(), extra.begin(), extra.end());
  if (const auto list = environment("AFTERGLOW_PATH"); !list.empty())
    for (const auto& entry : split(list, ':'))
      if (!entry.empty()) path.user.emplace_back(entry);
  path.installation = find_installation();
  return path;
}

fs::path cache_folder() {
  if (const auto own = environment("AFTERGLOW_CACHE"); !own.empty()) return own;
  if (const auto xdg = environment("XDG_CACHE_HOME"); !xdg.empty()) return fs::path(xdg) / "afterglow";
  if (const auto home = environment("HOME"); !home.empty()) return fs::path(home) / ".cache" / "afterglow";
  std::error_code ec;
  return fs::temp_directory_path(ec) / fmt::format("afterglow-{}", getuid());
}

}  // namespace afterglow
