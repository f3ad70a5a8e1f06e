// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "image/metrics.h"

namespace afterglow {
namespace {

TEST(Metrics, HandComputed) {
  const std::vector<float> x{1.0f, 2.5f, -0.5f, 0.0f};
  const std::vector<double> reference{1.0, 2.0, -0.5, 0.02};
  const ErrorMeasure error = measure_error(x, reference);
  // |2.5−2|/(2+0.01) = 0.248756…; |0−0.02|/(0.02+0.01) = 0.666…
  EXPECT_NEAR(error.worst, 2.0 / 3, 1e-12);
  EXPECT_EQ(error.worst_index, 3u);
  EXPECT_NEAR(error.rms, std::sqrt((0.24875621890547264 * 0.24875621890547264 + 4.0 / 9) / 4), 1e-12);
  EXPECT_NEAR(error.percentile, 2.0 / 3, 1e-6);  // of four samples, the 99.99th percentile is the worst
  EXPECT_EQ(error.non_finite, 0u);
}

TEST(Metrics, PercentileIgnoresOneInTenThousand) {
  std::vector<float> x(20000, 1.0f);
  const std::vector<float> reference(20000, 1.0f);
  x[7] = 2;
  x[8] = 3;
  EXPECT_EQ(measure_error(x, reference).percentile, 0);
  x[9] = 1.5f;  // the third is one too many
  EXPECT_NEAR(measure_error(x, reference).percentile, 0.5 / 1.01, 1e-6);
}

TEST(Metrics, NonFiniteIsInfinitelyWrong) {
  const std::vector<float> x{1, NAN, INFINITY};
  const std::vector<float> reference{1, 1, INFINITY};
  const ErrorMeasure error = measure_error(x, reference);
  EXPECT_EQ(error.non_finite, 2u);
  EXPECT_EQ(error.worst, INFINITY);
  EXPECT_EQ(error.worst_index, 1u);
  EXPECT_FALSE(within(error, 1e9));
}

TEST(Metrics, SizesMustMatch) {
  const std::vector<float> x{1, 2}, reference{1};
  EXPECT_EQ(measure_error(x, reference).worst, INFINITY);
  EXPECT_EQ(measure_error(std::vector<float>{}, std::vector<float>{}).worst, 0);
}

TEST(Metrics, WithinNeedsBothMarks) {
  EXPECT_TRUE(within({.worst = 5e-4, .percentile = 1e-5}, 1e-5));
  EXPECT_FALSE(within({.worst = 5.1e-4, .percentile = 1e-5}, 1e-5));
  EXPECT_FALSE(within({.worst = 2e-5, .percentile = 1.1e-5}, 1e-5));
}

}  // namespace
}  // namespace afterglow
