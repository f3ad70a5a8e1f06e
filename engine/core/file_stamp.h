// SPDX-License-Identifier: MIT
// Whether a file is still the one that it was, as far as a look at it tells.
#pragma once

#include <filesystem>
#include <string>

namespace afterglow {

/// Its size, and the time of its last change in nanoseconds, as words; empty: it is not there. Renaming changes none.
std::string file_stamp(const std::filesystem::path& file);

}  // namespace afterglow
