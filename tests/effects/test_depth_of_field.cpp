// SPDX-License-Identifier: MIT
// Depth of field: the oracle, and what may not leak.
#include <fmt/format.h>

#include "cases.h"
#include "reference/blurs.h"
#include "resident.h"
#include "temporal_player.h"

namespace afterglow {
namespace {

using namespace reference;

EffectCase focused(const DepthOfField& v) {
  return {fmt::format("fx.depth_of_field {{ focus_distance = {}, aperture = {}, focal_length = {}, sensor_height = {}, "
                      "max_radius = {}, samples = {} }}",
                      v.focus_distance, v.aperture, v.focal_length, v.sensor_height, v.max_radius, v.samples),
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
  agree_everywhere({focused({}), focused({.focus_distance = 2, .aperture = 1.4, .focal_length = 85, .max_radius = 9}),
                    focused({.focus_distance = 30, .aperture = 0.5, .max_radius = 24, .samples = 200}),
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
    EXPECT_EQ(p[0], red) << x;
    EXPECT_EQ(p[1], 1 - red) << x;
  }
}

TEST_F(Effects, BlurredThingsInFrontHaveSoftEdges) {
  const auto made = run_stack(kWide, halves(0.3, 2), Way::plain).result;  // a sharp green wall behind
  const auto red = [&](int x) { return made[4 * static_cast<std::size_t>(80 * 24 + x)]; };
  EXPECT_GT(red(42), 0.2F);
  EXPECT_GT(red(42), red(46));
  EXPECT_EQ(red(52), 0);
}

TEST_F(Effects, DepthOfFieldIsSkippedWithoutDepth) {
  auto scene = random_scene({16, 16}, 66);
  scene.depth.reset();
  const Made made = run_stack("fx.depth_of_field {}", scene, Way::plain);
  EXPECT_FALSE(made.ran());
  EXPECT_THAT(made.graph.skipped.at(0).reason, testing::HasSubstr("depth"));
}

TEST_F(Effects, FewSamplesComeCloseToMany) {
  const auto scene = neon_scene({160, 90}, 560, 330);
  const auto mean_error = [&](int samples) {
    const DepthOfField settings{.focus_distance = 4.5, .aperture = 0.7, .max_radius = 8, .samples = samples};
    DepthOfField many = settings;
    many.samples = 4000;
    const auto expected = depth_of_field(scene.source, *scene.depth, many);
    const auto made = run_stack(focused(settings).entries, scene, Way::fused).result;
    double sum = 0;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const double wanted = expected.pixels[i][c];
        sum += std::abs(made[4 * i + static_cast<std::size_t>(c)] - wanted) / (wanted + 0.01);
      }
    return sum / (3.0 * static_cast<double>(expected.pixels.size()));
  };
  EXPECT_LT(mean_error(48), 0.04);
  EXPECT_LT(mean_error(96), 0.025);
}

TEST_F(Effects, WhatIsInFocusStaysBitForBit) {
  auto scene = random_scene({40, 30}, 67);
  scene.depth = DoubleImage(40, 30, Rgba(2, 0, 0, 1));
  EXPECT_TRUE(agrees(run_stack(kWide, scene, Way::plain).result, scene.source, 0, kRgba));
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
