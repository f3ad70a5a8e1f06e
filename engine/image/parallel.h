// Rows of a picture shared out among a few threads. No pool, no global state: a thread start costs some 20 µs, a
// picture ms.
#pragma once

#include <algorithm>
#include <system_error>
#include <thread>
#include <vector>

namespace afterglow {

/// Calls `work(begin, end)` for disjoint ranges that cover [0, rows), on several threads when `values` (samples in all)
/// is worth it. `work` must not throw.
template <class Work>
void parallel_rows(int rows, long long values, const Work& work) {
  constexpr long long kValuesPerThread = 1 << 17;
  constexpr long long kMaxThreads = 16;
  const long long wanted = std::min<long long>(
      {static_cast<long long>(std::thread::hardware_concurrency()), values / kValuesPerThread, kMaxThreads, rows});
  const int threads = static_cast<int>(std::max(wanted, 1ll));
  const auto bound = [&](int i) { return static_cast<int>(static_cast<long long>(rows) * i / threads); };
  std::vector<std::jthread> helpers;
  int begin = 0;
  try {
    for (; begin + 1 < threads; ++begin)
      helpers.emplace_back([&work, first = bound(begin), last = bound(begin + 1)] { work(first, last); });
  } catch (const std::system_error&) {  // no more threads to be had: the rest is done here
  }
  work(bound(begin), rows);
}

}  // namespace afterglow
