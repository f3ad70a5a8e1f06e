// SPDX-License-Identifier: MIT
// Tells when files may have changed, however they were saved.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace afterglow {

struct WatchOptions {
  bool poll = false;                        ///< never use inotify
  std::chrono::milliseconds interval{500};  ///< between two looks, where nothing tells of changes
};

/// Watches paths, not files: whatever takes or leaves the place that a path names counts, be it written in place,
/// replaced by another file, removed, created for the first time, or moved with a folder above it; links are followed
/// at every step. A path that does not exist is watched for its appearance. All functions are thread-safe.
class Watcher {
 public:
  /// When the first sign of a change is some milliseconds old (5; 100 while a file is still being written), and at
  /// least every `interval` where changes do not tell of themselves: polling, network file systems, no inotify or too
  /// few watches. `since`: when the first sign was seen. `polled`: there was no sign, it is only time. Called on the
  /// watcher's own thread; a call says "look again", not that something differs.
  using Look = std::function<void(std::chrono::steady_clock::time_point since, bool polled)>;
  Watcher(const WatchOptions& options, Look look);
  ~Watcher();  ///< no call comes after it
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  /// Watches these paths in place of those before. What happens after this call is noticed; look at the files once more
  /// behind it.
  void watch(const std::vector<std::filesystem::path>& paths);
  /// "inotify", or "polling every 500 ms: REASON".
  std::string method() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace afterglow
