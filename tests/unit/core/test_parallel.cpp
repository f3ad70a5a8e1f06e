// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

#include "core/parallel.h"

namespace afterglow {
namespace {

TEST(ParallelFor, EachOnce) {
  for (const std::size_t count : {0u, 1u, 2u, 1000u}) {
    std::vector<std::atomic<int>> visits(count);
    parallel_for(count, [&](std::size_t i) { ++visits[i]; });
    for (const auto& visit : visits) EXPECT_EQ(visit, 1);
  }
}

TEST(ParallelFor, AnExceptionOfAnyThreadEndsTheLoop) {
  std::atomic<std::size_t> done{0};
  const auto work = [&](std::size_t i) {
    if (i % 2 == 1) throw std::runtime_error("odd");
    ++done;
  };
  EXPECT_THROW(parallel_for(1'000'000, work), std::runtime_error);
  EXPECT_LT(done, 500'000u);
}

}  // namespace
}  // namespace afterglow
