// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

#include "core/parallel.h"

namespace afterglow {
namespace {

TEST(Parallel, EveryRowOnce) {
  for (const int rows : {0, 1, 2, 3, 17, 1000}) {
    std::vector<std::atomic<int>> visits(static_cast<std::size_t>(rows));
    parallel_rows(rows, 1ll << 40, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) ++visits[static_cast<std::size_t>(i)];
    });
    for (const auto& count : visits) EXPECT_EQ(count, 1);
  }
}

TEST(Parallel, ExceptionsComeOut) {
  std::atomic<int> done{0};
  const auto work = [&](int begin, int) {
    ++done;
    if (begin == 0) throw std::runtime_error("first");
  };
  EXPECT_THROW(parallel_rows(100, 1ll << 40, work), std::runtime_error);
  EXPECT_GE(done, 1);
}

}  // namespace
}  // namespace afterglow
