// SPDX-License-Identifier: MIT
// Where files really lie.
#pragma once

#include <filesystem>

namespace afterglow {

/// Does `file`, links followed, lie in `folder`, links followed? A file that is not there lies where it would be; in a
/// folder that is not there nothing lies.
bool lies_in(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace afterglow
