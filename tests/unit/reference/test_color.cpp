// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

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
  for (double c : {0.0, 0.002, 0.0031308, 0.01, 0.5, 1.0, 7.5})
    EXPECT_NEAR(srgb_to_linear(linear_to_srgb(c)), c, 1e-7 * c + 1e-12);
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
    EXPECT_LT(glm::length(hsv_to_rgb(rgb_to_hsv(c, kUnityHsvEpsilon)) - c), 4e-4);
    EXPECT_LT(glm::length(hsv_to_rgb(rgb_to_hsv(c, kNoHsvEpsilon)) - c), 1e-14 * glm::length(c));
  }
  EXPECT_NEAR(hsv_to_rgb(rgb_to_hsv(Rgb(1, 0, 0), kUnityHsvEpsilon)).g, 1e-4, 1e-8);
  for (const double grey : {0.0, 0.18}) EXPECT_EQ(hsv_to_rgb(rgb_to_hsv(Rgb(grey), kNoHsvEpsilon)), Rgb(grey));
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

/// ACES once more, by another way: hue from the half angle instead of atan2, glow as one clamp, surround as a factor of
/// all of XYZ.
Rgb aces_by_another_way(const Rgb& x) {
  Rgb a(glm::dot(x, Rgb(0.4397010, 0.3829780, 0.1773350)), glm::dot(x, Rgb(0.0897923, 0.8134230, 0.0967616)),
        glm::dot(x, Rgb(0.0175440, 0.1115440, 0.8707040)));
  const double low = std::min({a.r, a.g, a.b}), high = std::max({a.r, a.g, a.b});
  const double saturation = (std::max(high, 1e-4) - std::max(low, 1e-4)) / std::max(high, 1e-2);
  const double chroma =
      std::sqrt(((a.r - a.g) * (a.r - a.g) + (a.g - a.b) * (a.g - a.b) + (a.b - a.r) * (a.b - a.r)) / 2);
  const double h = std::min(2.5 * saturation - 1, 1.0);
  const double glow = (0.025 + 0.025 * h * (2 - std::abs(h))) *
                      std::clamp(0.24 / (a.r + a.g + a.b + 1.75 * chroma + 1e-300) - 0.5, 0.0, 1.0);
  const double half_angle = std::atan2(std::sqrt(3.0) * std::abs(a.g - a.b), 2 * chroma + 2 * a.r - a.g - a.b);
  const double ramp = std::max(0.0, 1 - half_angle * 2 / (67.5 * std::numbers::pi / 180));
  const double weight = std::pow(ramp * ramp * (3 - 2 * ramp), 2);
  a *= 1 + glow;
  a.r += weight * saturation * 0.18 * (0.03 - a.r);
  Rgb c = glm::max(Rgb(glm::dot(a, Rgb(1.4514393161, -0.2365107469, -0.2149285693)),
                       glm::dot(a, Rgb(-0.0765537734, 1.1762296998, -0.0996759264)),
                       glm::dot(a, Rgb(0.0083161484, -0.0060324498, 0.9977163014))),
                   Rgb(0));
  c = 0.96 * c + 0.04 * glm::dot(c, Rgb(0.272229, 0.674082, 0.0536895));
  c = (2.785085 * c + 0.107772) * c / ((2.936045 * c + 0.887122) * c + 0.806889);
  const double luma = glm::dot(c, Rgb(0.2722287168, 0.6740817658, 0.0536895174));
  const double missing = std::max(1e-4 - glm::dot(c, Rgb(0.9291082484, 0.8121467058, 1.2202163047)), 0.0);
  const double surround = std::pow(std::max(luma, 1e-300), -0.0189) * std::min(luma * 1e8, 1.0);
  return surround * (Rgb(glm::dot(c, Rgb(1.60475401, -0.5310794904, -0.07367229607)),
                         glm::dot(c, Rgb(-0.1020831623, 1.108132314, -0.00605155829)),
                         glm::dot(c, Rgb(-0.003267022729, -0.07275523321, 1.076021917))) +
                     missing * Rgb(-0.4611197491, 0.0367219018, 1.063087824));
}

TEST(ToneMapping, AcesAgreesWithAnotherDerivation) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> exponent(-7, 1.78);
  for (int i = 0; i < 20000; ++i) {
    const Rgb c(std::pow(10, exponent(generator)), std::pow(10, exponent(generator)),
                std::pow(10, exponent(generator)));
    for (const auto& x : {c, Rgb(c.r), Rgb(c.r, c.g, c.g), Rgb(c.r, c.r, c.b)})
      EXPECT_LT(glm::length(tone_aces(x) - aces_by_another_way(x)), 3e-8) << x.r << " " << x.g << " " << x.b;
  }
}

TEST(ToneMapping, NeutralReachesWhereTheDocumentSays) {
  EXPECT_NEAR(tone_neutral(Rgb(4.0353708)).r, 1, 1e-8);
  EXPECT_NEAR(tone_neutral(Rgb(1e12)).r, 1.2258271, 1e-7);
}

