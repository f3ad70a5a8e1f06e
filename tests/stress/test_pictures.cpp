// SPDX-License-Identifier: MIT
// The pictures hold what they are named for, and are the same whenever they are made.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <set>

#include "core/half.h"
#include "stress/pictures.h"

namespace afterglow::stress {
namespace {

bool same_bits(const Image& a, const Image& b) {
  return a.pixels.size() == b.pixels.size() && std::memcmp(a.pixels.data(), b.pixels.data(), a.bytes()) == 0;
}

TEST(StressPictures, AreMadeFromSeedAlone) {
  for (const auto& kind : picture_kinds()) {
    const PictureSpec spec{kind.name, {23, 17}, 5};
    const Picture a = make_picture(spec), b = make_picture(spec);
    EXPECT_TRUE(same_bits(a.color, b.color)) << kind.name;
    for (const char* name : {"depth", "normal", "motion"})
      EXPECT_TRUE(same_bits(a.auxiliary.at(name), b.auxiliary.at(name))) << kind.name << " " << name;
  }
  EXPECT_FALSE(same_bits(make_picture({"render", {23, 17}, 5}).color, make_picture({"render", {23, 17}, 6}).color));
}

TEST(StressPictures, GentleOnesAreWithinWhatPromisesAreMeantFor) {
  for (const auto& kind : picture_kinds()) {
    if (!kind.gentle) continue;
    for (std::uint64_t seed = 0; seed < 20; ++seed)
      for (const float v : make_picture({kind.name, {19, 13}, seed}).color.pixels)
        ASSERT_TRUE(v >= 0 && v <= 1e6f) << kind.name << " " << v;
  }
}

TEST(StressPictures, HalvesHoldEveryHalfFloat) {
  const Picture picture = make_picture({"halves", {256, 256}, 3});
  std::set<std::uint16_t> seen;
  int nan = 0;
  for (std::size_t i = 0; i < picture.color.pixels.size(); i += 4) {
    nan += std::isnan(picture.color.pixels[i]);
    if (!std::isnan(picture.color.pixels[i])) seen.insert(half_from_float(picture.color.pixels[i]));
  }
  EXPECT_EQ(nan, 2 * 1023);
  // Infinities are held to the largest half by the conversion; all else comes back as it was.
  EXPECT_EQ(seen.size(), 65536u - 2 * 1023 - 2);
}

TEST(StressPictures, ASpikeComesToEveryPhaseOfThePyramid) {
  std::set<std::pair<int, int>> phases;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const Image image = make_picture({"spike", {64, 64}, seed}).color;
    int lit = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        if (image.at(x, y)[0] != 0) {
          EXPECT_EQ(image.at(x, y)[0], 1e6f);
          phases.insert({x % 8, y % 8});
          ++lit;
        }
    ASSERT_EQ(lit, 1);
  }
  EXPECT_EQ(phases.size(), 64u);
}

TEST(StressPictures, AGradientIsLessThanAnEightBitStep) {
  const Image image = make_picture({"gradient", {64, 64}, 9}).color;
  float low = 1e9f, high = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
    low = std::min(low, image.pixels[i]);
    high = std::max(high, image.pixels[i]);
  }
  EXPECT_GT(high, low);
  EXPECT_LE(high - low, 1.0f / 255);
}

TEST(StressPictures, WhatNoStackMayGetIsTakenOutByReading) {
  const auto folder = std::filesystem::path(testing::TempDir());
  for (const char* kind : {"halves", "extremes"}) {
    const Picture made = make_picture({kind, {64, 33}, 4});
    bool hostile = false;
    for (const float v : made.color.pixels) hostile |= !std::isfinite(v) || v < 0;
    EXPECT_TRUE(hostile);
    Diagnostics quiet;
    const auto read = as_read(made, folder, quiet);
    ASSERT_TRUE(read) << read.error().text();
    for (std::size_t i = 0; i < read->color.pixels.size(); ++i) {
      const float v = read->color.pixels[i];
      ASSERT_TRUE(std::isfinite(v) && (i % 4 == 3 || (v >= 0 && v <= 1e30f))) << v;
      const float was = made.color.pixels[i];
      if (i % 4 < 3 && was >= 0 && was <= 1e30f) {
        ASSERT_EQ(v, was < kSmallestColor ? 0 : was);
      }
    }
    for (const auto& [name, image] : read->auxiliary)
      for (const float v : image.pixels) ASSERT_TRUE(std::isfinite(v)) << name << " " << v;
  }
}

}  // namespace
}  // namespace afterglow::stress
