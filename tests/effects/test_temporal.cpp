// SPDX-License-Identifier: MIT
// Effects that look back: each frame of synthetic sequences against the oracle, and what makes them what they are.
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "cases.h"
#include "reference/temporal.h"
#include "temporal_player.h"

namespace afterglow {
namespace {

using namespace reference;

DoubleImage grey(double light, Size size = {48, 27}) { return DoubleImage(size, Rgba(light, light, light, 1)); }

std::string auto_exposure_entry(const AutoExposure& v) {
  return fmt::format(
      "fx.auto_exposure {{ compensation = {}, min_ev = {}, max_ev = {}, low_percentile = {}, high_percentile = {}, "
      "metering = \"{}\", speed_up = {}, speed_down = {} }}",
      v.compensation, v.min_ev, v.max_ev, v.low_percentile, v.high_percentile, v.center ? "center" : "average",
      v.speed_up, v.speed_down);
}

EffectCase exposed(const AutoExposure& v) {
  return {auto_exposure_entry(v),
          [=](const Scene& s) { return auto_exposure(s.source, wanted_exposure(s.source, v), v); }};
}

std::string firefly_entry(const FireflyStabilisation& v) {
  return fmt::format(
      "fx.firefly_stabilisation {{ threshold = {}, tolerance = {}, search = {}, frames = {}, first_frame = \"{}\" }}",
      v.threshold, v.tolerance, v.search, v.frames, v.clamp_first ? "clamp" : "keep");
}

EffectCase stabilised(const FireflyStabilisation& v) {
  return {firefly_entry(v), [=](const Scene& s) { return firefly_stabilisation(s.source, {}, v); }};
}

/// Sums of logarithms in floats.
constexpr Tolerances kLogarithms{.full = 5e-5, .fused = 1e-5, .half = kHalfFloat};

TEST_F(Effects, AutoExposureOfOnePictureAgrees) {
  agree_everywhere(
      {exposed({}), exposed({.compensation = 1.5, .low_percentile = 0, .high_percentile = 100}),
       exposed({.low_percentile = 70, .high_percentile = 95, .center = true}), exposed({.min_ev = 1, .max_ev = 1.25})},
      kLogarithms);
}

TEST_F(Effects, AutoExposureFollowsAsTheOracleDoes) {
  const AutoExposure v{.compensation = 0.5, .speed_up = 6, .speed_down = 3};
  for (const bool every_pass_alone : {false, true}) {
    TemporalPlayer player(auto_exposure_entry(v), every_pass_alone);
    double exposure = 0;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> stops(-5, 5);
    for (int frame = 1; frame <= 24; ++frame) {
      Scene scene = random_scene({101, 57}, static_cast<unsigned>(frame));
      const double light = std::exp2(std::floor(stops(random)));  // held for a few frames
      for (auto& p : scene.source.pixels) p = Rgba(Rgb(p) * (frame % 6 < 3 ? light : 1.0), p.a);
      scene.source = in_floats(scene.source);
      const double wanted = wanted_exposure(scene.source, v);
      exposure = frame == 1 ? wanted : adapted_exposure(exposure, wanted, 1 / 24.0, v);
      EXPECT_TRUE(agrees(player.play(scene.source, frame), auto_exposure(scene.source, exposure, v), 1e-4, kRgb))
          << frame;
    }
  }
}

TEST_F(Effects, AutoExposureMetersWhatIsDrawn) {
  DoubleImage cut_out = grey(0.72);
  for (std::size_t i = 0; i < cut_out.pixels.size(); ++i)
    cut_out.pixels[i] *= i % 4 == 0 ? 1.0 : i % 4 == 1 ? 0.5 : 0.0;
  const auto result = TemporalPlayer("fx.auto_exposure {}").play(cut_out, 1);
  EXPECT_NEAR(result[0], 0.18, 1e-5);
  EXPECT_NEAR(result[4], 0.09, 1e-5) << "half of it covers";
  EXPECT_TRUE(agrees(result, auto_exposure(cut_out, wanted_exposure(cut_out, {}), {}), 1e-4, kRgb));
  const DoubleImage empty({48, 27}, Rgba(0));
  EXPECT_EQ(wanted_exposure(empty, {}), 0);
  EXPECT_EQ(TemporalPlayer("fx.auto_exposure {}").play(empty, 1)[0], 0);
}

TEST_F(Effects, AutoExposureMetersLightOfAlmostNoCoverage) {
  DoubleImage scene = grey(0.72);
  for (const float alpha : {1.2e-38f, 1e-45f}) {
    scene.at(20, 10) = Rgba(1e5, 1e5, 1e5, alpha);  // divided by it, more than a float holds
    for (const bool every_pass_alone : {false, true})
      EXPECT_NEAR(TemporalPlayer("fx.auto_exposure {}", every_pass_alone).play(scene, 1)[0], 0.18, 1e-5) << alpha;
  }
}

TEST_F(Effects, AutoExposureBringsGreyToMiddleGreyAtOnce) {
  TemporalPlayer player("fx.auto_exposure {}");
  EXPECT_NEAR(player.play(grey(1.44), 1)[0], 0.18, 1e-5);
  EXPECT_NEAR(player.play(grey(0.0225), 10)[0], 0.18, 1e-5) << "after a cut that is a seek";
  EXPECT_NEAR(player.play(grey(0.18 * 1024), 20)[0], 0.18 * 16, 1e-3) << "not beyond max_ev";
}

TEST_F(Effects, AutoExposureMovesByItsSpeeds) {
  TemporalPlayer player("fx.auto_exposure { speed_up = 6, speed_down = 3, min_ev = -16, max_ev = 16 }");
  EXPECT_NEAR(player.play(grey(0.18), 1)[0], 0.18, 1e-5);
  const auto exposure = [&](double light, int frame) { return std::log2(light / player.play(grey(light), frame)[0]); };
  EXPECT_NEAR(exposure(0.18 * 256, 2), 6 / 24.0, 1e-4) << "8 stops up: 6 a second";
  EXPECT_NEAR(exposure(0.18 * 256, 3), 12 / 24.0, 1e-4);
  EXPECT_NEAR(exposure(0.18 / 256, 4), (12 - 3) / 24.0, 1e-4) << "and down: 3 a second";
}

TEST_F(Effects, AutoExposureDoesNotDependOnTheFrameRate) {
  TemporalPlayer slow("fx.auto_exposure {}"), fast("fx.auto_exposure {}");
  EXPECT_EQ(slow.play(grey(0.18), 0, 12), fast.play(grey(0.18), 0, 48));
  for (int frame = 1; frame <= 12; ++frame) {
    std::vector<float> last;
    for (int part = 1; part <= 4; ++part) last = fast.play(grey(5), (frame - 1) * 4 + part, 48);
    EXPECT_NEAR(slow.play(grey(5), frame, 12)[0] / last[0], 1, 1e-4) << frame;
  }
}

TEST_F(Effects, AutoExposureForgetsWithinItsPreRoll) {
  // What the oracle keeps of four stops after the frames that the effect asks for: a hundredth of a stop.
  const AutoExposure v;
  double exposure = 4;
  const double seconds = (2.5 + 1.5 * std::log(150)) / v.speed_down;
  for (int frame = 0; frame < static_cast<int>(std::ceil(seconds * 24)); ++frame)
    exposure = adapted_exposure(exposure, 0, 1 / 24.0, v);
  EXPECT_LE(exposure, 0.01);
  EXPECT_GT(exposure, 0.009) << "and no longer than that";
}

TEST_F(Effects, AutoExposureSaysWhatIsWrong) {
  const Scene scene = random_scene({16, 16}, 1);
  EXPECT_THAT(build_error("fx.auto_exposure { low_percentile = 50, high_percentile = 40 }", scene),
              testing::HasSubstr("high_percentile must be above low_percentile"));
  EXPECT_THAT(build_error("fx.auto_exposure { min_ev = 2, max_ev = 1 }", scene),
              testing::HasSubstr("max_ev must not be below min_ev"));
}

TEST_F(Effects, FireflyStabilisationOfOnePictureAgrees) {
  agree_everywhere(
      {stabilised({.clamp_first = true}), stabilised({.threshold = 0, .tolerance = 1, .clamp_first = true}),
       stabilised({.search = 0, .frames = 4})},
      {.spikes = true});
}

/// Sparks in random places of a noisy picture.
DoubleImage sparkling(int frame) {
  Scene scene = random_scene({64, 40}, static_cast<unsigned>(100 + frame));
  for (auto& p : scene.source.pixels) p = Rgba(Rgb(p) * 0.1, 1);
  std::mt19937 random(static_cast<unsigned>(frame));
  for (int i = 0; i < 30; ++i)
    scene.source.at(static_cast<int>(random() % 64), static_cast<int>(random() % 40)) = Rgba(900, 700, 300, 1);
  return in_floats(scene.source);
}

TEST_F(Effects, FireflyStabilisationFollowsAsTheOracleDoes) {
  for (const FireflyStabilisation& v :
       {FireflyStabilisation{}, FireflyStabilisation{.threshold = 0.5, .tolerance = 1.5, .search = 1, .frames = 4},
        FireflyStabilisation{.search = 0, .frames = 3, .clamp_first = true}}) {
    TemporalPlayer player(firefly_entry(v));
    std::vector<DoubleImage> past;
    for (int frame = 1; frame <= 7; ++frame) {
      const DoubleImage source = sparkling(frame);
      EXPECT_TRUE(agrees(player.play(source, frame), firefly_stabilisation(source, past, v), kFullFloat, kRgba))
          << firefly_entry(v) << " frame " << frame;
      past.insert(past.begin(), source);
    }
  }
}

TEST_F(Effects, FireflyStabilisationFollowsInHalfFloatsToo) {
  const FireflyStabilisation v{.frames = 4, .clamp_first = true};
  TemporalPlayer player(firefly_entry(v), false, Precision::fp16);
  std::vector<DoubleImage> past;
  for (int frame = 1; frame <= 7; ++frame) {
    const DoubleImage source = sparkling(frame);
    EXPECT_TRUE(agrees(player.play(source, frame), firefly_stabilisation(source, past, v), kHalfFloat, kRgba)) << frame;
    past.insert(past.begin(), source);
  }
}

/// Beyond what half floats hold, a light is without limit in what is remembered of it.
TEST_F(Effects, LightsBeyondHalfFloatsAreRemembered) {
  for (const Precision precision : {Precision::fp32, Precision::fp16}) {
    TemporalPlayer player("fx.firefly_stabilisation {}", false, precision);
    DoubleImage lit = grey(0.2, {16, 16});
    lit.at(8, 8) = Rgba(60000, 50000, 40000, 1);
    if (precision == Precision::fp32) lit.at(3, 5) = Rgba(1e9, 1e8, 1e7, 1);
    for (int frame = 1; frame <= 4; ++frame)
      EXPECT_TRUE(agrees(player.play(lit, frame), lit, kHalfFloat, kRgba)) << "keep: frame " << frame;
  }
}

TEST_F(Effects, FirefliesGoAndTheirSurroundingsStay) {
  TemporalPlayer player("fx.firefly_stabilisation {}");
  const DoubleImage calm = grey(0.5, {32, 20});
  DoubleImage flash = calm;
  flash.at(11, 7) = Rgba(1000, 500, 250, 1);
  const auto expected = player.play(calm, 1);
  const auto made = player.play(flash, 2);
  for (std::size_t i = 0; i < made.size(); i += 4) {
    const bool firefly = i == (7 * 32 + 11) * 4;
    EXPECT_EQ(made[i], firefly ? 1.0f : expected[i]);
    EXPECT_EQ(made[i + 1], firefly ? 0.5f : expected[i + 1]) << "in its own hue";
  }
  EXPECT_EQ(player.play(calm, 3), expected) << "and leave nothing behind";
}

TEST_F(Effects, MovingHighlightsAreNotTouched) {
  TemporalPlayer player("fx.firefly_stabilisation {}");
  for (int frame = 1; frame <= 9; ++frame) {
    DoubleImage picture = grey(0.2, {64, 24});
    picture.at(5 + 3 * frame, 12 - frame) = Rgba(300, 300, 200, 1);  // a spark, one pixel
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) picture.at(60 - 6 * frame + x, 16 + y) = Rgba(40, 50, 60, 1);  // a lamp, faster
    for (int x = 0; x < 64; ++x) picture.at(x, 23 - 3 * (frame % 2)) = Rgba(80, 0, 0, 1);        // a line that jumps
    const auto made = player.play(picture, frame);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(made[i * 4 + static_cast<std::size_t>(c)], static_cast<float>(picture.pixels[i][c]))
            << "frame " << frame << " x " << i % 64 << " y " << i / 64;
  }
}

TEST_F(Effects, ANewLightIsThereAfterItsFrames) {
  TemporalPlayer player("fx.firefly_stabilisation { frames = 2 }");
  const DoubleImage dark = grey(0.2, {16, 16});
  DoubleImage lit = dark;
  lit.at(8, 8) = Rgba(50, 50, 50, 1);
  const std::size_t at = (8 * 16 + 8) * 4;
  for (int frame = 1; frame <= 3; ++frame) (void)player.play(dark, frame);
  EXPECT_EQ(player.play(lit, 4)[at], 1);
  EXPECT_EQ(player.play(lit, 5)[at], 1);
  EXPECT_EQ(player.play(lit, 6)[at], 50);
}

}  // namespace
}  // namespace afterglow
