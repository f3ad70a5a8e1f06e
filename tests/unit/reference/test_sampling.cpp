// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include "images.h"
#include "reference/resample.h"

namespace afterglow::reference {
namespace {

DoubleImage ramp(Size size) {
  return generate(size, [](int x, int y) { return Rgba(x + 0.5, y + 0.5, 3 * x - y, 1); });
}

TEST(Position, HalvingMeetsTexelCornersAndOddSizesDoNot) {
  for (int x = 0; x < 8; ++x) EXPECT_EQ(source_position(x, 16, 8), 2 * x + 1);
  EXPECT_EQ(source_position(0, 5, 2), 1.25);
  EXPECT_EQ(source_position(1, 5, 2), 3.75);
}

TEST(Linear, IsTheTexelAtItsCentreAndTheMeanAtACorner) {
  const auto image = random_light({6, 5}, 1);
  EXPECT_EQ(sample_linear(image, 2.5, 3.5), image.at(2, 3));
  const auto mean = (image.at(1, 1) + image.at(2, 1) + image.at(1, 2) + image.at(2, 2)) / 4.0;
  EXPECT_LT(glm::length(sample_linear(image, 2, 2) - mean), 1e-12);
}

TEST(Linear, ClampsToTheEdge) {
  const auto image = random_light({3, 2}, 2);
  EXPECT_EQ(sample_linear(image, -7, -9), image.at(0, 0));
  EXPECT_EQ(sample_linear(image, 3, 2), image.at(2, 1));
}

TEST(Linear, ReproducesRampsInside) {
  const auto p = sample_linear(ramp({9, 9}), 3.3, 5.8);
  EXPECT_NEAR(p.r, 3.3, 1e-12);
  EXPECT_NEAR(p.g, 5.8, 1e-12);
}

TEST(Bspline, WeightsAddUpAndAreNeverNegative) {
  for (double t : {0.0, 0.1, 0.25, 0.5, 0.75, 0.999}) {
    const auto w = bspline_weights(t);
    EXPECT_NEAR(w.x + w.y + w.z + w.w, 1, 1e-15);
    for (int i = 0; i < 4; ++i) EXPECT_GE(w[i], 0);
  }
}

TEST(Bspline, ReproducesConstantsEverywhereAndRampsInside) {
  const DoubleImage constant(4, 3, Rgba(2, 3, 4, 1));
  EXPECT_LT(glm::length(sample_bspline(constant, 0.1, 2.9) - constant.at(0, 0)), 1e-14);
  const auto p = sample_bspline(ramp({9, 9}), 4.2, 4.7);
  EXPECT_NEAR(p.r, 4.2, 1e-12);
  EXPECT_NEAR(p.b, 3 * (4.2 - 0.5) - (4.7 - 0.5), 1e-12);
}

TEST(Bspline, EqualsFourGroupedBilinearFetches) {  // the form in which the sources write it
  const auto image = random_light({7, 6}, 3);
  for (const auto& [px, py] : {std::pair{3.3, 2.9}, std::pair{0.2, 5.9}, std::pair{6.99, 0.01}}) {
    const double cx = std::floor(px + 0.5), cy = std::floor(py + 0.5);
    const auto wx = bspline_weights(px + 0.5 - cx), wy = bspline_weights(py + 0.5 - cy);
    Rgba sum(0);
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        const double gx = wx[2 * i] + wx[2 * i + 1], gy = wy[2 * j] + wy[2 * j + 1];
        sum += gx * gy *
               sample_linear(image, cx + (i ? 0.5 : -1.5) + wx[2 * i + 1] / gx,
                             cy + (j ? 0.5 : -1.5) + wy[2 * j + 1] / gy);
      }
    EXPECT_LT(glm::length(sum - sample_bspline(image, px, py)), 1e-12);
  }
}

TEST(Resample, SeparableTapsAreTheOuterProduct) {
  const auto image = random_light({11, 8}, 4);
  Filter separable{.interpolation = Interpolation::linear, .x = {{-1, 0.3}, {0.5, 0.7}}, .y = {{0, 0.4}, {2, 0.6}}};
  Filter flat{.interpolation = Interpolation::linear, .x = {}, .y = {}, .taps = {}};
  for (const auto& y : separable.y)
    for (const auto& x : separable.x) flat.taps.push_back({x.offset, y.offset, x.weight * y.weight});
  EXPECT_LT(largest_difference(resample(image, {5, 4}, separable), resample(image, {5, 4}, flat)), 1e-14);
  EXPECT_GT(largest_difference(resample(image, {5, 4}, separable), resample(image, {5, 4}, Filter{})), 1e-3);
}

TEST(Resample, NearestKeepsTexels) {
  const auto image = random_light({4, 4}, 5);
  const auto twice = resample(image, {8, 8}, Filter{.interpolation = Interpolation::nearest});
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) EXPECT_EQ(twice.at(x, y), image.at(x / 2, y / 2));
}

TEST(Resample, WeightsAreNotRenormalised) {
  const DoubleImage constant(4, 4, Rgba(1));
  const auto out = resample(constant, {2, 2}, Filter{.x = {{0, 2}, {1, 1}}, .y = {{0, 0.5}}});
  EXPECT_NEAR(out.at(1, 1).r, 1.5, 1e-14);
}

TEST(FromFloats, MissingChannelsAreZeroAndAlphaOne) {
  const float depth[] = {2, 3};
  const auto image = from_floats(depth, {2, 1}, 1);
  EXPECT_EQ(image.at(1, 0), Rgba(3, 0, 0, 1));
}

}  // namespace
}  // namespace afterglow::reference
