// SPDX-License-Identifier: MIT
// Opens a file at a line in the user's editor.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace afterglow {

/// The words of a call. `command` is that of AFTERGLOW_EDITOR: {file} and {line} stand for themselves; where it has
/// neither, "+LINE FILE" follows, as vi, nano, emacs and gedit have it. Words are parted by blanks; quotes keep them.
/// Errors: usage (nothing in it, a quote that does not end).
Result<std::vector<std::string>> editor_call(const std::string& command, const std::filesystem::path& file, int line);

/// Starts what AFTERGLOW_EDITOR says, and does not wait for it. `line` 0: the first. Errors: usage (not set, as
/// editor_call), io (cannot be started).
Result<void> open_in_editor(const std::filesystem::path& file, int line);

}  // namespace afterglow
