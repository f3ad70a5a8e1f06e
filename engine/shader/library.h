// SPDX-License-Identifier: MIT
// Finds, reads and scans shader files by name along a search path. In-process cache; no compiler, no device.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/hash.h"
#include "core/paths.h"
#include "core/result.h"
#include "shader/interface.h"

namespace afterglow {

struct ShaderFile;

/// One file of GLSL with its includes resolved.
struct ShaderSource {
  std::string name;  ///< as `find` was asked for it, without ".glsl": "glow/threshold"
  std::filesystem::path path;
  std::shared_ptr<const ShaderFile> file;  ///< its text, as the author wrote it
  ShaderInterface interface;
  /// Libraries it includes, directly or through others, each once, in the order in which they must stand.
  struct Include {
    std::string name;  ///< as written in #include
    std::filesystem::path path;
    std::shared_ptr<const ShaderFile> file;
    std::vector<std::size_t> uses;          ///< indices into `includes` of what it sees: its own includes and theirs
    std::vector<std::string> global_names;  ///< as below
  };
  std::vector<Include> includes;
  std::vector<std::string>
      global_names;    ///< identifiers and macros that the file defines at file scope (renamed when shaders are fused)
  Hash hash;           ///< of text and includes
  bool loops = false;  ///< it or a library of it has a loop
  bool open_loops = false;              ///< one of them is no `for`: it never becomes straight code
  bool keeps_state = false;             ///< it or a library of it has variables at file scope that functions may write
  std::optional<int> fixed_alpha_line;  ///< where it returns an alpha that is a number, if it returns nothing else

  std::optional<int> level_line;  ///< where it asks for a level of an image that may not be 0

  std::vector<std::filesystem::path> files() const;  ///< path and those of the includes
};

/// Thread-safe. Sources are immutable and shared; `reload` drops what changed on disk.
class ShaderLibrary {
 public:
  explicit ShaderLibrary(SearchPath path) : path_(std::move(path)) {}

  /// What a script's passes are to ask `find` for: the name, or "NAME@FOLDER" where the script's own folder of the search
  /// path has a shader of the name and another one would be found.
  std::string own_name(const std::string& name, const std::filesystem::path& script);

  /// Finds "NAME.glsl", or the file that `own_name` has given a name to, or what was made under that name (SearchPath::made). Errors (script): unknown name (with the
  /// nearest), syntax of declarations, missing include, include cycle, neither or both of apply/sample_at; file and
  /// line are those of the offending text.
  Result<std::shared_ptr<const ShaderSource>> find(const std::string& name);

  /// The compiler's error of an unknown function or variable, with the library below shaders/lib/ that has it, or with
  /// the nearest of the names that its file knows. Other errors come back as they are. Reads files of the search path.
  Error with_known_names(Error error) const;

  void reload();                 ///< forget everything read so far
  void search(SearchPath path);  ///< from now on; what was read stays. Not while others use the library
  const SearchPath& path() const { return path_; }

  /// Names that `find` knows, sorted: every .glsl file below a shaders/ folder but those in lib/. Reads folders, not
  /// files.
  std::vector<std::string> names() const;

 private:
  SearchPath path_;
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const ShaderSource>> sources_;
  std::map<std::pair<std::string, std::filesystem::path>, std::string> own_names_;  ///< by name and script
  std::map<std::string, std::filesystem::path> own_files_;  ///< by what own_name gave; scripts name no others
};

}  // namespace afterglow
