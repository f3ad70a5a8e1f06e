// SPDX-License-Identifier: MIT
// Names of files as scripts give them: folders of a search path and '/' between, as "luts/film.cube".
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/file_record.h"

namespace afterglow {

/// The file `name` in `folder`, in whichever form of Unicode its letters with marks are written there (decomposed.h).
/// Empty: there is none.
std::filesystem::path file_in(const std::filesystem::path& folder, const std::string& name, FileRecord* record);

/// Whether it is the name of a file inside of a folder, as scripts give it: is_safe_entry, eight folders deep at most.
bool is_tidy_path(const std::string& name);

/// What `name` may mean, for "did you mean": below one of `folders` a file with the same ending, whose folders and
/// whose own name are spelled like its. Letter case does not count. Empty: there is none.
std::string near_path(const std::vector<std::filesystem::path>& folders, const std::string& name);

/// The same name with '/' for '\', without "./", empty parts and blanks around. Empty: it is no name of a file inside
/// of a folder even so.
std::string tidy_path(const std::string& name);

}  // namespace afterglow
