// SPDX-License-Identifier: MIT
// Files that become others when they are whole.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"

namespace afterglow {

/// A name in the same folder that no other process or thread uses, hidden and ending in the same extension (image
/// libraries choose the format by it): `.NAME.MACHINE-PROCESS-COUNT.tmp.EXT`, with the beginning of a long name.
std::filesystem::path temporary_beside(const std::filesystem::path& path);

/// The file that a link leads to at last, whether it is there or not; what is no link as it is. Of links that lead to
/// each other one of them.
std::filesystem::path behind_links(const std::filesystem::path& path);

/// Whether what is at `path` may be written, so that another may take its place; nothing may be there. (A folder lets
/// everybody who may write into it replace what others own or have made read-only.) Errors: io.
Result<void> check_replaceable(const std::filesystem::path& path);

/// Is it written to as it stands: a device, a pipe, what /dev/stdout, /dev/stderr, /dev/fd and /proc lead to?
bool is_stream(const std::filesystem::path& path);

/// What is written under such a name, a file or a folder. It is gone with this, whatever happens, unless it was
/// committed.
class Temporary {
 public:
  /// Of what is to become `target`; makes nothing yet. A link stays: the file that it leads to becomes another one.
  explicit Temporary(std::filesystem::path target);
  ~Temporary();
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Renames it over the target, whose permissions it takes. Errors: io (the target may not be written, too).
  Result<void> commit();

 private:
  std::filesystem::path named_, target_, path_;
  bool there_ = true;
};

/// Removes the last files of this process that have such names and have not become others. For signal handlers that end
/// the process: it takes no lock and no memory.
void remove_own_temporaries() noexcept;

/// Removes files with such names from `folder` whose processes ran on this machine and live no more: they were killed.
/// Returns how many.
int remove_abandoned_temporaries(const std::filesystem::path& folder);

/// What the names of this process's temporary files have in common: MACHINE-PROCESS.
std::string temporary_mark();

/// Removes the files of the process with that mark from `folder`, whichever machine it ran on; none if it is a process
/// of this machine that lives. Returns how many.
int remove_temporaries_of(const std::string& mark, const std::filesystem::path& folder);

}  // namespace afterglow
