// SPDX-License-Identifier: MIT
// Wall time on the clock that never jumps, in milliseconds.
#pragma once

#include <chrono>

namespace afterglow {

using Clock = std::chrono::steady_clock;

inline double milliseconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

inline double milliseconds_since(Clock::time_point start) { return milliseconds_between(start, Clock::now()); }

}  // namespace afterglow
