// SPDX-License-Identifier: MIT
// Files that somebody still writes: which of them are whole.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "core/file_descriptor.h"
#include "core/hash.h"
#include "core/stopwatch.h"

namespace afterglow {

/// Whole are those that were closed by whoever wrote them or renamed into place, and those that nobody has touched for
/// two seconds (network file systems tell of nothing). Not thread-safe.
class WholeFiles {
 public:
  /// Of files in these folders, which are there; the empty name is the current folder.
  explicit WholeFiles(const std::set<std::filesystem::path>& folders);

  /// Waits a tenth of a second, or less where something happens; true if it did.
  bool wait();
  /// Size, times and number of a file as they are now; nothing while it is not whole, or not there.
  std::optional<Hash> whole(const std::filesystem::path& file);
  /// Whether there may be more of it to come although it looked whole: it was not moved to its name, and was written in
  /// the last ten seconds. Writers pause, and close files that they go on with.
  bool may_grow(const std::filesystem::path& file);

 private:
  struct File {
    Hash stamp, closed, moved;  ///< of the last look, and of the times when it was closed and came to its name
    Clock::time_point since;
    bool open = false;  ///< somebody on this machine writes it
  };
  bool is_whole(const std::filesystem::path& file, File& state);
  void take_events();

  FileDescriptor events_;
  std::map<int, std::set<std::filesystem::path>> folders_;  ///< by watch, as files name them
  std::map<std::filesystem::path, File> files_;
};

/// One hash of all these files by `stamp`, which says what one is like; nothing while it knows nothing of one of them.
template <class Stamp>
std::optional<Hash> stamp_of(const std::vector<std::filesystem::path>& files, const Stamp& stamp) {
  Hasher hasher;
  for (const auto& file : files) {
    const std::optional<Hash> one = stamp(file);
    if (!one) return std::nullopt;
    hasher.add(one->hex());
  }
  return hasher.finish();
}

}  // namespace afterglow
