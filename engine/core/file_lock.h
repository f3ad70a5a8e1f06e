// SPDX-License-Identifier: MIT
// One at a time, of programs that change the same file.
#pragma once

#include <filesystem>

namespace afterglow {

/// Waits until no other holds the lock of this folder or file, and holds it while it lives; a process that dies lets
/// go. A file is made when it is not there. Where it cannot be locked (some network file systems) it locks nothing.
class FileLock {
 public:
  explicit FileLock(const std::filesystem::path& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace afterglow
