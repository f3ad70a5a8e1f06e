// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "image/picture.h"
#include "image/plain_values.h"

namespace afterglow {
namespace {

TEST(PlainValues, OneOddValueIsSeenWhereverItStands) {
  using Limits = std::numeric_limits<float>;
  const std::vector<float> odd{Limits::quiet_NaN(),
                               -Limits::quiet_NaN(),
                               Limits::infinity(),
                               -Limits::infinity(),
                               -1e-30f,
                               -0.0f,
                               Limits::denorm_min(),
                               1.1e30f};
  const std::vector<float> fine{0.0f, kSmallestColor, 1.0f, 65504.0f, kLargestColor};
  for (std::size_t count = 1; count <= 70; ++count) {
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = fine[i % fine.size()];
    ASSERT_TRUE(all_plain(values.data(), count)) << count;
    for (std::size_t at = 0; at < count; ++at)
      for (const float value : odd) {
        const float kept = values[at];
        values[at] = value;
        ASSERT_FALSE(all_plain(values.data(), count)) << value << " at " << at << " of " << count;
        values[at] = kept;
      }
  }
  EXPECT_TRUE(all_plain(nullptr, 0));
}

}  // namespace
}  // namespace afterglow
