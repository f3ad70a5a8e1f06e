// SPDX-License-Identifier: MIT
// Why a file that was written is not what was written into it.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "core/result.h"

namespace afterglow {

/// Its bytes do not lie there any more. The error has no file.
inline Error lost_file(const std::filesystem::path& file) {
  std::error_code ec;
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  const std::string what = !std::filesystem::exists(folder, ec) ? fmt::format("its folder {} is gone", folder.string())
                           : !std::filesystem::exists(file, ec) ? "somebody has removed it"
                                                                : "the file has lost bytes";
  return Error{ErrorKind::io, "cannot be written: " + what};
}

}  // namespace afterglow
