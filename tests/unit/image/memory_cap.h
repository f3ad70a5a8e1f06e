// SPDX-License-Identifier: MIT
// A limit on memory while one thing is done.
#pragma once

#include <sys/resource.h>

#include <cstddef>
#include <fstream>

namespace afterglow {

/// Refuses allocations above 512 MiB more than are in use while it lives.
class MemoryCap {
 public:
  MemoryCap() {
    getrlimit(RLIMIT_AS, &before_);
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return;  // sanitizers reserve terabytes
#endif
    std::ifstream statm("/proc/self/statm");
    std::size_t pages = 0;
    statm >> pages;
    rlimit cap = before_;
    cap.rlim_cur = pages * 4096 + (512u << 20);
    setrlimit(RLIMIT_AS, &cap);
  }
  ~MemoryCap() { setrlimit(RLIMIT_AS, &before_); }

 private:
  rlimit before_{};
};

}  // namespace afterglow
