// SPDX-License-Identifier: MIT
// How much memory the test itself takes.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <fstream>

namespace afterglow {

/// Bytes of this process in memory.
inline std::size_t resident() {
  std::size_t pages = 0, ignored = 0;
  std::ifstream("/proc/self/statm") >> ignored >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace afterglow
