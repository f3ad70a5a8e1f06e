#include <cmath>

#include <gmock/gmock.h>

#include "images.h"
#include "reference/color.h"
#include "reference/color_adjustments.h"
#include "reference/color_blit.h"
#include "reference/tone_mapping.h"

namespace afterglow::reference {
namespace {

TEST(Gamma, ThreePieces) {
  EXPECT_NEAR(gamma_to_linear(0.5), 0.2140411, 5e-8);
  EXPECT_NEAR(gamma_to_linear(0.9), 0.7874123, 5e-8);
  EXPECT_EQ(gamma_to_linear(1), 1);
  EXPECT_NEAR(gamma_to_linear(1.5), 2.4400615, 5e-8);
  EXPECT_NEAR(gamma_to_linear(2), 4.5947934, 5e-8);
}

TEST(Srgb, RoundTripAlsoAboveOne) {
  for (double c : {0.0, 0.002, 0.0031308, 0.01, 0.5, 1.0, 7.5}) EXPECT_NEAR(srgb_to_linear(linear_to_srgb(c)), c, 1e-7 * c + 1e-12);
}

TEST(Logc, RoundTripAndLimits) {
  for (double c : {0.0, 0.01, 0.18, 1.0, 58.9}) EXPECT_NEAR(logc_to_linear(linear_to_logc(c)), c, 1e-12 + 1e-12 * c);
  EXPECT_NEAR(linear_to_logc(58.856633), 1, 1e-8);
  EXPECT_NEAR(logc_to_linear(kAcesccMidGray), 0.2247698, 5e-8);
  EXPECT_NEAR(logc_to_linear(linear_to_logc(-1)), -0.00863928, 1e-8) << "the logarithm is guarded";
}

TEST(Hsv, RoundTripIsGoodToEpsilon) {
  for (const auto& p : random_light({32, 32}, 7).pixels) {
    const Rgb c(p);
    EXPECT_LT(glm::length(hsv_to_rgb(rgb_to_hsv(c)) - c), 4e-4);
  }
  EXPECT_NEAR(hsv_to_rgb(rgb_to_hsv(Rgb(1, 0, 0))).g, 1e-4, 1e-8);
}

TEST(Hsv, RotateWrapsOnce) {
  EXPECT_EQ(rotate_hue(-0.25), 0.75);
  EXPECT_EQ(rotate_hue(1.25), 0.25);
  EXPECT_EQ(rotate_hue(1), 1);
  EXPECT_EQ(rotate_hue(0), 0);
}

TEST(ToneMapping, CurvesRiseAndStayInTheirRange) {
  for (const auto mode : {ToneMode::aces, ToneMode::neutral, ToneMode::reinhard}) {
    double before = -1;
    for (double x = 0; x < 60; x = x * 1.01 + 1e-4) {
      const double y = tone_map(Rgb(x), mode).g;
      EXPECT_GT(y, before - 1e-12) << x;
      EXPECT_GE(y, 0);
      EXPECT_LT(y, 1.2078);
      before = y;
    }
  }
}

TEST(ToneMapping, NeutralReachesWhereTheDocumentSays) {
  EXPECT_NEAR(tone_neutral(Rgb(4.0353708)).r, 1, 1e-8);
  EXPECT_NEAR(tone_neutral(Rgb(1e12)).r, 1.2258271, 1e-7);
}

TEST(ToneMapping, KeepsAlpha) {
  const auto image = random_light({5, 4}, 8);
  const auto out = tone_mapping(image, ToneMode::aces);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) EXPECT_EQ(out.pixels[i].a, image.pixels[i].a);
}

TEST(ColorAdjustments, NeutralIsTheSourceItself) {
  const auto image = map_color(random_light({8, 8}, 9), [](const Rgb& c) { return c * 10.0; });
  EXPECT_EQ(largest_difference(color_adjustments(image, {}), image), 0) << "no clamp to 60 either";
}

TEST(ColorAdjustments, ClampPrecedesExposure) { EXPECT_EQ(adjust_color(Rgb(100, 1, 0), {.post_exposure = 1}), Rgb(120, 2, 0)); }

TEST(ColorAdjustments, ContrastMinus100IsThePivotsGrey) {
  for (const auto& c : {Rgb(0), Rgb(-1, 0.5, 60), Rgb(3)}) {
    const auto out = adjust_contrast(c, 0);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(out[i], 0.2247698, 5e-8);
  }
}

TEST(ColorAdjustments, NegativesOfContrastAndSaturationEndAtZero) {
  EXPECT_EQ(adjust_color(Rgb(0), {.contrast = 50}), Rgb(0));
  EXPECT_EQ(adjust_color(Rgb(1, 0, 0), {.saturation = 50}).g, 0);
}

TEST(ColorAdjustments, FullDesaturationLeavesLuminance) {
  const Rgb c(3, 0.5, 0.25);
  const auto out = adjust_color(c, {.saturation = -100});
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(out[i], luminance(c), 1e-15);
}

TEST(ColorAdjustments, HueTurnsAndReturns) {
  const Rgb c(3, 0.5, 0.25);
  const auto there = shift_hue(c, 1.0 / 3);
  EXPECT_NEAR(there.g, 3, 1e-3) << "a third of a turn takes red to green";
  EXPECT_LT(glm::length(shift_hue(there, -1.0 / 3) - c), 1e-3);
}

TEST(ColorBlit, KeepsGreenAndClampsIntensity) {
  const DoubleImage image(1, 1, Rgba(1, 2, 3, 0.5));
  EXPECT_EQ(color_blit(image, 0.5).at(0, 0), Rgba(0, 1, 0, 0.5));
  EXPECT_EQ(color_blit(image, 9).at(0, 0), Rgba(0, 4, 0, 0.5));
  EXPECT_EQ(color_blit(image, 0).at(0, 0), image.at(0, 0));
}

}  // namespace
}  // namespace afterglow::reference
