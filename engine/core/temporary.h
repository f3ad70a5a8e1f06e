// SPDX-License-Identifier: MIT
// Files that become others when they are whole.
#pragma once

#include <filesystem>
#include <string>

namespace afterglow {

/// A name in the same folder that no other process or thread uses, hidden and ending in the same extension (image
/// libraries choose the format by it): `.NAME.MACHINE-PROCESS-COUNT.tmp.EXT`.
std::filesystem::path temporary_beside(const std::filesystem::path& path);

/// Removes the last files of this process that have such names and have not become others. For signal handlers that end
/// the process: it takes no lock and no memory.
void remove_own_temporaries() noexcept;

/// Removes files with such names from `folder` whose processes ran on this machine and live no more: they were killed.
/// Returns how many.
int remove_abandoned_temporaries(const std::filesystem::path& folder);

/// What the names of this process's temporary files have in common: MACHINE-PROCESS.
std::string temporary_mark();

/// Removes the files of the process with that mark from `folder`, whichever machine it ran on. It must be known to live
/// no more. Returns how many.
int remove_temporaries_of(const std::string& mark, const std::filesystem::path& folder);

}  // namespace afterglow
