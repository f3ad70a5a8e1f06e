// SPDX-License-Identifier: MIT
// The brightest value of a picture, by whichever instructions the processor has.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "exec/brightest.h"

namespace afterglow {
namespace {

float brightest(const std::vector<float>& row, int channels, Storage storage = Storage::fp32) {
  Brightest out;
  out.add_row(row.data(), channels, static_cast<int>(row.size()) / channels);
  return out.value(storage);
}

TEST(Brightest, FindsItWhereverItIs) {
  for (int width = 1; width < 20; ++width)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 4; ++c) {
        std::vector<float> row(static_cast<std::size_t>(width) * 4, 0.25f);
        row[static_cast<std::size_t>(x * 4 + c)] = 7.5f;
        EXPECT_EQ(brightest(row, 4), c == 3 ? 0.25f : 7.5f) << width << " " << x << " " << c;
      }
}

TEST(Brightest, IsUnknownWithValuesThatAreNoLight) {
  for (const float value : {std::nanf(""), -std::nanf(""), std::numeric_limits<float>::infinity(), -1.0f, -0.0f})
    for (std::size_t at = 0; at < 9 * 4; ++at) {
      std::vector<float> row(9 * 4, 0.5f);
      row[at] = value;
      EXPECT_EQ(std::isnan(brightest(row, 4)), at % 4 != 3) << value << " " << at;
    }
}

TEST(Brightest, TakesTheChannelsThereAre) {
  EXPECT_EQ(brightest({0.1f, 0.7f, 0.2f, 0.3f, 0.4f, 0.5f}, 3), 0.7f);
  EXPECT_EQ(brightest({0.1f, 0.9f, 0.2f}, 1), 0.9f);
  EXPECT_EQ(brightest({0.1f, 0.2f, 0.3f, 1, 9, 0.4f, 0.5f, 0.6f, 1, 9}, 5), 0.6f);
}

TEST(Brightest, OfHalfStorageIsWhatItHolds) {
  EXPECT_EQ(brightest({0.50001f, 0, 0, 1}, 4, Storage::fp16), 0.5f);
  EXPECT_EQ(brightest({1e9f, 0, 0, 1}, 4, Storage::fp16), 65504.0f);
  EXPECT_EQ(brightest({1e9f, 0, 0, 1}, 4, Storage::fp32), 1e9f);
}

TEST(Brightest, OfSeveralRowsIsTheLargest) {
  Brightest out;
  for (const float value : {0.1f, 0.8f, 0.3f}) out.add_row(std::vector<float>(8, value).data(), 4, 2);
  EXPECT_EQ(out.value(Storage::fp32), 0.8f);
}

TEST(Brightest, KnowsWhetherEveryAlphaIsOne) {
  const auto opaque = [](const std::vector<float>& row, int channels) {
    Brightest out;
    out.add_row(row.data(), channels, static_cast<int>(row.size()) / channels);
    return out.opaque();
  };
  for (int width = 1; width < 20; ++width) {
    std::vector<float> row(static_cast<std::size_t>(width) * 4, 1.0f);
    for (std::size_t i = 0; i < row.size(); ++i)
      if (i % 4 != 3) row[i] = 3.5f;
    EXPECT_TRUE(opaque(row, 4)) << width;
    for (const float value : {0.0f, 0.5f, std::nextafter(1.0f, 0.0f), std::nextafter(1.0f, 2.0f), -1.0f, std::nanf("")})
      for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
        std::vector<float> other = row;
        other[4 * x + 3] = value;
        EXPECT_FALSE(opaque(other, 4)) << width << " " << x << " " << value;
      }
  }
  EXPECT_TRUE(opaque({0.1f, 0.7f, 0.2f, 0.3f, 0.4f, 0.5f}, 3));
  EXPECT_FALSE(opaque({0.1f, 0.2f, 0.3f, 1, 9, 0.4f, 0.5f, 0.6f, 0.9f, 9}, 5));
}

}  // namespace
}  // namespace afterglow
