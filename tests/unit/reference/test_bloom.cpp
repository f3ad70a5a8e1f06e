// SPDX-License-Identifier: MIT
// Properties that math.md §3–§5 and §9 list.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "images.h"
#include "reference/bloom.h"
#include "reference/box_bloom.h"

namespace afterglow::reference {
namespace {

const Size kSizes[] = {{64, 64}, {101, 57}, {17, 9}, {8, 8}, {240, 135}};

double brightest(const Rgb& c) { return glm::max(c.r, glm::max(c.g, c.b)); }

TEST(Threshold, ShapeOfTheKnee) {
  const BloomThreshold threshold{2, 0.5};
  EXPECT_EQ(threshold(Rgb(1)), Rgb(0)) << "nothing below t(1-k)";
  EXPECT_GT(threshold(Rgb(1.01)).r, 0);
  EXPECT_NEAR(threshold(Rgb(2)).r, 2 * 0.5 / 4, 1e-5) << "T(t) = tk/4";
  EXPECT_NEAR(threshold(Rgb(3)).r, 1, 1e-5) << "b - t from t(1+k) on";
  EXPECT_EQ(threshold(Rgb(10)).r, 8);
}

TEST(Threshold, NeverBrightensAndRisesWithBrightness) {
  for (const double t : {0.0, 0.5, 1.0, 4.0})
    for (const double k : {0.0, 0.3, 1.0}) {
      double before = 0;
      for (double b = 0; b < 20; b += 0.01) {
        const double out = brightest(BloomThreshold{t, k}(Rgb(b, b / 2, 0)));
        EXPECT_LE(out, b + 1e-12);
        EXPECT_GE(out, before - 1e-4 * b);  // s reaches b − t but for the ε in its denominator
        before = out;
      }
    }
}

TEST(Threshold, ZeroKeepsColoursAndHardKneeCuts) {
  EXPECT_EQ((BloomThreshold{0, 0.5}(Rgb(0.25, 0.5, 1))), Rgb(0.25, 0.5, 1));
  EXPECT_EQ((BloomThreshold{1, 0}(Rgb(1))), Rgb(0));
  EXPECT_EQ((BloomThreshold{1, 0}(Rgb(1.5))), Rgb(0.5));
}

TEST(Sizes, OfThePyramid) {
  const std::vector<Size> expected{{960, 540}, {480, 270}, {240, 135}, {120, 67}, {60, 33},
                                   {30, 16},   {15, 8},    {7, 4},     {3, 2}};
  EXPECT_EQ(bloom_sizes({1920, 1080}, 16, 2), expected);
  EXPECT_EQ(bloom_sizes({1920, 1080}, 3, 2).size(), 4u);
  EXPECT_TRUE(bloom_sizes({1920, 1080}, 0, 2).empty());
  EXPECT_TRUE(bloom_sizes({7, 64}, 16, 2).empty()) << "half of 7 is below twice the limit";
  EXPECT_EQ(bloom_sizes({8, 8}, 16, 2).size(), 2u) << "at least one level when it runs";
  EXPECT_TRUE(bloom_sizes({3, 3}, 16, 1).empty());
  EXPECT_EQ(bloom_sizes({4, 5}, 16, 1).size(), 2u);
}

TEST(Bloom, AdditiveOnAConstant) {
  for (const Size size : kSizes)
    for (const bool bicubic : {false, true})
      for (const bool fireflies : {false, true}) {
        const BloomSettings settings{
            .threshold = 0.7, .intensity = 0.6, .bicubic_upsampling = bicubic, .fade_fireflies = fireflies};
        const Rgba c(3, 2, 0.5, 0.25);
        const auto out = bloom(DoubleImage(size, c), settings);
        const double levels = static_cast<double>(out.vertical.size());
        const Rgb expected = Rgb(c) + 0.6 * levels * BloomThreshold::from_gamma(0.7, 0.5)(Rgb(c));
        EXPECT_LT(largest_difference(out.result, DoubleImage(size, Rgba(expected, c.a))), 1e-5);
      }
}

TEST(Bloom, ScatterKeepsAConstant) {
  for (const Size size : kSizes)
    for (const double threshold : {0.0, 0.8, 3.0}) {
      const BloomSettings settings{.mode = BloomMode::scattering, .threshold = threshold, .intensity = 2};
      const DoubleImage image(size, Rgba(4, 2, 1, 0.5));
      EXPECT_LT(largest_difference(bloom(image, settings).result, image), 1e-6);
    }
}

TEST(Bloom, ScatterIntensityIsCapped) {
  const auto image = random_light({32, 32}, 3);
  const auto with = [&](double intensity) {
    return bloom(image, {.mode = BloomMode::scattering, .intensity = intensity}).result;
  };
  EXPECT_EQ(largest_difference(with(0.95), with(50)), 0);
  EXPECT_GT(largest_difference(with(0.95), with(0.9)), 1e-3);
}

TEST(Bloom, WeightsOfTheLevels) {
  // Levels that are constants 1, 2, 4, 8: the combination shows each level's weight, here (1−s)s^k with s = ½.
  const double values[] = {1, 2, 4, 8};
  DoubleImage low({4, 4}, Rgba(values[3]));
  for (int i = 2; i >= 0; --i) {
    const DoubleImage high({4 << (3 - i), 4 << (3 - i)}, Rgba(values[i]));
    low = bloom_scatter(bloom_up(low, high.size(), true), high, 0.5);
  }
  EXPECT_NEAR(low.at(3, 3).r, 0.5 * 1 + 0.25 * 2 + 0.125 * 4 + 0.125 * 8, 1e-12);
}

TEST(Bloom, IsLinearWithoutThreshold) {
  const auto a = random_light({50, 41}, 4), b = random_light({50, 41}, 5);
  auto sum = a;
  for (std::size_t i = 0; i < sum.pixels.size(); ++i)
    sum.pixels[i] = Rgba(Rgb(a.pixels[i]) + 2.0 * Rgb(b.pixels[i]), 1);
  const BloomSettings settings{.threshold = 0, .knee = 0};
  const auto ra = bloom(a, settings).result, rb = bloom(b, settings).result, rs = bloom(sum, settings).result;
  for (std::size_t i = 0; i < sum.pixels.size(); ++i)
    EXPECT_LT(glm::length(Rgb(rs.pixels[i]) - Rgb(ra.pixels[i]) - 2.0 * Rgb(rb.pixels[i])), 1e-10);
}

TEST(Bloom, TurningThePictureTurnsTheResult) {
  for (const Size size : kSizes) {
    const auto image = random_light(size, 6);
    for (const auto mode : {BloomMode::additive, BloomMode::scattering}) {
      const BloomSettings settings{.mode = mode, .threshold = 0.4, .fade_fireflies = true};
      EXPECT_LT(largest_difference(bloom(turned(image), settings).result, turned(bloom(image, settings).result)), 1e-9);
    }
  }
}

TEST(Bloom, BinomialWeightsEqualTheMergedOnes) {
  static constexpr int kBinomial[] = {924, 792, 495, 220, 66};
  const auto image = random_light({9, 33}, 7);
  const auto merged = bloom_vertical(image);
  const auto plain = generate(image.size(), [&](int x, int y) {
    Rgba sum(0);
    for (int i = -4; i <= 4; ++i) sum += kBinomial[std::abs(i)] / 4070.0 * image.clamped(x, y + i);
    return sum;
  });
  EXPECT_LT(largest_difference(merged, plain), 43 * 3e-8 * 4);
}

TEST(Bloom, FirefliesFade) {
  // Weighted mean of 0, 0, 0, 10 is 10/34 (math.md §4): here over the five samples, one of which is 10.
  DoubleImage image(8, 8, Rgba(0, 0, 0, 1));
  for (int y = 2; y < 4; ++y)
    for (int x = 2; x < 4; ++x) image.at(x, y) = Rgba(10, 10, 10, 1);
  const auto out = bloom_prefilter_fireflies(image, BloomThreshold{0, 0});
  EXPECT_NEAR(out.at(1, 1).r, (10.0 / 11) / (4 + 1.0 / 11), 1e-6);
  EXPECT_NEAR(out.at(0, 0).r, (10.0 / 11) / (4 + 1.0 / 11), 1e-6) << "reached from the diagonal";
  EXPECT_EQ(out.at(1, 0).r, 0) << "but not from beside";
}

TEST(Bloom, SkipsLeaveTheSource) {
  const auto image = random_light({32, 32}, 8);
  for (const auto& settings :
       {BloomSettings{.max_iterations = 0}, BloomSettings{.intensity = 0}, BloomSettings{.downscale_limit = 9}}) {
    const auto out = bloom(image, settings);
    EXPECT_FALSE(out.ran);
    EXPECT_EQ(largest_difference(out.result, image), 0);
  }
}

TEST(BoxBloom, FootprintOfOneHalving) {
  // Which source texels a target pixel sees, in sixteenths (math.md §9).
  static constexpr int kPlus[4][4] = {{0, 1, 1, 0}, {1, 2, 2, 1}, {1, 2, 2, 1}, {0, 1, 1, 0}};
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      DoubleImage image(8, 8, Rgba(0));
      image.at(x + 1, y + 1) = Rgba(16);
      EXPECT_NEAR(box_bloom_blur(image, {4, 4}, BoxPattern::plus).at(1, 1).r, kPlus[y][x], 1e-12);
      EXPECT_NEAR(box_bloom_blur(image, {4, 4}, BoxPattern::box).at(1, 1).r, 1, 1e-12);
    }
}

TEST(BoxBloom, OnAConstant) {
  const Rgba c(3, 1, 0.5, 0.5);
  for (const int n : {0, 1, 2, 4}) {
    const auto out = box_bloom(DoubleImage(40, 23, c), {.threshold = 1, .blur_iterations = n});
    const double times = std::max(n - 1, 1);
    const Rgb expected = Rgb(c) + times * box_bloom_threshold(Rgb(c), 1, BoxBrightness::max);
    EXPECT_LT(largest_difference(out.result, DoubleImage(40, 23, Rgba(expected, c.a))), 1e-12) << n;
  }
}

TEST(BoxBloom, StopsBeforeAnEmptySize) {
  EXPECT_EQ(box_bloom(random_light({5, 3}, 1), {.blur_iterations = 7}).down.size(), 2u);
  EXPECT_EQ(box_bloom(random_light({1, 1}, 1), {.blur_iterations = 7}).down.size(), 1u);
}

TEST(BoxBloom, BrightnessBySetting) {
  const Rgb blue(0, 0, 2);
  EXPECT_EQ(box_bloom_threshold(blue, 1, BoxBrightness::max), Rgb(0, 0, 1));
  EXPECT_EQ(box_bloom_threshold(blue, 1, BoxBrightness::luma), Rgb(0));
}

}  // namespace
}  // namespace afterglow::reference
