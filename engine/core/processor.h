// SPDX-License-Identifier: MIT
// What the processor can do beyond what the compiler was told to use.
#pragma once

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace afterglow {

/// Conversions between floats and half floats in hardware, and a system that keeps AVX registers. Asked by hand:
/// clang 14 does not know the name that gcc's __builtin_cpu_supports takes.
inline bool has_f16c() {
#if defined(__x86_64__)
  static const bool has = [] {
    unsigned a = 0, b = 0, c = 0, d = 0;
    return __builtin_cpu_supports("avx") && __get_cpuid(1, &a, &b, &c, &d) != 0 && (c & bit_F16C) != 0;
  }();
  return has;
#else
  return false;
#endif
}

/// For functions that are compiled for it (`__attribute__((target("avx2")))`).
inline bool has_avx2() {
#if defined(__x86_64__)
  static const bool has = __builtin_cpu_supports("avx2");
  return has;
#else
  return false;
#endif
}

}  // namespace afterglow
