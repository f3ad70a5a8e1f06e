// Rows of a picture shared out among a few threads. No pool, no global state: a thread start costs some 20 µs, a
// picture ms.
#pragma once

#include <algorithm>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace afterglow {

/// Calls `work(begin, end)` for disjoint ranges that cover [0, rows), on several threads when `values` (samples in all)
/// is worth it. Rethrows the first exception of any of them when all are done.
template <class Work>
void parallel_rows(int rows, long long values, const Work& work) {
  constexpr long long kValuesPerThread = 1 << 17;
  constexpr long long kMaxThreads = 16;
  const long long wanted = std::min<long long>(
      {static_cast<long long>(std::thread::hardware_concurrency()), values / kValuesPerThread, kMaxThreads, rows});
  const int threads = static_cast<int>(std::max(wanted, 1ll));
  const auto bound = [&](int i) { return static_cast<int>(static_cast<long long>(rows) * i / threads); };

  std::mutex mutex;
  std::exception_ptr failure;
  const auto guarded = [&](int begin, int end) {
    try {
      work(begin, end);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> helpers;
    helpers.reserve(static_cast<std::size_t>(threads));
    int next = 0;
    try {
      for (; next + 1 < threads; ++next)
        helpers.emplace_back([&guarded, first = bound(next), last = bound(next + 1)] { guarded(first, last); });
    } catch (const std::system_error&) {  // no more threads to be had: the rest is done here
    }
    guarded(bound(next), rows);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace afterglow
