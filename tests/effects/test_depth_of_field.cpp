// SPDX-License-Identifier: MIT
// Depth of field: the oracle, and what may not leak.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases.h"
#include "reference/depth_of_field.h"
#include "resident.h"
#include "temporal_player.h"

namespace afterglow {
namespace {

using namespace reference;

EffectCase focused(const DepthOfField& v) {
  return {fmt::format("fx.depth_of_field {{ focus_distance = {}, aperture = {}, focal_length = {}, sensor_height = {}, "
                      "max_radius = {}, samples = {}, blades = {}, rotation = {}, squeeze = {}, cat_eye = {} }}",
                      v.focus_distance, v.aperture, v.focal_length, v.sensor_height, v.max_radius, v.samples, v.blades,
                      v.rotation, v.squeeze, v.cat_eye),
          [=](const Scene& s) { return depth_of_field(s.source, *s.depth, v); }};
}

/// The left half at one depth, the right at another; red and green.
Scene halves(double left, double right) {
  Scene scene{"halves", DoubleImage(80, 48, Rgba(1, 0, 0, 1)), DoubleImage(80, 48, Rgba(left, 0, 0, 1)), {}};
  for (int y = 0; y < 48; ++y)
    for (int x = 40; x < 80; ++x) {
      scene.source.at(x, y) = Rgba(0, 1, 0, 1);
      scene.depth->at(x, y) = Rgba(right, 0, 0, 1);
    }
  return scene;
}

constexpr const char* kWide =
    "fx.depth_of_field { focus_distance = 2, aperture = 1, focal_length = 100, max_radius = 10 }";

TEST_F(Effects, DepthOfFieldAgrees) {
  agree_everywhere(
      {focused({}), focused({.focus_distance = 2, .aperture = 1.4, .focal_length = 85, .max_radius = 9}),
       focused({.focus_distance = 30, .aperture = 0.5, .max_radius = 24, .samples = 200}),
       focused({.focus_distance = 2, .aperture = 0.1, .max_radius = 12, .blades = 5, .rotation = 20}),
       focused({.focus_distance = 4, .aperture = 0.1, .max_radius = 40, .samples = 8, .squeeze = 2}),
       focused({.focus_distance = 9, .aperture = 0.1, .max_radius = 10, .blades = 6, .squeeze = 0.5, .cat_eye = 1}),
       focused({.focus_distance = 9, .aperture = 0.1, .max_radius = 34, .samples = 8, .blades = 6, .cat_eye = 1}),
       focused({.focus_distance = 0.01, .samples = 8})},
      kDecisions);
}

TEST_F(Effects, DepthOfFieldReadsDeviceDepth) {
  auto scene = random_scene({64, 64}, 65);
  const double n = 0.1, f = 2000;
  for (auto& p : scene.depth->pixels) p.r = glm::clamp(p.r, n, f);
  const DepthOfField v{.focus_distance = 2, .aperture = 1.4, .max_radius = 9};
  const auto expected = depth_of_field(scene.source, *scene.depth, v);
  for (auto& p : scene.depth->pixels) p.r = (1 / p.r - 1 / f) / (1 / n - 1 / f);
  const std::string entries = focused(v).entries;
  const Made made =
      run_stack(entries.substr(0, entries.size() - 2) + ", depth_space = \"device\", near = 0.1, far = 2000 }", scene,
                Way::plain);
  EXPECT_TRUE(agrees(made.result, expected, 1e-2, kRgba));  // far away, floats of device depth are coarse
}

TEST_F(Effects, SharpThingsInFrontNeitherLeakNorBlur) {
  const Scene scene = halves(2, 50);  // a sharp red thing in front of a blurred green wall
  const auto made = run_stack(kWide, scene, Way::plain).result;
  for (int x = 0; x < 80; ++x) {
    const float *p = &made[4 * static_cast<std::size_t>(80 * 24 + x)], red = x < 40 ? 1.0F : 0.0F;
    EXPECT_NEAR(p[0], red, 1e-3) << x;
    EXPECT_NEAR(p[1], 1 - red, 1e-3) << x;
  }
}

TEST_F(Effects, BlurredThingsInFrontHaveSoftEdges) {
  const auto made = run_stack(kWide, halves(0.3, 2), Way::plain).result;  // a sharp green wall behind
  const auto red = [&](int x) { return made[4 * static_cast<std::size_t>(80 * 24 + x)]; };
  EXPECT_GT(red(42), 0.2F);
  EXPECT_GT(red(42), red(46));
  EXPECT_EQ(red(52), 0);
}

TEST_F(Effects, EdgePixelsLeaveNoContourInBlurredEdges) {
  // As renderers draw them, anti-aliased edges have the colour of both, but the depth of one.
  Scene scene = halves(0.3, 2);
  const auto expected = run_stack(kWide, scene, Way::plain).result;
  for (int y = 0; y < 48; ++y) scene.source.at(40, y) = Rgba(y % 3 == 0 ? 0.9 : 0.4, y % 3 == 0 ? 0.1 : 0.6, 0, 1);
  const auto made = run_stack(kWide, scene, Way::plain).result;
  for (int y = 4; y < 44; ++y)
    for (int x = 0; x < 80; ++x) {
      const auto at = 4 * static_cast<std::size_t>(80 * y + x);
      EXPECT_NEAR(made[at], expected[at], 2e-3) << x << " " << y;
    }
}

/// What is seen around a bar was read so sparsely that some of its pixels saw nothing and stood for it: teeth along it.
TEST_F(Effects, ThinThingsInFrontHaveNoTeeth) {
  for (const double depth : {1.5, 1.3, 1.0, 0.7})
    for (const int width : {3, 5, 9, 14}) {
      constexpr int kSide = 1040;  // large enough for a small picture of half the size
      Scene scene{"bar", DoubleImage(kSide, 48, Rgba(4, 4, 4, 1)), DoubleImage(kSide, 48, Rgba(2, 0, 0, 1)), {}};
      for (int y = 0; y < 48; ++y)
        for (int x = 41; x < 41 + width; ++x) {
          scene.source.at(x, y) = Rgba(0.02, 0.02, 0.02, 1);
          scene.depth->at(x, y) = Rgba(depth, 0, 0, 1);
        }
      const auto made = run_stack(kWide, scene, Way::plain).result;
      double most = 0;
      for (int y = 16; y < 32; ++y)
        for (int x = 24; x < 72; ++x) {
          const auto at = 4 * static_cast<std::size_t>(kSide * y + x);
          most = std::max<double>(most, std::abs(made[at] - made[at - 4 * kSide]));
        }
      EXPECT_LT(most, 0.01) << "along a bar " << width << " wide at " << depth;
    }
}

TEST_F(Effects, DepthOfFieldIsSkippedWithoutDepth) {
  auto scene = random_scene({16, 16}, 66);
  scene.depth.reset();
  const Made made = run_stack("fx.depth_of_field {}", scene, Way::plain);
  EXPECT_FALSE(made.ran());
  EXPECT_THAT(made.graph.skipped.at(0).reason, testing::HasSubstr("depth"));
}

/// A point of light, far away or near, and nothing else: its disc. `place` shifts it by pixels from the middle.
Made disc_of_a_point(int side, int place, double depth, const std::string& settings) {
  Scene scene{"point", DoubleImage(side, side), DoubleImage(side, side, Rgba(depth, 0, 0, 1)), {}};
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) scene.source.at(side / 2 + place + x, side / 2 + place + y) = Rgba(5000, 5000, 5000, 1);
  return run_stack("fx.depth_of_field { focus_distance = 5, aperture = 0.1, focal_length = 200, " + settings + " }",
                   scene, Way::plain);
}

TEST_F(Effects, NoPatternShowsInDiscsOfAnyRadius) {
  for (const double depth : {1e4, 0.5})
    for (const int radius : {5, 8, 12, 17, 23, 31, 40, 52, 64}) {
      const int side = 2 * radius + 40, middle = side / 2 + radius % 4;
      const auto made = disc_of_a_point(side, radius % 4, depth, fmt::format("max_radius = {}", radius)).result;
      double sum = 0, squares = 0, outside = 0;
      int count = 0;
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          const double v = made[4 * static_cast<std::size_t>(side * y + x)];
          const double away = std::hypot(x - middle - 1, y - middle - 1);
          if (away > radius + 6) outside += v;
          if (away > 0.7 * radius - 3) continue;
          sum += v, squares += v * v, ++count;
        }
      const double mean = sum / count;
      EXPECT_LT(std::sqrt(squares / count - mean * mean), (radius < 12 ? 0.12 : 0.06) * mean)
          << radius << " at " << depth;
      EXPECT_LT(outside, 1e-3 * 45000)  // of its light
          << radius << " at " << depth;
    }
}

