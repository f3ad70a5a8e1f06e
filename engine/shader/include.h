// SPDX-License-Identifier: MIT
// Finds and reads the libraries that a shader includes. Internal to the room.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/paths.h"
#include "core/result.h"
#include "shader/library.h"
#include "shader/scan.h"

namespace afterglow {

inline constexpr std::size_t kMaxIncludes = 64;  ///< files of one shader
inline constexpr int kMaxIncludeDepth = 16;
inline constexpr std::size_t kMaxIncludeBytes = 2u << 20;  ///< of all files together

/// True for a name that stays below the folder it is looked up in: relative, no "..", no odd characters.
bool is_safe_name(const std::string& name);

/// What comes with a preset may not reach out of its folder by a link; an installation may be made of links. Errors:
/// script.
Result<void> check_inside(const SearchPath& search, const std::filesystem::path& file);

/// Reads one file of GLSL, without a byte order mark. Errors: script.
/// `record`: see read_file.
Result<std::string> read_shader(const std::filesystem::path& path, FileRecord* record);

/// Everything that a file with these includes sees, each file once, those that others need first. Errors (script):
/// missing file (with the nearest name), cycle, limits, a name that two files define; file and line are those of the
/// offending text.
Result<std::vector<ShaderSource::Include>> resolve_includes(const SearchPath& search, const std::filesystem::path& file,
                                                            const ShaderScan& scanned);

/// Names of .glsl files below `folder`, relative to it, sorted; at most a few thousand.
std::vector<std::string> list_shader_files(const std::filesystem::path& folder);

}  // namespace afterglow
