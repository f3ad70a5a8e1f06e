// SPDX-License-Identifier: MIT
// Packs: presets, effects and shaders together in a folder or a zip. Zips come from anywhere and are not trusted: they
// are looked through before anything is unpacked.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/result.h"

namespace afterglow {

/// What a zip may hold at most; more is refused.
struct PackLimits {
  std::uint64_t zip_bytes = 64u << 20;
  std::uint64_t file_bytes = 16u << 20;   ///< of one file, unpacked
  std::uint64_t total_bytes = 64u << 20;  ///< of all files, unpacked
  std::uint64_t ratio = 200;              ///< unpacked to packed, for files above 1 MiB
  std::size_t files = 4096;
  std::size_t depth = 8;  ///< folders in folders
};

/// May an entry of a zip have this name: relative, '/' between, no "." or "..", nothing that a system takes for more
/// than a name? Folders end in '/'.
bool is_safe_entry(const std::string& name, std::size_t depth);

/// Is it a file whose name ends in ".zip"?
bool is_zip(const std::filesystem::path& path);

/// Folder with the content of a zip: `cache`/packs/HASH/NAME.zip with the hash of name and content, unpacked when it is
/// not there whole. A folder around all of it, as of a folder that was zipped, is left out. Appears whole or not at
/// all; any number of processes may do it at once. Errors (script, the zip named): no zip, limits, names that climb
/// out, links, encryption, damage; io: the cache cannot be written.
Result<std::filesystem::path> open_zip(const std::filesystem::path& zip, const std::filesystem::path& cache,
                                       const PackLimits& limits = {});

/// The zip that `open_zip` has unpacked the file from, "NAME.zip"; empty: it lies in no such folder.
std::string pack_of(const std::filesystem::path& file, const std::filesystem::path& cache);

}  // namespace afterglow
