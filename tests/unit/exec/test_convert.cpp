// SPDX-License-Identifier: MIT
// Pixels between floats and halves, and rows over threads.
#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "core/half.h"
#include "core/parallel.h"
#include "exec/convert.h"

namespace afterglow {
namespace {

/// The nearest half by search: the definition of rounding, with ties to the even one.
std::uint16_t nearest_half(float value) {
  const double v = std::abs(static_cast<double>(value));
  std::uint16_t best = 0;
  double distance = std::numeric_limits<double>::infinity();
  for (std::uint16_t bits = 0; bits <= kMaxHalfBits; ++bits) {
    const double d = std::abs(static_cast<double>(float_from_half(bits)) - v);
    if (d < distance || (d == distance && bits % 2 == 0)) best = bits, distance = d;
  }
  return std::signbit(value) ? best | 0x8000 : best;
}

TEST(Half, KnownValues) {
  EXPECT_EQ(half_from_float(0.0f), 0x0000);
  EXPECT_EQ(half_from_float(-0.0f), 0x8000);
  EXPECT_EQ(half_from_float(1.0f), 0x3c00);
  EXPECT_EQ(half_from_float(-2.0f), 0xc000);
  EXPECT_EQ(half_from_float(65504.0f), kMaxHalfBits);
  EXPECT_EQ(half_from_float(0x1p-24f), 0x0001);
  EXPECT_EQ(half_from_float(0x1p-25f), 0x0000);      // a tie: to even
  EXPECT_EQ(half_from_float(0x1.8p-24f), 0x0002);    // a tie: to even
  EXPECT_EQ(half_from_float(1 + 0x1p-11f), 0x3c00);  // ties between normal halves
  EXPECT_EQ(half_from_float(1 + 0x1.8p-10f), 0x3c02);
  EXPECT_EQ(half_from_float(-1 - 0x1.8p-10f), 0xbc02);
  EXPECT_EQ(half_from_float(1 + 0x1.1p-11f), 0x3c01);  // just above a tie
  EXPECT_EQ(float_from_half(0x3555), 0.333251953125f);
}

TEST(Half, EveryHalfComesBack) {
  for (int bits = 0; bits < 0x10000; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    const float value = float_from_half(half);
    if (std::isnan(value) || std::isinf(value)) continue;
    EXPECT_EQ(half_from_float(value), half);
  }
}

TEST(Half, RoundsToTheNearest) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> exponent(-27, 16);
  for (int i = 0; i < 300; ++i) {
    const float value = std::exp2(exponent(random)) * (i % 2 ? -1.0f : 1.0f);
    if (std::abs(value) > kMaxHalf) continue;
    EXPECT_EQ(half_from_float(value), nearest_half(value)) << value;
  }
}

TEST(Half, BothWaysOfConvertingAgree) {
  std::mt19937 random(6);
  std::vector<float> values(100003);
  for (auto& value : values) value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
  std::vector<std::uint16_t> halves(values.size());
  const auto held = halves_from_floats(values.data(), values.size(), halves.data());
  std::uint64_t expected_held = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) {
      EXPECT_TRUE(std::isnan(float_from_half(halves[i])));
      continue;
    }
    EXPECT_EQ(halves[i], half_from_float(values[i])) << values[i];
    expected_held += std::abs(values[i]) > kMaxHalf;
  }
  EXPECT_EQ(held, expected_held);
  EXPECT_GT(held, 0u);
  std::vector<float> back(values.size());
  const auto at_limit = floats_from_halves(halves.data(), halves.size(), back.data());
  EXPECT_GE(at_limit, held);
  for (std::size_t i = 0; i < back.size(); ++i) {
    if (std::isnan(back[i])) continue;
    EXPECT_EQ(back[i], float_from_half(halves[i]));
  }
}

TEST(Half, LargeValuesAreHeldAndCounted) {
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<float> values{65504, 65505, -1e9f, inf, -inf, 65519, 0, 1, -65504};
  std::vector<std::uint16_t> halves(values.size());
  EXPECT_EQ(halves_from_floats(values.data(), values.size(), halves.data()), 5u);
  EXPECT_EQ(halves, (std::vector<std::uint16_t>{0x7bff, 0x7bff, 0xfbff, 0x7bff, 0xfbff, 0x7bff, 0, 0x3c00, 0xfbff}));
  std::vector<float> back(values.size());
  EXPECT_EQ(floats_from_halves(halves.data(), halves.size(), back.data()), 7u);
}

