// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "play/histogram.h"

namespace afterglow {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

TEST(Histogram, CountsWhatIsThere) {
  const std::vector<float> pixels{0.18f, 0.18f,     0.18f, 1,  //
                                  1,     0,         0,     1,  //
                                  4,     -1,        0.5f,  1,  //
                                  kNan,  1,         1,     1,  //
                                  1,     kInfinity, 1,     1,  //
                                  0,     0,         0,     1};
  const Histogram h = histogram_of(pixels, {3, 2});
  EXPECT_EQ(h.pixels, 6u);
  EXPECT_EQ(h.every, 1);
  EXPECT_EQ(h.nan, 1u);
  EXPECT_EQ(h.infinite, 1u);
  EXPECT_EQ(h.negative, 1u);
  EXPECT_EQ(h.above_one, 1u);
  EXPECT_EQ(h.most[0], 4);
  EXPECT_EQ(h.least[1], -1);
  EXPECT_EQ(h.display[0][118], 1u) << "sRGB of 0.18";
  EXPECT_EQ(h.display[0][255], 2u) << "1 and 4";
  EXPECT_EQ(h.stops[0][Histogram::kStopsBelow * Histogram::kBinsPerStop], 1u) << "middle grey: 0 EV";
  const auto stop_of = [](double value) {
    return static_cast<std::size_t>((std::log2(value / 0.18) + Histogram::kStopsBelow) * Histogram::kBinsPerStop);
  };
  EXPECT_EQ(h.stops[0][stop_of(4)], 1u);
  EXPECT_EQ(h.stops[3][stop_of(0.2126)], 2u) << "luminance of pure red, as bright as middle grey to a quarter stop";
  for (std::size_t c = 0; c < 4; ++c)
    EXPECT_EQ(std::accumulate(h.display[c].begin(), h.display[c].end(), 0u), 4u) << "finite pixels alone";
}

TEST(Histogram, SamplesLargePicturesAndSaysSo) {
  std::vector<float> pixels(100 * 50 * 4, 0.5f);
  const Histogram h = histogram_of(pixels, {100, 50}, 500);
  EXPECT_EQ(h.every, 4);
  EXPECT_EQ(h.pixels, 25u * 12);
  EXPECT_EQ(h.display[1][188], h.pixels);
}

TEST(Histogram, NothingInNothingOut) {
  EXPECT_EQ(histogram_of({}, {0, 0}).pixels, 0u);
  EXPECT_EQ(histogram_of({}, {10, 10}).pixels, 0u) << "fewer values than the size says";
}

}  // namespace
}  // namespace afterglow
