// SPDX-License-Identifier: MIT
#include "shader/include.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <system_error>

#include "core/file.h"
#include "core/inside.h"
#include "core/text.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

class Resolver {
 public:
  Resolver(const SearchPath& search, const fs::path& root) : search_(search), root_(root.lexically_normal()) {}

  Result<std::vector<ShaderSource::Include>> run(const ShaderScan& scanned) {
    std::set<std::size_t> seen;
    AFTERGLOW_CHECK(follow(root_, scanned, 1, seen));
    AFTERGLOW_CHECK(check_names(root_.string(), scanned.names, {seen.begin(), seen.end()}));
    return std::move(includes_);
  }

 private:
  /// Adds what `file` includes; `seen` gains the indices of all that it sees.
  Result<void> follow(const fs::path& file, const ShaderScan& scanned, int depth, std::set<std::size_t>& seen) {
    for (const auto& line : scanned.includes) {
      AFTERGLOW_TRY(const fs::path path, locate(file, line));
      const std::string at = file.string();
      if (path == root_ || open_.contains(path))
        return shader_error(at, line.line, fmt::format("'{}' includes itself, directly or through others", line.name));
      const auto known = index_.find(path);
      if (known != index_.end()) {
        seen.insert(known->second);
        seen.insert(includes_[known->second].uses.begin(), includes_[known->second].uses.end());
        continue;
      }
      if (depth > kMaxIncludeDepth)
        return shader_error(at, line.line, fmt::format("includes are nested more than {} deep", kMaxIncludeDepth));
      auto added = add(path, line, depth);
      if (!added) {
        Error error = std::move(added).error();
        error.trail.push_back(fmt::format("included at {}:{}", at, line.line));
        return error;
      }
      const std::size_t index = *added;
      seen.insert(index);
      seen.insert(includes_[index].uses.begin(), includes_[index].uses.end());
    }
    return {};
  }

  Result<std::size_t> add(const fs::path& path, const IncludeLine& line, int depth) {
    ShaderSource::Include include{line.name, path, {}, {}, {}};
    AFTERGLOW_CHECK(check_inside(search_, path));
    AFTERGLOW_TRY(std::string text, read_shader(path, search_.record.get()));
    bytes_ += text.size();
    if (bytes_ > kMaxIncludeBytes)
      return shader_error(path.string(), 0,
                          fmt::format("the includes have more than {} bytes together", kMaxIncludeBytes));
    AFTERGLOW_TRY(include.file, scan_file(std::move(text), path.string(), ScanAs::library));
    const ShaderScan& scanned = include.file->scan;
    for (const auto& name : scanned.names) {
      include.global_names.push_back(name.name);
      if (name.macro) macros_[path].insert(name.name);
    }
    open_.insert(path);
    std::set<std::size_t> seen;
    AFTERGLOW_CHECK(follow(path, scanned, depth + 1, seen));
    open_.erase(path);
    include.uses.assign(seen.begin(), seen.end());
    AFTERGLOW_CHECK(check_names(path.string(), scanned.names, include.uses));
    if (includes_.size() >= kMaxIncludes)
      return shader_error(path.string(), 0, fmt::format("a shader includes at most {} files", kMaxIncludes));
    includes_.push_back(std::move(include));
    index_[path] = includes_.size() - 1;
    return includes_.size() - 1;
  }

  Result<fs::path> locate(const fs::path& from, const IncludeLine& line) const {
    const std::string at = from.string();
    if (!is_safe_name(line.name) || !line.name.ends_with(".glsl")) {
      Error error = shader_error(at, line.line, fmt::format("'{}' cannot be included", line.name));
      error.allowed = "the name of a .glsl file below a shaders folder, without '..'";
      return error;
    }
    // A bare name is first of all a file beside this one; a name with a folder is looked up like that of a shader, but
    // where this file comes from first: what lies beside a preset does not change what built-in shaders include.
    const fs::path beside = (from.parent_path() / line.name).lexically_normal();
    const bool bare = line.name.find('/') == std::string::npos;
    if (bare && is_file(beside, search_.record.get())) return beside;
    if (const auto hits = search_.find_shader(line.name, from); !hits.empty()) return hits.front().lexically_normal();
    if (is_file(beside, search_.record.get())) return beside;
    Error error = shader_error(at, line.line, fmt::format("cannot find the include '{}'", line.name));
    std::vector<std::string> names = list_shader_files(from.parent_path());
    for (const auto& folder : search_.user)
      for (auto& name : list_shader_files(folder / "shaders")) names.push_back(std::move(name));
    if (!search_.installation.empty())
      for (auto& name : list_shader_files(search_.installation / "shaders")) names.push_back(std::move(name));
    error.nearest = nearest_name(line.name, names);
    return error;
  }

