// SPDX-License-Identifier: MIT
// Motion blur: the oracle, and what may and may not be blurred.
#include <fmt/format.h>

#include <cmath>
#include <glm/common.hpp>
#include <random>

#include "cases.h"
#include "reference/motion_blur.h"

namespace afterglow {
namespace {

using namespace reference;

/// Motion that turns over the picture, up to `length` pixels a frame. No two ways are as long, as rounding would say
/// which of them is the longest around.
Scene moving(Scene scene, double length) {
  std::mt19937 random(7);
  auto& motion = scene.motion.emplace(scene.source.size());
  for (int y = 0; y < motion.height; ++y)
    for (int x = 0; x < motion.width; ++x) {
      const double own = 1 - 0.01 * random() / static_cast<double>(std::mt19937::max());
      const double angle = 0.07 * x + 0.05 * y, way = own * length * (0.5 + 0.5 * std::sin(0.11 * x - 0.13 * y));
      motion.at(x, y) = Rgba(std::cos(angle) * way, std::sin(angle) * way, 0, 1);
    }
  motion = in_floats(motion);
  return scene;
}

std::string entry(const MotionBlur& v) {
  return fmt::format(
      "fx.motion_blur {{ shutter_angle = {}, samples = {}, max_radius = {}, motion_scale = {{ {}, {} }}, "
      "depth_softness = {} }}",
      v.shutter_angle, v.samples, v.max_radius, v.scale_x, v.scale_y, v.depth_softness);
}

/// A white bar on black, `width` wide, that moves `speed` pixels a frame across; what is behind it stands still.
Scene bar(double speed) {
  Scene scene{"bar", DoubleImage(96, 32, Rgba(0, 0, 0, 1)), DoubleImage(96, 32, Rgba(10, 0, 0, 1)), {}};
  scene.motion.emplace(96, 32, Rgba(0, 0, 0, 1));
  for (int y = 0; y < 32; ++y)
    for (int x = 40; x < 56; ++x) {
      scene.source.at(x, y) = Rgba(1);
      scene.depth->at(x, y).r = 2;
      scene.motion->at(x, y).r = speed;
    }
  return scene;
}

TEST_F(Effects, MotionBlurAgrees) {
  const MotionBlur variants[] = {
      {},
      {.shutter_angle = 360, .samples = 9, .max_radius = 10},
      {.shutter_angle = 90, .samples = 40, .max_radius = 21.5, .scale_x = -2, .scale_y = 0.5},
      {.shutter_angle = 360, .max_radius = 16, .depth_softness = 5}};
  for (const Size size : {Size{101, 57}, Size{64, 64}, Size{17, 5}, Size{1, 1}})
    for (const bool with_depth : {true, false})
      for (const auto& v : variants) {
        auto scene = moving(random_scene(size, 91), 40);
        if (!with_depth) scene.depth.reset();
        SCOPED_TRACE(entry(v) + (with_depth ? " with depth" : ""));
        const auto expected = motion_blur(scene.source, *scene.motion, scene.depth ? &*scene.depth : nullptr, v);
        for (const Way way : {Way::plain, Way::fused}) {
          const Made made = run_stack(entry(v), scene, way);
          EXPECT_TRUE(agrees(made.result, expected, kDecisions.full, kRgba));
          EXPECT_TRUE(alpha_is_kept(made, scene));
        }
      }
}

TEST_F(Effects, WhatStandsStillStaysBitForBit) {
  auto scene = random_scene({70, 50}, 92);
  scene.motion.emplace(70, 50, Rgba(0.9, 0, 0, 1));  // with half a shutter, less than half a pixel each way
  EXPECT_TRUE(agrees(run_stack("fx.motion_blur {}", scene, Way::plain).result, scene.source, 0, kRgba));
}

TEST_F(Effects, AMovingBarCoversAsItPasses) {
  // Half ways of 8 and of 1.25 pixels, with depth and without: what is in front, or moves farther, passes over the
  // rest.
  for (const double half_way : {8.0, 1.25})
    for (const bool with_depth : {true, false}) {
      Scene scene = bar(2 * half_way);
      if (!with_depth) scene.depth.reset();
      const auto made = run_stack("fx.motion_blur { shutter_angle = 360 }", scene, Way::plain).result;
      for (int x = 0; x < 96; ++x) {
        // The share of the time in which the bar, from 40 to 56, lies on the middle of the pixel.
        const auto passed = [&](double edge) {
          return glm::clamp((x + 0.5 - edge + half_way) / (2 * half_way), 0.0, 1.0);
        };
        const double share = passed(40) - passed(56);
        EXPECT_NEAR(made[4 * static_cast<std::size_t>(96 * 16 + x)], share, 1e-4) << x << " " << half_way << with_depth;
      }
    }
}

TEST_F(Effects, ABarCoversAsItPassesWhereTheGroundMovesOtherwise) {
  // Grey ground that moves down while the bar moves across; also where it moves farther than the bar, and where
  // something else near moves farther along the bar's own way.
  const auto bar_over = [](double ground, double other) {
    Scene scene = bar(16);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 96; ++x) {
        if (x >= 40 && x < 56) continue;
        scene.source.at(x, y) = Rgba(Rgb(0.25), 1);
        scene.motion->at(x, y) = x < 8 ? Rgba(other, 0, 0, 1) : Rgba(0, ground, 0, 1);
      }
    return run_stack("fx.motion_blur { shutter_angle = 360 }", scene, Way::plain).result;
  };
  for (const double ground : {0.0, 0.9, 12.0, 15.9, 16.0, 20.0, 40.0})
    for (const double other : {0.0, 32.0}) {
      const auto made = bar_over(ground, other);
      for (int x = 24; x < 96; ++x) {
        const auto passed = [&](double edge) { return glm::clamp((x + 0.5 - edge + 8) / 16, 0.0, 1.0); };
        const double share = passed(40) - passed(56);
        EXPECT_NEAR(made[4 * static_cast<std::size_t>(96 * 16 + x)], 0.25 + 0.75 * share, 0.02)
            << x << " ground " << ground << " other " << other;
      }
    }
}

TEST_F(Effects, LongWaysShowNoStripes) {
  // One white line on black that moves with everything: an even band.
  Scene scene{"line", DoubleImage(96, 40, Rgba(0, 0, 0, 1)), DoubleImage(96, 40, Rgba(5, 0, 0, 1)), {}};
  scene.motion.emplace(96, 40, Rgba(50, 30, 0, 1));
  for (int y = 0; y < 40; ++y) scene.source.at(48, y) = Rgba(1);
  const auto made = run_stack("fx.motion_blur { shutter_angle = 360 }", scene, Way::plain).result;
  for (int x = 24; x < 72; ++x) EXPECT_NEAR(made[4 * static_cast<std::size_t>(96 * 20 + x)], 1.0 / 50, 1e-4) << x;
}

TEST_F(Effects, WhatMovesBehindSomethingSharpDoesNotCoverIt) {
  // The bar stands still in front; everything behind it moves.
  auto scene = bar(0);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 96; ++x)
      if (x < 40 || x >= 56) scene.motion->at(x, y).r = 16;
  const auto made = run_stack("fx.motion_blur { shutter_angle = 360, samples = 64 }", scene, Way::plain).result;
  for (int x = 40; x < 56; ++x) EXPECT_GT(made[4 * static_cast<std::size_t>(96 * 16 + x)], 0.97F) << x;
}

