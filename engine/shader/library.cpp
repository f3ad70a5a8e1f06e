// SPDX-License-Identifier: MIT
#include "shader/library.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/made_shaders.h"
#include "core/text.h"
#include "shader/fixed_alpha.h"
#include "shader/include.h"
#include "shader/levels.h"
#include "shader/macros.h"
#include "shader/scan.h"

namespace afterglow {
namespace fs = std::filesystem;

std::vector<fs::path> ShaderSource::files() const {
  std::vector<fs::path> list{path};
  for (const auto& include : includes) list.push_back(include.path);
  return list;
}

namespace {

Result<void> check_expansion(const ShaderSource& source) {
  std::vector<MacroFile> files;
  MacroFile own{source.path.string(), &source.file->scan, {}};
  for (const auto& include : source.includes) {
    own.uses.push_back(files.size());
    files.push_back({include.path.string(), &include.file->scan, include.uses});
  }
  files.push_back(std::move(own));
  return check_macros(files);
}

void note_loops(const std::vector<Token>& tokens, ShaderSource& source) {
  for (const Token& t : tokens) {
    source.open_loops |= t.is("while") || t.is("do");
    source.loops |= source.open_loops || t.is("for");
  }
}

Result<std::shared_ptr<const ShaderSource>> load(const SearchPath& search, const std::string& name,
                                                 const fs::path& path, std::string text) {
  auto source = std::make_shared<ShaderSource>();
  source->name = name;
  source->path = path;
  AFTERGLOW_TRY(source->file, scan_file(std::move(text), path.string(), ScanAs::stage));
  const ShaderScan& scanned = source->file->scan;
  AFTERGLOW_TRY(source->includes, resolve_includes(search, path, scanned));
  AFTERGLOW_CHECK(check_expansion(*source));
  for (const auto& global : scanned.names) source->global_names.push_back(global.name);
  source->interface = scanned.interface;
  Hasher hasher;
  hasher.add(source->file->text);
  for (const auto& include : source->includes) hasher.add(include.file->text);
  source->hash = hasher.finish();
  note_loops(scanned.tokens, *source);
  source->keeps_state = scanned.keeps_state;
  source->fixed_alpha_line = fixed_alpha_line(scanned.tokens, info_of(source->interface.kind).entry);
  source->level_line = level_line(scanned.tokens);
  for (const auto& include : source->includes) {
    const ShaderScan& library = include.file->scan;
    note_loops(library.tokens, *source);
    source->keeps_state = source->keeps_state || library.keeps_state;
    if (!library.shared.empty() && source->interface.kind != PassKind::compute)
      return shader_error(include.path.string(), library.shared.front().line,
                          "'shared' is for compute shaders (compute_at); included by " + path.string());
  }
  return std::shared_ptr<const ShaderSource>(std::move(source));
}

}  // namespace

std::string ShaderLibrary::own_name(const std::string& name, const fs::path& script) {
  if (!is_safe_name(name) || (path_.made && path_.made->find(name))) return name;
  const std::lock_guard lock(mutex_);
  std::string& known = own_names_[{name, script}];
  if (!known.empty()) return known;
  known = name;
  for (const fs::path& folder : path_.folders_of(script)) {
    const fs::path own = folder / "shaders" / (name + ".glsl");
    if (!is_file(own, path_.record.get())) continue;
    if (path_.find_shader(name + ".glsl").front() == own) break;
    known += "@" + folder.string();
    own_files_[known] = own;
    break;
  }
  return known;
}

Result<std::shared_ptr<const ShaderSource>> ShaderLibrary::find(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (const auto known = sources_.find(name); known != sources_.end()) return known->second;
  if (const auto made = path_.made ? path_.made->find(name) : std::nullopt) {
    AFTERGLOW_TRY(auto source, load(path_, name, made->origin, made->text));
    return sources_[name] = source;
  }
  std::vector<fs::path> hits;
  if (const auto own = own_files_.find(name); own != own_files_.end())
    hits = {own->second};
  else if (is_safe_name(name))
    hits = path_.find_shader(name + ".glsl");
  if (hits.empty()) {
    Error error = shader_error("", 0, fmt::format("unknown shader '{}'", name));
    constexpr std::string_view kExtension = ".glsl", kFolder = "shaders/";
    const auto known = names();
    std::string plain = name.ends_with(kExtension) ? name.substr(0, name.size() - kExtension.size()) : name;
    if (plain.starts_with(kFolder)) plain.erase(0, kFolder.size());
    if (is_safe_name(plain))
      error.allowed = fmt::format("shaders/{}.glsl beside the preset, or on the search path", plain);
    error.nearest = std::ranges::count(known, plain) > 0 ? plain : nearest_name(plain, known);
    return error;
  }
  AFTERGLOW_CHECK(check_inside(path_, hits.front()));
  AFTERGLOW_TRY(std::string text, read_shader(hits.front(), path_.record.get()));
  AFTERGLOW_TRY(auto source, load(path_, name, hits.front(), std::move(text)));
  return sources_[name] = source;
}

void ShaderLibrary::reload() {
  const std::lock_guard lock(mutex_);
  sources_.clear();
  own_names_.clear();
}

void ShaderLibrary::search(SearchPath path) {
  const std::lock_guard lock(mutex_);
  path_ = std::move(path);
}

std::vector<std::string> ShaderLibrary::names() const {
  std::vector<std::string> list;
  const auto add = [&](const fs::path& root) {
    for (auto& file : list_shader_files(root / "shaders"))
      if (!file.starts_with("lib/")) list.push_back(file.substr(0, file.size() - std::string_view(".glsl").size()));
  };
  for (const auto& root : path_.user) add(root);
  if (!path_.installation.empty()) add(path_.installation);
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

}  // namespace afterglow
