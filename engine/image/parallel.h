// SPDX-License-Identifier: MIT
// Rows of a picture shared out among threads.
#pragma once

#include <algorithm>

#include "core/parallel.h"

namespace afterglow {

/// Calls `work(begin, end)` for disjoint ranges that cover [0, rows), on several threads when `values` (samples in all)
/// is worth it. An exception of any of them is rethrown when those that had begun are done.
template <class Work>
void parallel_rows(int rows, long long values, const Work& work) {
  constexpr long long kValuesPerRange = 1 << 17;
  constexpr long long kMostRanges = 16;
  const long long ranges = std::max(std::min<long long>({values / kValuesPerRange, kMostRanges, rows}), 1ll);
  if (ranges == 1) return work(0, rows);
  const auto bound = [&](long long i) { return static_cast<int>(rows * i / ranges); };
  parallel_for(static_cast<std::size_t>(ranges), [&](std::size_t i) {
    const auto range = static_cast<long long>(i);
    work(bound(range), bound(range + 1));
  });
}

}  // namespace afterglow