  /// Names are made unique per file when shaders are fused, so one name must mean one thing in a file. (Macros may be
  /// defined again: the file's own hides the other.)
  Result<void> check_names(const std::string& file, const std::vector<GlobalName>& own,
                           const std::vector<std::size_t>& seen) const {
    std::map<std::string, std::size_t> from;
    for (const auto index : seen) {
      const auto& include = includes_[index];
      for (const auto& name : include.global_names) {
        if (is_macro(include, name)) continue;
        const auto [other, fresh] = from.emplace(name, index);
        if (!fresh)
          return shader_error(
              file, 0,
              fmt::format("'{}' is defined by both {} and {}", name, includes_[other->second].name, include.name));
      }
    }
    for (const auto& name : own)
      if (const auto other = from.find(name.name); other != from.end() && !name.macro)
        return shader_error(file, name.line,
                            fmt::format("'{}' is already defined by {}", name.name, includes_[other->second].name));
    return {};
  }

  bool is_macro(const ShaderSource::Include& include, const std::string& name) const {
    const auto macros = macros_.find(include.path);
    return macros != macros_.end() && macros->second.contains(name);
  }

  const SearchPath& search_;
  const fs::path root_;
  std::vector<ShaderSource::Include> includes_;
  std::map<fs::path, std::size_t> index_;
  std::map<fs::path, std::set<std::string>> macros_;
  std::set<fs::path> open_;  ///< files whose includes are being followed
  std::size_t bytes_ = 0;
};

}  // namespace

bool is_safe_name(const std::string& name) {
  if (name.empty() || name.size() > 256 || name.front() == '/') return false;
  for (const char c : name)
    if (static_cast<unsigned char>(c) < 0x20 || c == '\\' || c == ':' || c == 0x7f) return false;
  for (const auto& part : split(name, '/'))
    if (part.empty() || part == "." || part == "..") return false;
  return true;
}

Result<void> check_inside(const SearchPath& search, const fs::path& file) {
  for (const auto& root : search.user)
    if (is_named_in(file, root) && !lies_in(file, root))
      return shader_error(file.string(), 0, fmt::format("is a link that leads out of {}", root.string()));
  return {};
}

Result<std::string> read_shader(const fs::path& path, FileRecord* record) {
  auto text = read_file(path, kMaxShaderBytes, record);
  if (!text) {
    Error error = std::move(text).error();
    error.kind = ErrorKind::script;
    return error;
  }
  std::string content = std::move(text).value();
  if (content.starts_with("\xEF\xBB\xBF")) content.erase(0, 3);
  return content;
}

Result<std::vector<ShaderSource::Include>> resolve_includes(const SearchPath& search, const fs::path& file,
                                                            const ShaderScan& scanned) {
  return Resolver(search, file).run(scanned);
}

std::vector<std::string> list_shader_files(const fs::path& folder) {
  static constexpr int kMaxDepth = 4;
  static constexpr std::size_t kMaxFiles = 4096;
  std::vector<std::string> names;
  std::error_code ec;
  fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied, ec);
  for (std::size_t seen = 0; !ec && it != fs::recursive_directory_iterator() && seen < kMaxFiles;
       it.increment(ec), ++seen) {
    if (it.depth() >= kMaxDepth) it.disable_recursion_pending();
    std::error_code ignored;
    if (it->path().extension() == ".glsl" && it->is_regular_file(ignored))
      names.push_back(it->path().lexically_relative(folder).generic_string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace afterglow
