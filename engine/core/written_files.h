// SPDX-License-Identifier: MIT
// What a command writes must be nothing that it reads, nor what it writes elsewhere.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"

namespace afterglow {

/// What a file holds that another of its kind may take the place of.
enum class FileForm { any, json, dot, svg };

/// A file that is written by the wish of an option, besides the results.
struct SideFile {
  std::string option;          ///< "--report"
  std::filesystem::path file;  ///< empty, "-", a device or a pipe: takes no file's place
  FileForm form = FileForm::json;
};

/// Before any work: that no side file and no output would take the place of one that is read or of each other, and that
/// what lies where a side file goes is of its form and may be written, and its folder is there (but for `to_be_made`, a
/// folder that comes with the results) and takes files. Outputs may be the same file. Files within packs stand for the
/// packs. Errors: usage, io (may not be written).
Result<void> check_written(std::span<const SideFile> sides, std::span<const std::filesystem::path> outputs,
                           std::span<const std::filesystem::path> read, const std::filesystem::path& to_be_made = {});

}  // namespace afterglow
