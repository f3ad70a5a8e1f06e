// SPDX-License-Identifier: MIT
// --watch: inputs that a renderer still writes.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <vector>

#include "batch/run_report.h"
#include "core/file_descriptor.h"
#include "core/hash.h"
#include "core/stopwatch.h"

namespace afterglow {

/// Which files are whole: those that were closed by whoever wrote them or renamed into place, and those that nobody has
/// touched for two seconds (network file systems tell of nothing). Not thread-safe.
class InputWatch {
 public:
  explicit InputWatch(const FrameRecords& frames);

  /// Waits a tenth of a second, or less where something happens.
  void wait();
  /// One hash of all files that a frame is made from, as they are now; nothing while one of them is not whole.
  std::optional<Hash> whole(const FrameJob& job);

 private:
  struct File {
    Hash stamp, closed;  ///< of the last look, and of the time when it was closed
    Clock::time_point since;
    bool open = false;  ///< somebody on this machine writes it
  };
  bool is_whole(const std::filesystem::path& file, File& state);
  void take_events();

  FileDescriptor events_;
  std::map<int, std::set<std::filesystem::path>> folders_;  ///< by watch, as frames name them
  std::map<std::filesystem::path, File> files_;
};

}  // namespace afterglow
