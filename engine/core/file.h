// Files, whole: read, and written so that they appear whole or not at all. What is looked at is noted on the thread's
// FileTrace (core/file_trace.h), if it has one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.h"

namespace afterglow {

/// The whole file. Errors: io (missing, folder, unreadable, larger than `limit` bytes).
Result<std::string> read_file(const std::filesystem::path& path, std::size_t limit = 64u << 20);

/// Is there a file (links are followed)?
bool is_file(const std::filesystem::path& path);

/// Writes to a temporary file beside `path`, then renames. On error nothing is left behind.
Result<void> write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// Renames `from` over `to`; on failure removes `from`. Errors: io.
Result<void> commit_file(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace afterglow
