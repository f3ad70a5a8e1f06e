// SPDX-License-Identifier: MIT
// Where files really lie.
#pragma once

#include <filesystem>
#include <vector>

namespace afterglow {

/// Does `file`, links followed, lie in `folder`, links followed? A file that is not there lies where it would be; in a
/// folder that is not there nothing lies.
bool lies_in(const std::filesystem::path& file, const std::filesystem::path& folder);

/// The same by their names alone: nothing is looked at, no link followed.
bool is_named_in(const std::filesystem::path& file, const std::filesystem::path& folder);

/// The folders, those that `file` is named in before all others, the deepest first. The others stay in order.
std::vector<std::filesystem::path> own_first(std::vector<std::filesystem::path> folders,
                                             const std::filesystem::path& file);

/// Absolute, without "." and ".." and a '/' at its end. Where ".." leads is asked of the system, for the folder before
/// it may be a link; other links keep their names.
std::filesystem::path whole_path(const std::filesystem::path& path);

}  // namespace afterglow
