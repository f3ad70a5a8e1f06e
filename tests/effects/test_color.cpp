// SPDX-License-Identifier: MIT
// Tone mapping, colour adjustments and colour blit.
#include <fmt/format.h>

#include <map>

#include "harness.h"
#include "reference/bloom.h"
#include "reference/color_adjustments.h"
#include "reference/color_blit.h"
#include "reference/grading.h"
#include "reference/tone_mapping.h"

namespace afterglow {
namespace {

using namespace reference;

void check(const Scene& scene, const std::string& entries, const DoubleImage& expected, double tolerance = kFullFloat) {
  SCOPED_TRACE(scene.name + ": " + entries);
  const Made made = run_stack(entries, scene, Way::plain);
  EXPECT_TRUE(made.ran());
  EXPECT_TRUE(agrees(made.result, expected, tolerance, kRgba));
  EXPECT_TRUE(alpha_is_kept(made, scene));
}

std::vector<Scene> scenes() {
  std::vector<Scene> all;
  for (const Size size : kSizes) all.push_back(random_scene(size, 21, size.width % 2 == 1));
  all.push_back(neon_scene({320, 180}, 480, 300));
  return all;
}

TEST_F(Effects, ToneCurvesAgree) {
  for (const auto& scene : scenes()) {
    check(scene, "fx.tone_mapping { mode = \"aces\" }", tone_mapping(scene.source, ToneMode::aces));
    check(scene, "fx.tone_mapping { mode = \"neutral\" }", tone_mapping(scene.source, ToneMode::neutral));
    check(scene, "fx.tone_mapping { mode = \"reinhard\" }", tone_mapping(scene.source, ToneMode::reinhard));
  }
}

// Every branch of ACES: glow, red modifier, the guards of the dim surround; greys and ties of two channels.
Scene dark_and_saturated() {
  Scene scene{"grid", DoubleImage(64, 64), {}, {}};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const double r = std::exp2(x / 2 - 26), g = std::exp2(y / 2 - 26);
      const double b = x % 2 == 0 ? (y % 2 == 0 ? r : g) : (y % 2 == 0 ? 0.0 : std::exp2((x + y) / 4 - 26));
      scene.source.at(x, y) = Rgba(r, g, b, 1);  // powers of two: exact floats
    }
  return scene;
}

TEST_F(Effects, ToneCurvesAgreeOnDarkAndSaturatedColours) {
  const Scene scene = dark_and_saturated();
  for (const auto& [name, mode] :
       {std::pair{"aces", ToneMode::aces}, {"neutral", ToneMode::neutral}, {"reinhard", ToneMode::reinhard}})
    check(scene, fmt::format("fx.tone_mapping {{ mode = \"{}\" }}", name), tone_mapping(scene.source, mode));
}

std::string lua(const ToneMapping& s) {
  static const std::map<ToneMode, std::string> kModes{{ToneMode::aces, "aces"},
                                                      {ToneMode::reinhard, "reinhard"},
                                                      {ToneMode::reinhard_extended, "reinhard_extended"},
                                                      {ToneMode::agx, "agx"},
                                                      {ToneMode::gt, "gt"},
                                                      {ToneMode::khronos_neutral, "khronos_neutral"},
                                                      {ToneMode::hable, "hable"}};
  static constexpr const char* kLooks[] = {"base", "punchy", "golden"};
  return fmt::format(
      "fx.tone_mapping {{ mode = \"{}\", exposure = {}, white = {}, full_white = {}, look = \"{}\", toe = {}, "
      "toe_length = {}, shoulder_length = {}, shoulder_angle = {} }}",
      kModes.at(s.mode), s.exposure, s.white, s.full_white, kLooks[static_cast<int>(s.look)], s.toe, s.toe_length,
      s.shoulder_length, s.shoulder_angle);
}

TEST_F(Effects, NewerToneCurvesAgree) {
  const ToneMapping settings[] = {
      {.mode = ToneMode::reinhard_extended},
      {.mode = ToneMode::reinhard_extended, .exposure = 1.5, .white = 2},
      {.mode = ToneMode::agx},
      {.mode = ToneMode::agx, .exposure = -1, .look = AgxLook::punchy},
      {.mode = ToneMode::agx, .look = AgxLook::golden},
      {.mode = ToneMode::khronos_neutral},
      {.mode = ToneMode::khronos_neutral, .exposure = 0.7},
      {.mode = ToneMode::hable},
      {.mode = ToneMode::hable, .white = 4, .toe = 0, .toe_length = 0, .shoulder_length = 1, .shoulder_angle = 0},
      {.mode = ToneMode::hable, .white = 0.5, .toe = 0.9, .toe_length = 1, .shoulder_length = 0, .shoulder_angle = 1},
      {.mode = ToneMode::hable,
       .white = 100,
       .toe = 0.8,
       .toe_length = 0.7,
       .shoulder_length = 0.8,
       .shoulder_angle = 1},
      {.mode = ToneMode::gt},
      {.mode = ToneMode::gt, .exposure = 2},
      {.mode = ToneMode::aces, .exposure = 0.5, .full_white = true},
      {.mode = ToneMode::reinhard, .full_white = true},
  };
  // AgX goes through a logarithm of 16.5 stops and back by a power of 2.2.
  auto all = scenes();
  all.push_back(dark_and_saturated());
  for (const auto& scene : all)
    for (const auto& s : settings)
      check(scene, lua(s), tone_mapping(scene.source, s), s.mode == ToneMode::agx ? 3e-5 : kFullFloat);
}

TEST_F(Effects, WhiteBecomesWhite) {
  Scene scene{"white", DoubleImage(1, 1, Rgba(6, 6, 6, 1)), {}, {}};
  const auto result = [&](const ToneMapping& s) { return run_stack(lua(s), scene, Way::plain).result[0]; };
  EXPECT_NEAR(result({.mode = ToneMode::reinhard_extended, .white = 6}), 1, 1e-6);
  EXPECT_NEAR(result({.mode = ToneMode::hable, .white = 6}), 1, 1e-5);
  scene.source.at(0, 0) = Rgba(60, 60, 60, 1);
  EXPECT_NEAR(result({.mode = ToneMode::aces}), 0.94539, 1e-5);
  EXPECT_NEAR(result({.mode = ToneMode::aces, .full_white = true}), 1, 1e-5);
  EXPECT_NEAR(result({.mode = ToneMode::reinhard, .full_white = true}), 1, 1e-6);
}

TEST_F(Effects, ToneMappingNoneIsTheSource) {
  const auto scene = random_scene({8, 8}, 22);
  const Made made = run_stack("fx.tone_mapping { mode = \"none\" }", scene, Way::plain);
  EXPECT_FALSE(made.ran());
  ASSERT_EQ(made.graph.skipped.size(), 1u);
  EXPECT_EQ(made.graph.skipped[0].reason, "mode is none");
}

std::string lua(const ColorAdjustments& s) {
  return fmt::format(
      "fx.color_adjustments {{ post_exposure = {}, contrast = {}, color_filter = {{ {}, {}, {} }}, hue_shift = {}, "
      "saturation = {} }}",
      s.post_exposure, s.contrast, s.color_filter.r, s.color_filter.g, s.color_filter.b, s.hue_shift, s.saturation);
}

TEST_F(Effects, ColorAdjustmentsAgreeStepByStep) {
  const ColorAdjustments settings[] = {
      {.post_exposure = 1.3}, {.post_exposure = -4}, {.contrast = 15},
      {.contrast = 100},      {.contrast = -60},     {.contrast = -100},
      {.hue_shift = 60},      {.hue_shift = -37.5},  {.hue_shift = 180},
      {.hue_shift = -180},    {.hue_shift = 121},    {.saturation = 25},
      {.saturation = -100},   {.saturation = -40},   {.color_filter = {1.5, 0.9, 0.25}},
  };
  for (const auto& scene : scenes())
    for (const auto& s : settings) check(scene, lua(s), color_adjustments(scene.source, s));
}

TEST_F(Effects, ColorAdjustmentsAgreeInChains) {
  const ColorAdjustments settings[] = {{0.3, 15, {1, 1, 1}, 0, 10},
                                       {0.5, -20, {1.05, 1, 0.9}, 0, -30},
                                       {-0.7, 10, {0.9, 1, 1.1}, 20, -20},
                                       {1, 0, {1, 1, 1}, -75, 0}};
  for (const auto& scene : scenes())
    for (const auto& s : settings) check(scene, lua(s), color_adjustments(scene.source, s));
}

TEST_F(Effects, ContrastTakesWhatToneCurvesLeaveBelowZero) {
  // ACES returns down to −0.03; LogC's argument is negative from −0.0086 on, where its logarithm is taken as −∞.
  Scene scene{"negative", DoubleImage(8, 2), {}, {}};
  static constexpr double kValues[] = {-0.03, -0.00864, -0.0086, -0.001, -1e-6, 0, 0.01, 3};
  for (int x = 0; x < 8; ++x) {
    scene.source.at(x, 0) = Rgba(kValues[x], kValues[7 - x], kValues[x], 1);
    scene.source.at(x, 1) = Rgba(kValues[x], kValues[x], 1, 0.5);
  }
  scene.source = in_floats(scene.source);
  for (const double contrast : {-100.0, -99.0, -50.0, 50.0, 100.0})
    check(scene, lua({.contrast = contrast}), color_adjustments(scene.source, {.contrast = contrast}));
}

TEST_F(Effects, ColorAdjustmentsAllNeutralDoNotRun) {
  const Made made = run_stack("fx.color_adjustments {}", random_scene({8, 8}, 23), Way::plain);
  EXPECT_FALSE(made.ran());
  ASSERT_EQ(made.graph.skipped.size(), 1u);
  EXPECT_EQ(made.graph.skipped[0].reason, "all settings are neutral");
}

TEST_F(Effects, HueTurnsAtTies) {
  // Two equal channels are where the definition has its branches; math.md §13 grants 5e-5 there.
  Scene scene{"ties", DoubleImage(36, 6), {}, {}};
  for (int x = 0; x < 36; ++x) {
    const double a = 0.05 * (1 + x), b = 0.02 * (36 - x);
    const Rgb colours[] = {{a, a, b}, {a, b, a}, {b, a, a}, {a, a, a}, {a, 0, 0}, {0, a, 0}};
    for (int y = 0; y < 6; ++y) scene.source.at(x, y) = Rgba(colours[y], 1);
  }
  scene.source = in_floats(scene.source);
  for (const double shift : {-180.0, -90.0, -1.0, 30.0, 60.0, 120.0, 180.0}) {
    const Made made = run_stack(lua({.hue_shift = shift}), scene, Way::plain);
    EXPECT_TRUE(agrees(made.result, color_adjustments(scene.source, {.hue_shift = shift}), 6e-5, kRgba)) << shift;
  }
}

TEST_F(Effects, ColorBlitAgrees) {
  for (const auto& scene : scenes())
    for (const double intensity : {0.25, 2.0})
      check(scene, fmt::format("fx.color_blit {{ intensity = {} }}", intensity), color_blit(scene.source, intensity));
  const Made made = run_stack("fx.color_blit {}", random_scene({8, 8}, 24), Way::plain);
  EXPECT_FALSE(made.ran());
  EXPECT_EQ(made.graph.skipped.at(0).reason, "intensity is 0");
}

TEST_F(Effects, GradingStandsBeforeTheToneCurve) {
  const auto scene = neon_scene({160, 90}, 560, 330);
  const ColorAdjustments grade{.post_exposure = 0.7, .contrast = 20, .saturation = 15};
  std::string entry = lua(grade);
  const auto graded = tone_mapping(color_adjustments(scene.source, grade), ToneMode::aces);
  check(scene, "fx.tone_mapping {}, " + entry, graded);
  // Where the documents that we started from have it: behind the curve.
  entry.insert(entry.find('{') + 1, " at = \"after_post_process\", order = 99,");
  const auto old = color_adjustments(tone_mapping(scene.source, ToneMode::aces), grade);
  check(scene, "fx.tone_mapping {}, " + entry, old);
  EXPECT_FALSE(agrees(run_stack("fx.tone_mapping {}, " + entry, scene, Way::plain).result, graded, 1e-2, kRgb));
}

TEST_F(Effects, ExposureComesFirst) {
  const auto scene = neon_scene({160, 90}, 560, 330);
  const BloomSettings glow{.threshold = 1, .intensity = 0.4};
  const auto expected = tone_mapping(bloom(exposure(scene.source, 1.5), glow).result, ToneMode::reinhard);
  check(
      scene,
      "fx.tone_mapping { mode = \"reinhard\" }, fx.bloom { mode = \"additive\", intensity = 0.4 }, fx.exposure { ev = "
      "1.5 }",
      expected);
  const Made made = run_stack("fx.exposure {}", scene, Way::plain);
  EXPECT_EQ(made.graph.skipped.at(0).reason, "ev is 0");
}

}  // namespace
}  // namespace afterglow
