// SPDX-License-Identifier: MIT
// The made picture, and measures of quality.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bench/picture.h"
#include "bench/quality.h"
#include "core/half.h"

namespace afterglow::bench {
namespace {

TEST(BenchPicture, IsTheSameEveryTimeAndExactInHalves) {
  const Picture a = make_picture({161, 90}), b = make_picture({161, 90});
  EXPECT_EQ(a.color.pixels, b.color.pixels);
  for (const float v : a.color.pixels) {
    ASSERT_EQ(float_from_half(half_from_float(v)), v);
    ASSERT_GE(v, 0);
  }
}

TEST(BenchPicture, HasLightsAboveWhiteAndDepthAndUnitNormals) {
  const Picture p = make_picture({320, 180});
  EXPECT_GT(*std::ranges::max_element(p.color.pixels), 30);
  EXPECT_LT(std::ranges::count_if(p.color.pixels, [](float v) { return v > 1; }), 320 * 180 / 4);
  const auto& depth = p.auxiliary.at("depth").pixels;
  EXPECT_GT(*std::ranges::max_element(depth), *std::ranges::min_element(depth) + 5);
  const Image& normal = p.auxiliary.at("normal");
  for (int y = 0; y < 180; y += 7)
    for (int x = 0; x < 320; x += 7) {
      const float* n = normal.at(x, y);
      ASSERT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-5);
    }
}

TEST(Quality, PsnrOfAKnownDifference) {
  // Linear 1 and 0 are display 1 and 0: one of four values is off by 1, so that the mean square is 1/4.
  EXPECT_NEAR(display_psnr(std::vector<float>{1, 1, 0, 0}, std::vector<double>{1, 1, 0, 1}), 10 * std::log10(4), 1e-9);
  EXPECT_TRUE(std::isinf(display_psnr(std::vector<float>{2, 0.5f}, std::vector<double>{3, 0.5})));  // both white
  EXPECT_NEAR(display_psnr(std::vector<float>{0.5f}, std::vector<double>{0}),
              -20 * std::log10(1.055 * std::pow(0.5, 1 / 2.4) - 0.055), 1e-6);
}

TEST(Quality, WhatDiffersVisiblyIsSeen) {
  const Picture picture = make_picture({192, 108});
  std::vector<float> result;
  for (std::size_t i = 0; i < picture.color.pixels.size(); ++i)
    if (i % 4 != 3) result.push_back(picture.color.pixels[i]);
  const std::vector<double> truth(result.begin(), result.end());
  const Quality same = compare_pictures(result, truth, {192, 108});
  EXPECT_EQ(same.error.worst, 0);
  ASSERT_TRUE(same.visible);
  EXPECT_EQ(*same.visible, 0);
  for (int y = 20; y < 90; ++y)
    for (int x = 40; x < 150; ++x)
      result[(static_cast<std::size_t>(y) * 192 + x) * 3] += (x / 8 + y / 8) % 2 ? 0.5f : 0.0f;
  const Quality other = compare_pictures(result, truth, {192, 108});
  EXPECT_GT(other.error.percentile, 0.5);
  EXPECT_GT(*other.visible, 0.01);
}

}  // namespace
}  // namespace afterglow::bench
