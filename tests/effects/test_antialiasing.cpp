// SPDX-License-Identifier: MIT
// Edges that are smoothed: within a picture (SMAA) and over frames (TAA).
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "cases.h"
#include "reference/smaa.h"
#include "reference/temporal_aa.h"
#include "temporal_player.h"

namespace afterglow {
namespace {

using namespace reference;

EffectCase smoothed(const Smaa& v) {
  return {fmt::format("fx.smaa {{ threshold = {}, search = {}, corner_rounding = {} }}", v.threshold, v.search,
                      v.corner_rounding),
          [=](const Scene& s) { return smaa(s.source, v); }};
}

/// A white half plane under a line of this slope, without anti-aliasing.
Scene half_plane(Size size, double slope) {
  Scene scene{"half plane", DoubleImage(size), {}, {}};
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      if (y + 0.5 > size.height / 2.0 + slope * (x + 0.5 - size.width / 2.0)) scene.source.at(x, y) = Rgba(1, 1, 1, 1);
  return scene;
}

TEST_F(Effects, SmaaAgrees) {
  agree_everywhere({smoothed({}), smoothed({.threshold = 0.2, .search = 4, .corner_rounding = 100}),
                    smoothed({.threshold = 0.02, .search = 112, .corner_rounding = 0})},
                   kDecisions);
}

TEST_F(Effects, SmaaPassByPass) {
  for (const double slope : {0.0, 0.07, 0.21, 0.5, 1.0, -0.13, -3.0}) {
    const auto scene = half_plane({97, 61}, slope);
    const Made made = run_stack("fx.smaa {}", scene, Way::plain);
    const auto edges = smaa_edges(scene.source, {});
    EXPECT_TRUE(agrees(made.pixels("smaa.edges"), edges, 0, 2)) << slope;
    EXPECT_TRUE(agrees(made.pixels("smaa.weights"), smaa_weights(edges, {}), kFullFloat, kRgba)) << slope;
  }
}

TEST_F(Effects, SmaaIsNearerToTheTruth) {
  for (const double slope : {0.07, 0.21, 0.45, -0.13, -4.0}) {
    const Size size{97, 61};
    const auto scene = half_plane(size, slope);
    const Made made = run_stack("fx.smaa {}", scene, Way::plain);
    double before = 0, after = 0;
    for (int y = 8; y < size.height - 8; ++y)
      for (int x = 8; x < size.width - 8; ++x) {
        double covered = 0;  // of 16 × 16 points
        for (int j = 0; j < 16; ++j)
          for (int i = 0; i < 16; ++i)
            covered += y + (j + 0.5) / 16 > size.height / 2.0 + slope * (x + (i + 0.5) / 16 - size.width / 2.0);
        covered /= 256;
        before += std::abs(scene.source.at(x, y).r - covered);
        after += std::abs(made.result[4 * static_cast<std::size_t>(y * size.width + x)] - covered);
      }
    EXPECT_LT(after, 0.5 * before) << slope;
  }
}

/// A scene whose content moves by (dx, dy) pixels a frame, with noise of its own in each.
Scene noisy_frame(int frame, double dx, double dy, double noise) {
  Scene scene{"moving", DoubleImage(61, 37), DoubleImage(61, 37), {}};
  std::mt19937 random(static_cast<unsigned>(frame));
  std::normal_distribution<double> normal(0, noise);
  scene.motion.emplace(scene.source.size(), Rgba(-dx, -dy, 0, 1));
  for (int y = 0; y < 37; ++y)
    for (int x = 0; x < 61; ++x) {
      const double u = x - dx * frame, v = y - dy * frame;
      const double light = 0.5 + 0.3 * std::sin(u * 0.4) * std::cos(v * 0.3);
      for (int c = 0; c < 3; ++c) scene.source.at(x, y)[c] = std::max(light * (1 + 0.2 * c) + normal(random), 0.0);
      scene.depth->at(x, y).r = u > 20 ? 3 : 5;
    }
  scene.source = in_floats(scene.source);
  scene.motion = in_floats(*scene.motion);
  return scene;
}

std::string joined_entry(const TemporalAa& v) {
  return fmt::format("fx.taa {{ feedback = {}, bounds = {}, direction = \"{}\" }}", v.feedback, v.bounds,
                     v.to_next ? "to_next" : "to_previous");
}

TEST_F(Effects, TaaFollowsTheOracle) {
  for (const TemporalAa& v : {TemporalAa{}, TemporalAa{.feedback = 0.5, .bounds = 0.7, .to_next = true},
                              TemporalAa{.feedback = 0.98, .bounds = 10}})
    for (const bool alone : {false, true}) {
      TemporalPlayer player(joined_entry(v), alone);
      DoubleImage before;
      for (int frame = 1; frame <= 8; ++frame) {
        const Scene scene = noisy_frame(frame, 1.3, -0.6, 0.05);
        const auto result = player.play(scene, frame);
        before = temporal_aa(scene.source, frame > 1 ? &before : nullptr, *scene.motion, &*scene.depth, v);
        EXPECT_TRUE(agrees(result, before, 1e-4, kRgba)) << joined_entry(v) << " frame " << frame;
      }
    }
  expect_skipped("fx.taa { feedback = 0 }", "feedback is 0");
}

TEST_F(Effects, TaaTakesNoiseAndKeepsMotion) {
  TemporalPlayer player("fx.taa { feedback = 0.9, bounds = 3 }");
  std::vector<float> result;
  for (int frame = 1; frame <= 24; ++frame) result = player.play(noisy_frame(frame, 1, 0, 0.06), frame);
  const Scene noisy = noisy_frame(24, 1, 0, 0.06), clean = noisy_frame(24, 1, 0, 0);
  double before = 0, after = 0;
  for (int y = 4; y < 33; ++y)
    for (int x = 30; x < 57; ++x) {
      const double wanted = clean.source.at(x, y).r;
      before += std::pow(noisy.source.at(x, y).r - wanted, 2);
      after += std::pow(result[4 * static_cast<std::size_t>(y * 61 + x)] - wanted, 2);
    }
  EXPECT_LT(after, 0.3 * before);
}

}  // namespace
}  // namespace afterglow