/// It stood still for up to eight pixels, for coarse levels of the picture are read for wide discs.
TEST_F(Effects, DiscsMoveWithTheirLight) {
  for (const double depth : {1e4, 0.5})
    for (const int radius : {12, 20, 30, 40, 64})
      for (const int moved : {0, 1, 2, 3, 5, 6}) {
        const int side = 2 * radius + 48;
        const auto made = disc_of_a_point(side, moved, depth, fmt::format("max_radius = {}", radius)).result;
        double sum = 0, x_sum = 0, y_sum = 0;
        for (int y = 0; y < side; ++y)
          for (int x = 0; x < side; ++x) {
            const double v = made[4 * static_cast<std::size_t>(side * y + x)];
            sum += v, x_sum += v * x, y_sum += v * y;
          }
        EXPECT_NEAR(sum, 45000, 450) << radius;
        EXPECT_NEAR(x_sum / sum, side / 2 + moved + 1, 0.65) << radius << ' ' << moved << " at " << depth;
        EXPECT_NEAR(y_sum / sum, side / 2 + moved + 1, 0.65) << radius << ' ' << moved << " at " << depth;
      }
}

/// Extent of what is above half of the greatest value: across and down.
std::pair<int, int> extent(const Made& made) {
  const int width = made.size.width;
  float most = 0;
  for (std::size_t i = 0; i < made.result.size(); i += 4) most = std::max(most, made.result[i]);
  int left = width, right = 0, top = made.size.height, bottom = 0;
  for (int y = 0; y < made.size.height; ++y)
    for (int x = 0; x < width; ++x)
      if (made.result[4 * static_cast<std::size_t>(width * y + x)] > 0.5F * most)
        left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
  return {right - left + 1, bottom - top + 1};
}

