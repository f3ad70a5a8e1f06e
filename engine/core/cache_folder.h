// SPDX-License-Identifier: MIT
// Folders of files that can be made again: kept from growing for ever.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

#include "core/result.h"

namespace afterglow {

/// Makes the folder where there is none. Errors (io): nothing can be kept there.
Result<void> make_cache_folder(const std::filesystem::path& folder);

struct CacheLimits {
  std::uint64_t bytes = 256u << 20;    ///< of all files together
  std::chrono::hours unused{24 * 60};  ///< files that nobody has used for so long go whatever their size
};

struct CacheTrim {
  int removed = 0;
  std::uint64_t bytes = 0;  ///< of the files that stay
};

/// Removes files of `folder` with this extension (".kernel"), those that were used longest ago first, until the rest is
/// within the limits; when it is beyond them in bytes, a quarter more, so that this is seldom. Files that others remove
/// or write meanwhile do no harm; what cannot be removed stays. `now`: for tests.
CacheTrim trim_cache(const std::filesystem::path& folder, const std::string& extension, const CacheLimits& limits = {},
                     std::filesystem::file_time_type now = std::filesystem::file_time_type::clock::now());

/// Notes that a file of a cache was used: its time is set to the present, at most once a day.
void note_cache_use(const std::filesystem::path& file);

}  // namespace afterglow
