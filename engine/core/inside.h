// SPDX-License-Identifier: MIT
// Where files really lie.
#pragma once

#include <filesystem>

namespace afterglow {

/// Does `file`, links followed, lie in `folder`, links followed? False when either is not there.
bool lies_in(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace afterglow