TEST_F(Effects, LightsBehindAreNotSmearedIntoWhatMovesBeforeThem) {
  // A dark bar passes; a bright light stands still behind it, some pixels away from its edge.
  for (const bool with_depth : {true, false}) {
    Scene scene = bar(24);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 96; ++x)
        scene.source.at(x, y) = Rgba(Rgb(x >= 32 && x < 35 ? 50 : x >= 40 && x < 56 ? 0 : 1), 1);
    if (!with_depth) scene.depth.reset();
    const auto made = run_stack("fx.motion_blur { shutter_angle = 360 }", scene, Way::plain).result;
    for (int x = 39; x < 56; ++x) EXPECT_LT(made[4 * static_cast<std::size_t>(96 * 16 + x)], 1.2) << x << with_depth;
  }
}

TEST_F(Effects, EdgePixelsLeaveNoContourInWhatMoves) {
  // Anti-aliased edges have the colour of both, but stand still.
  Scene scene = bar(16);
  const auto expected = run_stack("fx.motion_blur { shutter_angle = 360 }", scene, Way::plain).result;
  for (int y = 0; y < 32; ++y)
    for (const int x : {39, 56}) scene.source.at(x, y) = Rgba(Rgb(y % 2 == 0 ? 0.5 : 0.9), 1);
  const auto made = run_stack("fx.motion_blur { shutter_angle = 360 }", scene, Way::plain).result;
  for (std::size_t i = 0; i < made.size(); ++i) EXPECT_NEAR(made[i], expected[i], 0.03) << i / 4 % 96;
}

TEST_F(Effects, MotionBlurIsSkippedWithoutMotion) {
  const Made made = run_stack("fx.motion_blur {}", random_scene({16, 16}, 93), Way::plain);
  EXPECT_FALSE(made.ran());
  EXPECT_THAT(made.graph.skipped.at(0).reason, testing::HasSubstr("no motion input"));
  expect_skipped("fx.motion_blur { shutter_angle = 0 }", "shutter_angle is 0");
}

}  // namespace
}  // namespace afterglow