TEST_F(Effects, AnamorphicDiscsAreSqueezed) {
  const auto round = extent(disc_of_a_point(128, 0, 1e4, "max_radius = 30"));
  EXPECT_EQ(round.first, round.second);
  EXPECT_NEAR(round.first, 60, 5);
  const auto tall = extent(disc_of_a_point(128, 0, 1e4, "max_radius = 30, squeeze = 2"));
  EXPECT_NEAR(tall.first, 30, 5);
  EXPECT_NEAR(tall.second, 60, 5);
  const auto flat = extent(disc_of_a_point(128, 0, 1e4, "max_radius = 30, squeeze = 0.5"));
  EXPECT_NEAR(flat.first, 60, 5);
  EXPECT_NEAR(flat.second, 30, 5);
}

TEST_F(Effects, CatsEyesStandInTheCorners) {
  const auto round = extent(disc_of_a_point(240, 0, 1e4, "max_radius = 24, cat_eye = 1"));
  EXPECT_NEAR(round.first, 48, 5);
  // In the corner the disc is narrow along the diagonal: what lies across it is as wide as before.
  const auto made = disc_of_a_point(240, 80, 1e4, "max_radius = 24, cat_eye = 1").result;
  const auto at = [&](int dx, int dy) { return made[4 * static_cast<std::size_t>(240 * (201 + dy) + 201 + dx)]; };
  EXPECT_GT(at(12, -12), 0.5F * at(0, 0));
  EXPECT_LT(at(14, 14), 0.1F * at(0, 0));
  EXPECT_LT(at(-14, -14), 0.1F * at(0, 0));
}

