// SPDX-License-Identifier: MIT
// Loops over threads, which are kept: to start one costs 20 µs, but 2 ms where many pictures are read and written at a
// time, as each needs the lock of the process's memory. They are the only global state.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace afterglow {

/// Calls work(i) for every i below `count`, each once, on up to as many threads as the machine has; the caller's is one
/// of them. An exception ends the loop as soon as what has begun is done; the first one is rethrown.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work);

/// The same for items that take long (to compile, say), on threads of its own, which begin with the caller's priority:
/// other loops would go without help meanwhile.
void parallel_tasks(std::size_t count, const std::function<void(std::size_t)>& work);

/// From now on nobody helps with the loops of this thread: for threads that give way to others.
void loop_alone();

/// Can so many more threads run at a time? They begin and end meanwhile. For libraries that start their own and wait
/// for ever, or end the program, where a limit forbids it (ulimit -u and -v, pids of a control group).
bool can_start_threads(std::size_t count);

/// Ranges of `parallel_rows` at most, and so threads.
inline constexpr int kMostRanges = 16;

/// Calls `work(begin, end)` for disjoint ranges that cover [0, rows), on several threads when `values` (samples in all)
/// is worth it. An exception of any of them is rethrown when those that had begun are done.
template <class Work>
void parallel_rows(int rows, long long values, const Work& work) {
  constexpr long long kValuesPerRange = 1 << 17;
  const long long ranges = std::max(std::min<long long>({values / kValuesPerRange, kMostRanges, rows}), 1ll);
  if (ranges == 1) return work(0, rows);
  const auto bound = [&](long long i) { return static_cast<int>(rows * i / ranges); };
  parallel_for(static_cast<std::size_t>(ranges), [&](std::size_t i) {
    const auto range = static_cast<long long>(i);
    work(bound(range), bound(range + 1));
  });
}

}  // namespace afterglow
