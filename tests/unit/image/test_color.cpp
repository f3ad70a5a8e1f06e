// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "image/color_encoding.h"
#include "image/color_matrix.h"
#include "image/icc_profile.h"
#include "image/srgb.h"

namespace afterglow {
namespace {

TEST(ColorMatrix, KnownMatrices) {
  // IEC 61966-2-1: linear sRGB to XYZ under D65.
  const Matrix3 xyz{{{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}}};
  EXPECT_TRUE(nearly_equal(rgb_to_xyz(kRec709), xyz, 1e-4));
  EXPECT_TRUE(nearly_equal(to_rec709(kRec709), kIdentity, 1e-12));
  // ACEScg (AP1, D60) to Rec.709 with Bradford, as published with ACES.
  const Chromaticities ap1{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}};
  const Matrix3 expected{{{1.70505, -0.62179, -0.08326}, {-0.13026, 1.14080, -0.01055}, {-0.02400, -0.12897, 1.15297}}};
  EXPECT_TRUE(nearly_equal(to_rec709(ap1), expected, 2e-4));
}

TEST(ColorMatrix, WhiteStaysWhite) {
  const Chromaticities ap0{{0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}, {0.32168, 0.33767}};
  const Matrix3 m = to_rec709(ap0);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(m[i][0] + m[i][1] + m[i][2], 1, 1e-9);
}

TEST(ColorMatrix, NonsenseIsZero) {
  EXPECT_EQ(to_rec709({{0.3, 0.3}, {0.3, 0.3}, {0.3, 0.3}, {0.3127, 0.329}}), Matrix3{});
  EXPECT_EQ(to_rec709({{0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, {0.3, 0}}), Matrix3{});
  EXPECT_EQ(to_rec709({{NAN, 0.33}, {0.3, 0.6}, {0.15, 0.06}, {0.3127, 0.329}}), Matrix3{});
}

TEST(Sanitize, CountsAndMends) {
  std::vector<float> rgba{NAN, -1, INFINITY, NAN, -INFINITY, 2e30f, 0.5f, INFINITY, -0.0f, 1e30f, 7, -0.25f};
  ColorEncoding linear;
  linear.alpha = AlphaKind::associated;
  SanitizeCounts counts;
  decode_color(linear, rgba.data(), 3, counts);
  EXPECT_EQ(rgba, (std::vector<float>{0, 0, 1e30f, 1, 0, 1e30f, 0.5f, 1, 0, 1e30f, 7, -0.25f}));
  std::vector<float> heavy{1, 1, 1, 3e38f, 1, 1, 1, -1e30f};  // sums of such alphas would overflow
  SanitizeCounts of_heavy;
  decode_color(linear, heavy.data(), 2, of_heavy);
  EXPECT_EQ(heavy, (std::vector<float>{1, 1, 1, 1, 1, 1, 1, -1e30f}));
  EXPECT_EQ(of_heavy.alpha, 1u);
  EXPECT_EQ(counts.nan, 1u);
  EXPECT_EQ(counts.negative, 2u);
  EXPECT_EQ(counts.too_large, 2u);
  EXPECT_EQ(counts.alpha, 2u);
}

TEST(Sanitize, NanDoesNotSpreadThroughAMatrix) {
  std::vector<float> rgba{NAN, 1, 1, 1, INFINITY, -INFINITY, 1, 1};
  ColorEncoding wide;
  wide.alpha = AlphaKind::associated;
  wide.matrix = Matrix3{{{0.5, 0.25, 0.25}, {0.25, 0.5, 0.25}, {0.25, 0.25, 0.5}}};
  SanitizeCounts counts;
  decode_color(wide, rgba.data(), 2, counts);
  EXPECT_FLOAT_EQ(rgba[0], 0.5f);
  EXPECT_FLOAT_EQ(rgba[1], 0.75f);
  EXPECT_FLOAT_EQ(rgba[4], 5e29f);  // the −infinity beside it counts as 0
  for (const float v : rgba) EXPECT_TRUE(std::isfinite(v));
  EXPECT_EQ(counts.nan, 1u);
}

TEST(Sanitize, DepthAndNormals) {
  Image depth(3, 1, 1), normal(2, 1, 3);
  depth.pixels = {INFINITY, -5, NAN};
  normal.pixels = {0, NAN, 1, 0, -1, 0};
  SanitizeCounts counts;
  sanitize_depth(depth, counts);
  sanitize_normal(normal, counts);
  EXPECT_EQ(depth.pixels, (std::vector<float>{1e10f, -5, 1e10f}));
  EXPECT_EQ(normal.pixels, (std::vector<float>{0, 0, 0, 0, -1, 0}));
  EXPECT_EQ(counts.depth, 2u);
  EXPECT_EQ(counts.normal, 1u);
}

TEST(Decode, EveryCodeIsTheFormulasValue) {
  for (const int max_code : {255, 65535}) {
    ColorEncoding srgb;
    srgb.curve = TransferCurve::srgb;
    srgb.max_code = max_code;
    std::vector<float> rgba(static_cast<std::size_t>(max_code + 1) * 4);
    for (int i = 0; i <= max_code; ++i)
      for (int c = 0; c < 3; ++c)
        rgba[static_cast<std::size_t>(i) * 4 + c] = static_cast<float>(i) * (1.0f / static_cast<float>(max_code));
    SanitizeCounts counts;
    decode_color(srgb, rgba.data(), rgba.size() / 4, counts);
    for (int i = 0; i <= max_code; ++i)
      ASSERT_EQ(rgba[static_cast<std::size_t>(i) * 4 + 1],
                static_cast<float>(srgb_to_linear(static_cast<double>(i) / max_code)))
          << i;
  }
}

TEST(Decode, AlphaKinds) {
  ColorEncoding encoding;
  encoding.curve = TransferCurve::srgb;
  encoding.max_code = 255;
  SanitizeCounts counts;
  const float half = 128 / 255.0f;
  // Straight: decode, then multiply.
  encoding.alpha = AlphaKind::straight;
  std::vector<float> straight{half, 1, 0, half};
  decode_color(encoding, straight.data(), 1, counts);
  EXPECT_NEAR(straight[0], srgb_to_linear(128 / 255.0) * 128 / 255, 1e-6);
  EXPECT_NEAR(straight[1], 128 / 255.0, 1e-6);
  // Associated integers: stored = encoded · alpha.
  encoding.alpha = AlphaKind::associated;
  std::vector<float> associated{64 / 255.0f, half, 0, half};
  decode_color(encoding, associated.data(), 1, counts);
  EXPECT_NEAR(associated[0], srgb_to_linear(0.5) * 128 / 255, 2e-5);
  EXPECT_NEAR(associated[1], 128 / 255.0, 1e-6);
  // None: opaque whatever was there.
  encoding.alpha = AlphaKind::none;
  std::vector<float> opaque{1, 1, 1, 0};
  decode_color(encoding, opaque.data(), 1, counts);
  EXPECT_EQ(opaque[3], 1);
}

TEST(Icc, SrgbProfileIsSrgb) {
  const std::vector<std::uint8_t> profile = srgb_icc_profile();
  ASSERT_GT(profile.size(), 128u);
  EXPECT_EQ(profile, srgb_icc_profile());
  ColorEncoding encoding;
  encoding.max_code = 255;
  ASSERT_TRUE(use_icc_profile(profile, 3, encoding));
  EXPECT_EQ(encoding.curve, TransferCurve::srgb);
  EXPECT_FALSE(encoding.matrix);
}

TEST(Icc, DamagedProfilesChangeNothing) {
  ColorEncoding encoding;
  encoding.curve = TransferCurve::srgb;
  encoding.max_code = 255;
  std::vector<std::uint8_t> profile = srgb_icc_profile();
  for (std::size_t size = 0; size < profile.size(); size += 37) {
    const auto used = use_icc_profile({profile.data(), size}, 3, encoding);
    if (!used) {
      EXPECT_EQ(encoding.curve, TransferCurve::srgb) << size;
    }
  }
  EXPECT_FALSE(use_icc_profile({profile.data(), 100}, 3, encoding));
  EXPECT_FALSE(use_icc_profile({}, 3, encoding));
}

}  // namespace
}  // namespace afterglow