TEST_F(Effects, BladesMakePolygons) {
  // A square stands on a corner: wide along the axes, narrow along the diagonals.
  const auto made = disc_of_a_point(128, 0, 1e4, "max_radius = 30, blades = 4").result;
  const auto at = [&](int dx, int dy) { return made[4 * static_cast<std::size_t>(128 * (65 + dy) + 65 + dx)]; };
  EXPECT_GT(at(22, 0), 0.5F * at(0, 0));
  EXPECT_GT(at(0, -22), 0.5F * at(0, 0));
  EXPECT_LT(at(20, 20), 0.1F * at(0, 0));
}

TEST_F(Effects, WhatIsInFocusStaysBitForBit) {
  auto scene = random_scene({40, 30}, 67);
  scene.depth = DoubleImage(40, 30, Rgba(2, 0, 0, 1));
  EXPECT_TRUE(agrees(run_stack(kWide, scene, Way::plain).result, scene.source, 0, kRgba));
}

std::string automatic(const FocusPoint& point, double speed = 4) {
  return fmt::format(
      "fx.depth_of_field {{ focus_mode = \"point\", focus_point = {{ {}, {} }}, focus_area = {}, "
      "focus_speed = {}, aperture = 1, max_radius = 9 }}",
      point.x, point.y, point.area, speed);
}

DoubleImage at_distance(const Scene& scene, double distance) {
  return depth_of_field(scene.source, *scene.depth, {.focus_distance = distance, .aperture = 1, .max_radius = 9});
}

TEST_F(Effects, AnAutofocusAgrees) {
  std::vector<EffectCase> cases;
  for (const FocusPoint& point : {FocusPoint{}, FocusPoint{0, 1, 0.3}, FocusPoint{0.71, 0.22, 1}, FocusPoint{1, 0, 0}})
    cases.push_back({automatic(point), [=](const Scene& s) { return at_distance(s, autofocus(*s.depth, point)); }});
  agree_everywhere(cases, kDecisions);
}

TEST_F(Effects, AnAutofocusIsOnWhatFillsMostOfItsSquare) {
  const Scene scene = halves(2, 50);
  EXPECT_NEAR(autofocus(*scene.depth, {0.5, 0.5, 0.3}), 2, 1e-9) << "of two halves the nearer";
  EXPECT_NEAR(autofocus(*scene.depth, {0.54, 0.5, 0.3}), 50, 1e-9);
  EXPECT_NEAR(autofocus(*scene.depth, {0.2, 0.5, 0}), 2, 1e-9);
  EXPECT_TRUE(
      agrees(run_stack(automatic({0.54, 0.5, 0.3}), scene, Way::plain).result, at_distance(scene, 50), 1e-3, kRgba));
}

TEST_F(Effects, AnAutofocusFollowsWhatMoves) {
  constexpr double kSpeed = 3;
  const FocusPoint point{0.5, 0.5, 0.2};
  Scene scene = random_scene({60, 40}, 68);
  TemporalPlayer player(automatic(point, kSpeed));
  double distance = 0;
  for (int frame = 1; frame <= 12; ++frame) {
    scene.depth = DoubleImage(60, 40, Rgba(frame < 4 ? 3 : frame < 9 ? 60 : 0.8, 0, 0, 1));
    for (int x = 0; x < 20; ++x) scene.depth->at(x, 5) = Rgba(1.5, 0, 0, 1);
    const double wanted = autofocus(*scene.depth, point);
    distance = frame == 1 ? wanted : follow_focus(distance, wanted, kSpeed, 1.0 / 24);
    EXPECT_TRUE(agrees(player.play(scene, frame), at_distance(scene, distance), 2e-3, kRgba)) << frame;
  }
  EXPECT_LT(distance, 3);
}

// A driver that compiles the shader again for each frame's parameters, as lavapipe does when it can see them, keeps
// about 1 MB of every frame.
TEST_F(Effects, FramesLeaveNothingBehind) {
  TemporalPlayer player("fx.depth_of_field { focus_distance = 2 }");
  Scene scene = random_scene({64, 48}, 5);
  for (int frame = 1; frame <= 20; ++frame) player.play(scene, frame);
  const auto before = resident();
  for (int frame = 21; frame <= 100; ++frame) player.play(scene, frame);
  EXPECT_LT(resident(), before + (24u << 20));
}

}  // namespace
}  // namespace afterglow
