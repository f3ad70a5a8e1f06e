// SPDX-License-Identifier: MIT
// Files, whole: read, and written so that they appear whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/hash.h"
#include "core/result.h"

namespace afterglow {

class FileRecord;  // core/file_record.h

/// The whole file. Errors: io (missing, folder, unreadable, larger than `limit` bytes).
/// `record` takes the look down; one that keeps gives what was read before.
Result<std::string> read_file(const std::filesystem::path& path, std::size_t limit = 64u << 20,
                              FileRecord* record = nullptr);

/// What hash_text says of its content, whatever its size. Errors: as read_file.
Result<Hash> hash_file(const std::filesystem::path& path);

/// As read_file, for a file that a user has named: one that is not there is told as missing_file does.
Result<std::string> read_named_file(const std::filesystem::path& path, std::size_t limit = 64u << 20,
                                    FileRecord* record = nullptr);

/// Names of what lies in a folder ("": the working one), in order; none of one that cannot be read, the first 4096 that
/// are met of a larger one.
std::vector<std::string> names_in(const std::filesystem::path& folder);

/// io: what keeps it from being seen, or "no such file", with the nearest name in its folder when one is near. For a
/// frame of a sequence (its name holds a number of several digits) none is: it is missing, not misspelt.
Error missing_file(const std::filesystem::path& path);

/// Whether it says that there is no room left to write: a full disk, a quota that is used up.
bool is_disk_full(const Error& error);

/// Is there a file (links are followed)?
bool is_file(const std::filesystem::path& path, FileRecord* record = nullptr);

/// Writes to a temporary file beside `path`, then renames. On error nothing is left behind. Streams are written to as
/// they stand. Errors: io (a file that may not be written is not replaced, too).
Result<void> write_file_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace afterglow
