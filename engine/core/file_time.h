// SPDX-License-Identifier: MIT
// How long a thread waits for files: what reads and writes them counts, what tells where time goes asks.
#pragma once

#include "core/stopwatch.h"

namespace afterglow {

/// Adds the time that it lives to its thread's.
class FileTime {
 public:
  FileTime() = default;
  ~FileTime() { of_thread() += milliseconds_since(start_); }
  FileTime(const FileTime&) = delete;
  FileTime& operator=(const FileTime&) = delete;

  /// Milliseconds of the calling thread so far.
  static double& of_thread() {
    thread_local double milliseconds = 0;
    return milliseconds;
  }

 private:
  Clock::time_point start_ = Clock::now();
};

}  // namespace afterglow
