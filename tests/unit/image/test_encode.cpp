// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <half.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "image/encode.h"
#include "image/srgb.h"

namespace afterglow {
namespace {

/// The nearest code in exact arithmetic (double is far finer than the distance of floats from a border).
long nearest_code(float linear, int max_code) {
  if (!(linear > 0)) return 0;
  return std::lround(std::floor(linear_to_srgb(std::min(static_cast<double>(linear), 1.0)) * max_code + 0.5));
}

class Srgb : public testing::TestWithParam<int> {};

TEST_P(Srgb, ExactAtEveryBorder) {
  const int max_code = GetParam();
  const CodeEncoder& encoder = CodeEncoder::srgb(max_code);
  for (int code = 1; code <= max_code; ++code) {
    // Floats on both sides of the border below `code`.
    const double border = srgb_to_linear((code - 0.5) / max_code);
    float f = static_cast<float>(border);
    for (int i = 0; i < 4; ++i) f = std::nextafter(f, 0.0f);
    for (int i = 0; i < 9; ++i, f = std::nextafter(f, 2.0f))
      ASSERT_EQ(encoder(f), nearest_code(f, max_code)) << "at " << f << " near code " << code;
  }
}

TEST_P(Srgb, EveryCodeComesBack) {
  const int max_code = GetParam();
  const std::vector<float> table = srgb_decode_table(max_code);
  for (int code = 0; code <= max_code; ++code)
    ASSERT_EQ(CodeEncoder::srgb(max_code)(table[static_cast<std::size_t>(code)]), static_cast<std::uint32_t>(code));
}

TEST_P(Srgb, AnyFloat) {
  const int max_code = GetParam();
  const CodeEncoder& encoder = CodeEncoder::srgb(max_code);
  std::mt19937 random(7);
  for (int i = 0; i < 300000; ++i) {
    const float f = std::bit_cast<float>(static_cast<std::uint32_t>(random() % 0x3f900000u));  // 0 … 1.125
    ASSERT_EQ(encoder(f), nearest_code(f, max_code)) << f;
  }
  const auto top = static_cast<std::uint32_t>(max_code);
  for (const float f : {1.0f, 1.5f, 1e30f, INFINITY}) EXPECT_EQ(encoder(f), top);
  for (const float f : {0.0f, -0.0f, -1.0f, -INFINITY, NAN, std::numeric_limits<float>::denorm_min()})
    EXPECT_EQ(encoder(f), 0u);
}
INSTANTIATE_TEST_SUITE_P(Codes, Srgb, testing::Values(255, 65535));

TEST(SrgbCurve, IsThatOfTheStandard) {
  EXPECT_NEAR(linear_to_srgb(0.21586050011389926), 128 / 255.0, 1e-9);
  for (const double value : {-0.18, 0.0, 0.001, 0.18, 1.0, 4.0})
    EXPECT_NEAR(srgb_to_linear(linear_to_srgb(value)), value, 1e-6);
}

TEST(Half, SameAsImathAndHeldInRange) {
  std::vector<float> values;
  std::mt19937 random(3);
  for (int i = 0; i < 100003; ++i) {  // odd, so that the tail is taken as well
    float f = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (std::isnan(f) || std::abs(f) > 65504) f = static_cast<float>(i);
    values.push_back(std::abs(f) > 65504 ? 1 : f);
  }
  std::vector<std::uint16_t> halves(values.size());
  EXPECT_EQ(to_half(values.data(), halves.data(), values.size()), 0u);
  for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(halves[i], Imath::half(values[i]).bits()) << values[i];

  for (const std::size_t count : {std::size_t{5}, std::size_t{8}, std::size_t{21}}) {
    std::vector<float> large(count, 65505.0f);
    large[0] = -INFINITY;
    large[1] = INFINITY;
    large[2] = 65504;
    large[3] = NAN;
    std::vector<std::uint16_t> out(count);
    EXPECT_EQ(to_half(large.data(), out.data(), count), count - 2);
    EXPECT_EQ(out[0], Imath::half(-65504.0f).bits());
    EXPECT_EQ(out[1], Imath::half(65504.0f).bits());
    EXPECT_EQ(out[4], Imath::half(65504.0f).bits());
    EXPECT_TRUE(std::isnan(static_cast<float>(Imath::half(Imath::half::FromBits, out[3]))));
  }
}

TEST(EncodeRow, StraightAlphaDividesInLinearLight) {
  // 0.25 linear under alpha ½ is 0.5 linear; alpha 0 keeps its colour; alpha above 1 is 1.
  const std::vector<float> rgba{0.25f, 0.5f, 0, 0.5f, 0.25f, 1, 0, 0, 0.5f, 0.5f, 0.5f, 2};
  std::vector<std::uint8_t> codes(12);
  encode_row({255, true, false}, rgba.data(), 3, 0, 0, codes.data());
  const auto srgb = [](double v) { return static_cast<std::uint8_t>(std::lround(linear_to_srgb(v) * 255)); };
  EXPECT_EQ(codes, (std::vector<std::uint8_t>{srgb(0.5), 255, 0, 128, srgb(0.25), 255, 0, 0, srgb(0.5), srgb(0.5),
                                              srgb(0.5), 255}));
  std::vector<std::uint8_t> opaque(9);
  encode_row({255, false, false}, rgba.data(), 3, 0, 0, opaque.data());
  EXPECT_EQ(opaque[0], srgb(0.25));
  EXPECT_EQ(opaque[3], srgb(0.25));
}

TEST(EncodeRow, DitherKeepsTheMeanAndTheEnds) {
  constexpr int kSide = 64;
  for (const double wanted : {0.0, 17.25, 100.5, 200.8, 255.0}) {
    const auto linear = static_cast<float>(srgb_to_linear(wanted / 255));
    std::vector<float> row(kSide * 4, linear);
    double sum = 0;
    std::set<int> seen;
    for (int y = 0; y < kSide; ++y) {
      std::vector<std::uint8_t> codes(kSide * 3), again(kSide * 3);
      encode_row({255, false, true}, row.data(), kSide, 0, y, codes.data());
      encode_row({255, false, true}, row.data(), kSide, 0, y, again.data());
      EXPECT_EQ(codes, again);
      for (const int c : codes) {
        sum += c;
        seen.insert(c);
      }
    }
    EXPECT_NEAR(sum / (kSide * kSide * 3), wanted, 1.0 / 64) << wanted;
    EXPECT_EQ(seen.size(), wanted == std::floor(wanted) ? 1u : 2u) << wanted;
  }
}

TEST(DisplayRow, CropsAndPads) {
  Picture picture;
  picture.color = Image(2, 2, 4);
  for (std::size_t i = 0; i < 16; ++i) picture.color.pixels[i] = static_cast<float>(i + 1);
  picture.data_window = {4, 7, 2, 2};
  picture.display_window = {3, 8, 2, 3};
  std::vector<float> row(8);
  display_row(picture, 0, 0, row.data());  // y = 8: the second row; x = 3 is outside, x = 4 its first pixel
  EXPECT_EQ(row, (std::vector<float>{0, 0, 0, 0, 9, 10, 11, 12}));
  display_row(picture, 1, 1, row.data());  // below the data
  EXPECT_EQ(row, (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1}));
  picture.display_window = {100, 8, 1, 1};  // apart
  display_row(picture, 0, 0, row.data());
  EXPECT_EQ(row[0], 0);
}

}  // namespace
}  // namespace afterglow
