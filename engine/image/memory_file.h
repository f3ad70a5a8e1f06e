// SPDX-License-Identifier: MIT
// A file in memory that libraries open by its name.
#pragma once

#include <string>

#include "core/result.h"
#include "image/output_file.h"

namespace afterglow {

/// Lives as long as the object. For libraries that insist on opening files themselves, and do not survive, or do not
/// report, all that can go wrong with files on disks.
class MemoryFile {
 public:
  /// Errors: io.
  static Result<MemoryFile> create();
  MemoryFile(MemoryFile&& other) noexcept;
  MemoryFile& operator=(MemoryFile&& other) noexcept;
  ~MemoryFile();

  /// What to open, for reading and writing; within this process.
  const std::string& name() const { return name_; }
  /// Appends all of it. Errors: io (reading it; those of `out` are its own).
  Result<void> copy_to(OutputFile& out) const;

 private:
  explicit MemoryFile(int descriptor);
  int descriptor_ = -1;
  std::string name_;
};

}  // namespace afterglow