TEST(PackRow, WidensAndNarrows) {
  const std::vector<float> grey{1, 2, 3}, rgb{1, 2, 3, 4, 5, 6}, rgba{1, 2, 3, 4, 5, 6, 7, 8};
  std::vector<float> out(12, -1);
  auto* bytes = reinterpret_cast<std::byte*>(out.data());
  pack_row(grey.data(), 1, 3, VK_FORMAT_R32_SFLOAT, bytes);
  EXPECT_EQ(out, (std::vector<float>{1, 2, 3, -1, -1, -1, -1, -1, -1, -1, -1, -1}));
  pack_row(rgba.data(), 4, 2, VK_FORMAT_R32_SFLOAT, bytes);
  EXPECT_EQ(out[0], 1);
  EXPECT_EQ(out[1], 5);
  pack_row(rgb.data(), 3, 2, VK_FORMAT_R32G32B32A32_SFLOAT, bytes);
  EXPECT_EQ(out, (std::vector<float>{1, 2, 3, 1, 4, 5, 6, 1, -1, -1, -1, -1}));
  pack_row(grey.data(), 1, 2, VK_FORMAT_R32G32B32A32_SFLOAT, bytes);
  EXPECT_EQ(out, (std::vector<float>{1, 0, 0, 1, 2, 0, 0, 1, -1, -1, -1, -1}));
}

TEST(PackRow, LongRowsOfHalvesComeBack) {
  constexpr int kWidth = 1000;
  std::vector<float> rgb(kWidth * 3);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<float>(i % 2000);
  rgb[5] = 1e6f;
  std::vector<std::byte> row(kWidth * 8);
  EXPECT_EQ(pack_row(rgb.data(), 3, kWidth, VK_FORMAT_R16G16B16A16_SFLOAT, row.data()), 1u);
  std::vector<float> back(kWidth * 4);
  EXPECT_EQ(unpack_row(row.data(), VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, back.data()), 1u);
  rgb[5] = kMaxHalf;
  for (int x = 0; x < kWidth; ++x) {
    for (int c = 0; c < 3; ++c) ASSERT_EQ(back[4 * x + c], rgb[3 * x + c]) << x;
    ASSERT_EQ(back[4 * x + 3], 1.0f);
  }
}

TEST(OverRows, EveryRowOnceWhateverTheSize) {
  for (const int rows : {1, 2, 7, 1000}) {
    for (const std::size_t bytes : {16u, 1u << 20}) {
      std::vector<std::atomic<int>> seen(rows);
      const auto sum = over_rows(rows, bytes, [&](int y) {
        ++seen[y];
        return static_cast<std::uint64_t>(y);
      });
      EXPECT_EQ(sum, static_cast<std::uint64_t>(rows) * (rows - 1) / 2);
      for (const auto& count : seen) EXPECT_EQ(count, 1);
    }
  }
}

/// Across chunks, from floats and halves; what is not there is as readers of such an image find it.
TEST(Convert, FewChannelsAreWidened) {
  constexpr int kWidth = 601;
  const auto value = [](int i) { return static_cast<float>(i % 2048) * 0.25f - 100; };
  std::vector<float> floats(2 * kWidth);
  std::vector<std::uint16_t> halves(floats.size());
  for (std::size_t i = 0; i < floats.size(); ++i) floats[i] = value(static_cast<int>(i));
  halves_from_floats(floats.data(), floats.size(), halves.data());
  struct Case {
    VkFormat format;
    int channels;
    const void* from;
  };
  for (const Case& of :
       {Case{VK_FORMAT_R32_SFLOAT, 1, floats.data()}, Case{VK_FORMAT_R32G32_SFLOAT, 2, floats.data()},
        Case{VK_FORMAT_R16_SFLOAT, 1, halves.data()}, Case{VK_FORMAT_R16G16_SFLOAT, 2, halves.data()}}) {
    std::vector<float> rgba(4 * kWidth, -1);
    EXPECT_EQ(unpack_row(static_cast<const std::byte*>(of.from), of.format, kWidth, rgba.data()), 0u);
    for (int x = 0; x < kWidth; ++x) {
      const float* pixel = &rgba[static_cast<std::size_t>(x) * 4];
      EXPECT_EQ(pixel[0], value(of.channels * x));
      EXPECT_EQ(pixel[1], of.channels == 2 ? value(2 * x + 1) : 0);
      EXPECT_EQ(pixel[2], 0);
      EXPECT_EQ(pixel[3], 1);
    }
  }
  halves[5] = 0xfbff;  // -65504
  std::vector<float> rgba(4 * kWidth);
  EXPECT_EQ(unpack_row(reinterpret_cast<const std::byte*>(halves.data()), VK_FORMAT_R16_SFLOAT, kWidth, rgba.data()),
            1u);
}

}  // namespace
}  // namespace afterglow
