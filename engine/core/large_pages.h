// SPDX-License-Identifier: MIT
// Memory for pictures in large pages: its first use then costs hundreds of times fewer page faults, which else take
// longer than what is done with the picture.
#pragma once

#include <cstddef>
#include <cstdint>

#if defined(__linux__)
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>
#endif

#include "core/release_memory.h"

namespace afterglow {

/// Advice about memory that has not been touched yet; nothing depends on it. What is smaller than a large page stays as
/// it is.
inline void use_large_pages(void* begin, std::size_t bytes) {
#if defined(__linux__)
  constexpr std::size_t kLarge = 2u << 20;
  if (bytes < kLarge) return;
  static const auto small = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  // From the page on in which it begins: large allocations begin with a few bytes of the C library's, at a place where
  // newer kernels (6.7) can put a large page.
  const auto address = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = address / small * small, last = (address + bytes + small - 1) / small * small;
  madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#else
  static_cast<void>(begin), static_cast<void>(bytes);
#endif
}

/// From here on all memory of this process that is touched for the first time comes in small pages, whoever asked for
/// large ones. For encoders of videos: they take hundreds of large pages one by one and gain nothing by them, and where
/// a virtual machine gives free memory back to its host, each of those is 4 ms.
inline void use_small_pages() {
#if defined(__linux__)
  prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);
#endif
}

/// As values.resize(count). What it holds may go where it is too small.
template <class Values>
void resize_for_picture(Values& values, std::size_t count) {
  if (values.capacity() < count) {
    release_memory(values);
    values.reserve(count);
    use_large_pages(values.data(), count * sizeof(values[0]));
  }
  values.resize(count);
}

}  // namespace afterglow
