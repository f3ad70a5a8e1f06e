// SPDX-License-Identifier: MIT
// Scopes against counting by hand, and against the definitions in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "image/srgb.h"
#include "play/scopes.h"

namespace afterglow {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

TEST(Scopes, CountWhatIsThere) {
  const std::vector<float> pixels{0.18f, 0.18f,     0.18f, 1,  //
                                  1,     0,         0,     1,  //
                                  4,     -1,        0.5f,  1,  //
                                  kNan,  1,         1,     1,  //
                                  1,     kInfinity, 1,     1,  //
                                  0,     0,         0,     1};
  const Scopes s = scopes_of(pixels, {3, 2});
  EXPECT_EQ(s.pixels, 6u);
  EXPECT_EQ(s.every, 1);
  EXPECT_EQ(s.columns, 3);
  EXPECT_EQ(s.nan, 1u);
  EXPECT_EQ(s.infinite, 1u);
  EXPECT_EQ(s.negative, 1u);
  EXPECT_EQ(s.above_one, 1u);
  EXPECT_EQ(s.most[0], 4);
  EXPECT_EQ(s.least[1], -1);
  EXPECT_EQ(s.histogram[0][118], 1u) << "sRGB of 0.18";
  EXPECT_EQ(s.histogram[0][255], 2u) << "1 and 4";
  EXPECT_EQ(s.at(Scopes::kRed, 0, 118), 1u);
  EXPECT_EQ(s.at(Scopes::kRed, 1, 255), 1u);
  EXPECT_EQ(s.at(Scopes::kRed, 2, 255), 1u);
  EXPECT_EQ(s.at(Scopes::kGreen, 2, 0), 2u) << "-1 and 0";
  for (const auto& channel : s.histogram)
    EXPECT_EQ(std::accumulate(channel.begin(), channel.end(), 0u), 4u) << "finite pixels alone";
  EXPECT_EQ(std::accumulate(s.colors.begin(), s.colors.end(), 0u), 4u);
  EXPECT_EQ(s.color_at(Scopes::kColors / 2, Scopes::kColors / 2), 2u) << "what has no colour lies in the middle";
}

TEST(Scopes, LevelsAreThoseOfTheirScale) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> stop(-9, 9);
  for (int i = 0; i < 2000; ++i) {
    const auto value = static_cast<float>(0.18 * std::exp2(stop(random)));
    const double v = value;
    const auto near = [&](ScopeScale scale, double part) {
      EXPECT_NEAR(scope_level(scale, value), 255 * std::clamp(part, 0.0, 1.0), 0.5001) << v;
    };
    near(ScopeScale::code, v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
    near(ScopeScale::linear, v);
    near(ScopeScale::stops, (std::log2(v / 0.18) + 8) / 16);
  }
  for (const ScopeScale scale : {ScopeScale::code, ScopeScale::linear, ScopeScale::stops}) {
    EXPECT_EQ(scope_level(scale, 0), 0);
    EXPECT_EQ(scope_level(scale, -3), 0);
    EXPECT_EQ(scope_level(scale, kNan), 0);
    EXPECT_EQ(scope_level(scale, 1e30f), 255);
  }
}

/// The primaries lie where Rec.709's matrix puts them.
TEST(Scopes, ColorsLieOnTheirPlane) {
  const auto red = scope_color({1, 0, 0}), blue = scope_color({0, 0, 1}), grey = scope_color({0.3, 0.3, 0.3});
  EXPECT_NEAR(red[0], -0.2126 / 1.8556, 1e-9);
  EXPECT_NEAR(red[1], 0.5, 1e-9);
  EXPECT_NEAR(blue[0], 0.5, 1e-9);
  EXPECT_NEAR(blue[1], -0.0722 / 1.5748, 1e-9);
  EXPECT_NEAR(std::hypot(grey[0], grey[1]), 0, 1e-12);
  const std::vector<float> pixel{1, 0, 0, 1};
  const Scopes s = scopes_of(pixel, {1, 1});
  EXPECT_EQ(s.color_at(static_cast<int>((red[0] + 0.5) * Scopes::kColors), Scopes::kColors - 1), 1u);
}

TEST(Scopes, ARegionIsAllThatCounts) {
  constexpr Size kSize{40, 30};
  std::vector<float> pixels;
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const bool inside = x >= 10 && x < 25 && y >= 5 && y < 9;
      pixels.insert(pixels.end(), {inside ? 0.25f : 9.0f, 0.5f, static_cast<float>(x), 1});
    }
  const Rect region{10, 5, 15, 4};
  const Scopes s = scopes_of(pixels, kSize, {.scale = ScopeScale::linear, .region = region});
  EXPECT_EQ(s.pixels, 60u);
  EXPECT_EQ(s.columns, 15);
  EXPECT_EQ(s.region, region);
  EXPECT_EQ(s.most[0], 0.25f);
  EXPECT_EQ(s.least[2], 10);
  EXPECT_EQ(s.most[2], 24);
  const RegionMean mean = mean_of(pixels, kSize, region);
  EXPECT_EQ(mean.pixels, 60u);
  EXPECT_EQ(mean.mean[0], 0.25);
  EXPECT_EQ(mean.mean[2], 17);
  EXPECT_EQ(scopes_of(pixels, kSize, {.region = Rect{-5, -5, 6, 6}}).pixels, 1u) << "what lies in the picture";
  EXPECT_EQ(scopes_of(pixels, kSize, {.region = Rect{40, 0, 6, 6}}).pixels, 0u);
  pixels[(5 * 40 + 10) * 4] = kNan;
  EXPECT_EQ(mean_of(pixels, kSize, region).pixels, 59u);
  EXPECT_EQ(mean_of(pixels, kSize, region).not_finite, 1u);
  EXPECT_EQ(mean_of(pixels, kSize, region).mean[0], 0.25);
}

TEST(Scopes, SampleLargePicturesAndSaySo) {
  const std::vector<float> pixels(100 * 50 * 4, 0.5f);
  const Scopes s = scopes_of(pixels, {100, 50}, {.most_pixels = 500});
  EXPECT_EQ(s.every, 4);
  EXPECT_EQ(s.pixels, 25u * 12);
  EXPECT_EQ(s.columns, 25);
  EXPECT_EQ(s.histogram[1][188], s.pixels);
  const std::vector<float> wide(1000 * 4, 0.5f);
  const Scopes w = scopes_of(wide, {1000, 1});
  EXPECT_EQ(w.columns, 256);
  for (int column = 0; column < w.columns; ++column) {
    EXPECT_GE(w.at(0, column, 188), 3u);
    EXPECT_LE(w.at(0, column, 188), 4u);
  }
}

TEST(Scopes, NothingInNothingOut) {
  EXPECT_EQ(scopes_of({}, {0, 0}).pixels, 0u);
  EXPECT_EQ(scopes_of({}, {10, 10}).pixels, 0u) << "fewer values than the size says";
  EXPECT_EQ(mean_of({}, {10, 10}, {0, 0, 5, 5}).pixels, 0u);
}

}  // namespace
}  // namespace afterglow
