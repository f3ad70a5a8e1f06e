// SPDX-License-Identifier: MIT
// A process that gives up what it does not need, for good: before it reads what strangers have made.
#pragma once

#include <filesystem>
#include <vector>

#include "core/result.h"

namespace afterglow {

/// What is left of the file system; files or folders with all that is in them. What does not exist is passed over.
struct Confinement {
  std::vector<std::filesystem::path> list;  ///< folders: which files there are
  std::vector<std::filesystem::path> read;
  std::vector<std::filesystem::path> execute;  ///< and read
  std::vector<std::filesystem::path> write;    ///< and read, list, make, rename and remove
  std::vector<std::filesystem::path> devices;  ///< read and write what is there
};

/// From here on nothing but that can be opened, no file changed but by what is left to write, no socket can be made, no
/// program started, no other process looked into, signalled or talked to (Linux: Landlock and seccomp). The mode and
/// owner of an open file can still be changed. Threads that are there already are not restricted: none may be. Errors:
/// device (the kernel lacks it, or has it turned off), other (there are threads).
Result<void> confine(const Confinement& left);

}  // namespace afterglow
