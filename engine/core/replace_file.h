// SPDX-License-Identifier: MIT
// Other content for a file that somebody owns: as an editor saves it.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "core/result.h"

namespace afterglow {

/// Replaces the content whole or not at all, and on disk before it appears. Links are followed: the file they lead to
/// is replaced and they stay. Mode bits are kept, and the owner as far as the user may. On error nothing is left
/// behind. `last_look`: asked when all but the renaming is done; its error is the result. Errors: io.
Result<void> replace_file_atomically(const std::filesystem::path& path, std::string_view content,
                                     const std::function<Result<void>()>& last_look = {});

}  // namespace afterglow
