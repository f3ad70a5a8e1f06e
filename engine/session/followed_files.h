// SPDX-License-Identifier: MIT
// The files that a stack follows: what its last build has looked at, and what its frames have since. Internal to the
// room.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "core/file_record.h"
#include "core/watch.h"

namespace afterglow {

/// Of the thread on which stacks are built, but for `note_later`, which any thread may call, and `method`.
class FollowedFiles {
 public:
  /// Without `look` nothing is watched: `changed` alone says what differs.
  FollowedFiles(const WatchOptions& options, Watcher::Look look);

  /// Frames may read what the build did not: other passes at another time. Followed from `take_later` on.
  void note_later(FileProbes looks);
  void take_later();
  /// What a build has looked at, in place of all before. True when that has changed already, before it was watched.
  bool follow(FileProbes looks);

  /// Whether files are other than the last build has seen them.
  bool build_changed() const;
  /// The same, or than frames have seen theirs.
  bool changed() const;
  /// See Watcher; empty when nothing is watched.
  std::string method() const;

 private:
  void watch();

  const bool trust_stamps_;
  FileProbes build_, later_;
  std::mutex mutex_;
  FileProbes new_;  ///< with mutex_: not in `later_` yet
  std::unique_ptr<Watcher> watcher_;
};

}  // namespace afterglow