// What the authors' own pages and listings say of their curves.
TEST(ToneMapping, NewerCurvesAreWhereTheirSourcesHaveThem) {
  // Reinhard's equation 4: white becomes 1, greys far below it y/(1 + y).
  EXPECT_NEAR(tone_reinhard_extended(Rgb(4), 4).r, 1, 1e-6);  // the weights of luminance add up to 1.0000001
  EXPECT_NEAR(tone_reinhard_extended(Rgb(1), 1e6).g, 0.5, 1e-6);
  const Rgb red = tone_reinhard_extended(Rgb(2, 0.5, 0.1), 4);  // ratios stay
  EXPECT_NEAR(red.r / red.g, 4, 1e-12);
  // PBR Neutral: below 0.8 a colour loses the 4 % of its reflection and nothing else; far above it goes to white.
  EXPECT_NEAR(tone_khronos_neutral(Rgb(0.5, 0.3, 0.2)).r, 0.46, 1e-12);
  EXPECT_NEAR(tone_khronos_neutral(Rgb(0.04)).r, 0.01, 1e-12);
  EXPECT_NEAR(tone_khronos_neutral(Rgb(1000)).b, 1, 1e-3);
  // Uchimura: light between m = 0.22 and 0.532 stays as it is, with a slope of 1 at both ends.
  for (const double x : {0.22, 0.3, 0.5, 0.531}) EXPECT_NEAR(tone_gt(Rgb(x)).r, x, 1e-12);
  EXPECT_NEAR((tone_gt(Rgb(0.5321)).r - tone_gt(Rgb(0.532)).r) / 1e-4, 1, 1e-3);
  // AgX: middle grey is half of the encoding, 0.5^2.2; 10 stops below it is black, 6.5 above white. Wrensch's
  // polynomial of the same sigmoid (15.5x⁶ − 40.14x⁵ + …) is within 0.006 of it.
  EXPECT_NEAR(tone_agx(Rgb(0.18), AgxLook::base).r, std::pow(0.5, 2.2), 1e-6);
  EXPECT_NEAR(tone_agx(Rgb(0.18 * std::exp2(6.5)), AgxLook::base).g, 1, 1e-6);
  EXPECT_NEAR(tone_agx(Rgb(0.18 / 1024), AgxLook::base).g, 0, 1e-6);
  for (double x = 0; x <= 1; x += 0.01) {
    const double light = 0.18 * std::exp2(16.5 * x - 10);
    const double polynomial = 15.5 * std::pow(x, 6) - 40.14 * std::pow(x, 5) + 31.96 * std::pow(x, 4) -
                              6.868 * std::pow(x, 3) + 0.4298 * x * x + 0.1191 * x - 0.00232;
    EXPECT_NEAR(std::pow(tone_agx(Rgb(light), AgxLook::base).r, 1 / 2.2), std::max(polynomial, 0.0), 0.006) << x;
  }
  // Saturated light bleaches: far above white nothing of its colour is left but a little.
  const Rgb neon = tone_agx(Rgb(0.1, 0.2, 60), AgxLook::base);
  EXPECT_GT(std::min({neon.r, neon.g, neon.b}), 0.4);
  // Hable: no toe and no shoulder is light over white; the toe ends on the line y = x − (x₀ − y₀), the line has
  // slope 1.
  const ToneMapping straight{.white = 1, .toe = 0, .toe_length = 0, .shoulder_length = 0, .shoulder_angle = 0};
  for (const double x : {0.1, 0.5, 0.9}) EXPECT_NEAR(tone_hable(Rgb(x), straight).r, x, 1e-4);
  const ToneMapping filmic{.white = 6, .toe = 0.5, .toe_length = 0.5, .shoulder_length = 0.5, .shoulder_angle = 0};
  const double x0 = std::pow(0.5, 2.2) / 2;
  EXPECT_NEAR(tone_hable(Rgb(x0), filmic).r, x0 / 2, 1e-9);
  EXPECT_NEAR(tone_hable(Rgb(x0 + 0.1), filmic).r, x0 / 2 + 0.1, 1e-9);
  EXPECT_NEAR(tone_hable(Rgb(6), filmic).r, 1, 1e-9);
}

TEST(ToneMapping, NewerCurvesRiseAndStayInTheirRange) {
  const ToneMapping all[] = {{.mode = ToneMode::agx},
                             {.mode = ToneMode::agx, .look = AgxLook::punchy},
                             {.mode = ToneMode::khronos_neutral},
                             {.mode = ToneMode::hable},
                             {.mode = ToneMode::hable, .white = 3, .toe = 0.9, .shoulder_angle = 1},
                             {.mode = ToneMode::gt}};
  for (const auto& s : all) {
    double before = -1;
    for (double x = 0; x < 100; x = x * 1.01 + 1e-4) {
      const double y = tone_map(Rgb(x), s).r;
      EXPECT_GE(y, before - 1e-9) << x;
      EXPECT_GE(y, 0);
      EXPECT_TRUE(y <= 1 || s.mode == ToneMode::hable) << y;
      before = y;
    }
  }
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

TEST(ColorAdjustments, ClampPrecedesExposure) {
  EXPECT_EQ(adjust_color(Rgb(100, 1, 0), {.post_exposure = 1}), Rgb(120, 2, 0));
}

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

TEST(ColorAdjustments, StepsRunInTheirOrder) {
  const Rgb c(3, 0.5, 0.25), filter(0.5, 1, 2);
  Rgb expected = adjust_contrast(c * 2.0, 1.2) * filter;
  expected = adjust_saturation(shift_hue(glm::max(expected, Rgb(0)), 0.1), 1.3);
  const auto got =
      adjust_color(c, {.post_exposure = 1, .contrast = 20, .color_filter = filter, .hue_shift = 36, .saturation = 30});
  EXPECT_LT(glm::length(got - glm::max(expected, Rgb(0))), 1e-12);
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
