// SPDX-License-Identifier: MIT
// Blurs of the whole picture: dual Kawase, radial, directional, bokeh.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "cases.h"
#include "reference/blurs.h"

namespace afterglow {
namespace {

using namespace reference;

EffectCase kawase(int iterations, double offset) {
  return {fmt::format("fx.dual_kawase {{ iterations = {}, offset = {} }}", iterations, offset),
          [=](const Scene& s) { return dual_kawase(s.source, iterations, offset); }};
}

EffectCase zoomed(double intensity, int samples, Point center) {
  return {fmt::format("fx.radial_blur {{ intensity = {}, samples = {}, center = {{ {}, {} }} }}", intensity, samples,
                      center.x, center.y),
          [=](const Scene& s) { return radial_blur(s.source, intensity, samples, center); }};
}

EffectCase smeared(double distance, double angle) {
  return {fmt::format("fx.directional_blur {{ distance = {}, angle = {} }}", distance, angle),
          [=](const Scene& s) { return directional_blur(s.source, distance, angle); }};
}

EffectCase defocused(const BokehBlur& v) {
  return {fmt::format("fx.bokeh_blur {{ radius = {}, blades = {}, rotation = {}, highlights = {} }}", v.radius,
                      v.blades, v.rotation, v.highlights),
          [=](const Scene& s) { return bokeh_blur(s.source, v); }};
}

Scene point(Size size) {
  Scene scene{"point", DoubleImage(size), {}, {}};
  scene.source.at(size.width / 2, size.height / 2) = Rgba(1000, 1000, 1000, 1);
  return scene;
}

TEST_F(Effects, DualKawaseAgrees) {
  // 1x1 has no half; every other size has.
  for (const Size size : kSizes)
    if (size.width > 1)
      for (const auto& one : {kawase(1, 1), kawase(3, 1.4), kawase(12, 0.3)}) {
        const auto scene = random_scene(size, 63, true);
        EXPECT_TRUE(agrees(run_stack(one.entries, scene, Way::plain).result, one.oracle(scene), kFullFloat, kRgba))
            << one.entries << scene.name;
      }
  const auto scene = neon_scene({160, 90}, 560, 330);
  const auto one = kawase(4, 1);
  EXPECT_TRUE(agrees(run_stack(one.entries, scene, Way::fused).result, one.oracle(scene), kFullFloat, kRgba));
  EXPECT_TRUE(agrees(run_stack(one.entries, scene, Way::fused_half).result, one.oracle(scene), kHalfFloat, kRgba));
  expect_skipped("fx.dual_kawase { iterations = 0 }", "iterations is 0");
  const Made tiny = run_stack("fx.dual_kawase {}", random_scene({1, 1}, 64), Way::plain);
  EXPECT_EQ(tiny.graph.skipped.at(0).reason, "the picture is a single row or column");
}

TEST_F(Effects, RadialBlurAgrees) {
  agree_everywhere({zoomed(0.15, 16, {0.5, 0.5}), zoomed(1, 33, {0.2, 0.9}), zoomed(0.4, 2, {1, 0})}, kBetweenPixels);
  // A streak of 500 pixels, made in both ways.
  const EffectCase both = zoomed(1 - std::exp(-500 / std::hypot(150, 100)), 8, {0.5, 0.5});
  const Scene scene = random_scene({300, 200}, 3);
  EXPECT_TRUE(
      agrees(run_stack(both.entries, scene, Way::plain).result, both.oracle(scene), kBetweenPixels.full, kRgba));
  expect_skipped("fx.radial_blur { intensity = 0 }", "intensity is 0");
}

TEST_F(Effects, RadialBlurGrowsWithoutJumps) {
  const Scene scene = random_scene({64, 36}, 5);
  const auto streaked = [&](double length) {
    const double intensity = 1 - std::exp(-length / std::hypot(32, 18));
    return run_stack(zoomed(intensity, 8, {0.5, 0.5}).entries, scene, Way::plain).result;
  };
  std::vector<float> before = streaked(1.9);
  for (double length = 1.95; length < 4.3; length += 0.05) {
    const std::vector<float> now = streaked(length);
    for (std::size_t i = 0; i < now.size(); ++i)
      ASSERT_NEAR(now[i], before[i], 0.09 * std::max(before[i], 1.0F)) << length << ' ' << i / 4;
    before = now;
  }
}

/// Wherever it is: halves of odd sizes would read some texels twice and others not.
TEST_F(Effects, DualKawaseKeepsTheLightOfAPoint) {
  for (const Size size : {Size{301, 301}, Size{250, 125}, Size{256, 128}})
    for (const double offset : {1.0, 1.4})
      for (const int x : {40, 83, size.width / 2, size.width / 2 + 1, 170}) {
        Scene scene{"lamp", DoubleImage(size), {}, {}};
        scene.source.at(x, size.height / 2) = Rgba(1000, 1000, 1000, 1);
        const DoubleImage made = dual_kawase(scene.source, 3, offset);
        double sum = 0;
        for (const auto& p : made.pixels) sum += p.r;
        EXPECT_NEAR(sum / 1000, 1, 0.06) << size.width << ' ' << offset << ' ' << x;
      }
}

TEST_F(Effects, DirectionalBlurAgrees) {
  agree_everywhere({smeared(24, 0), smeared(7.5, 90), smeared(100, -33), smeared(0.4, 45), smeared(35, 0),
                    smeared(35.01, 90), smeared(63, 0), smeared(40, 180), smeared(1e-15, 20), smeared(1e-5, 0)});
  expect_skipped("fx.directional_blur { distance = 0 }", "distance is 0");
}

TEST_F(Effects, DirectionalBlurIsAsLongAsItSays) {
  const auto made = run_stack("fx.directional_blur { distance = 24 }", point({65, 9}), Way::plain).result;
  const auto at = [&](int x, int y) { return made[4 * static_cast<std::size_t>(65 * y + x)]; };
  for (int x = 32 - 11; x <= 32 + 11; ++x) EXPECT_NEAR(at(x, 4), 1000.0 / 24, 0.01) << x;
  for (const int x : {32 - 12, 32 + 12}) EXPECT_NEAR(at(x, 4), 500.0 / 24, 0.01) << x;
  EXPECT_EQ(at(32 - 14, 4), 0);
  EXPECT_EQ(at(32 + 14, 4), 0);
  EXPECT_EQ(at(32, 3), 0);
}

TEST_F(Effects, DirectionalBlurIsTheMeanAlongItsLine) {
  const Scene scene = random_scene({61, 31}, 66);
  for (const double distance : {0.6, 3.0, 7.3, 19.5}) {
    const auto made =
        run_stack(fmt::format("fx.directional_blur {{ distance = {} }}", distance), scene, Way::plain).result;
    constexpr int kReads = 4000;
    for (const int x : {0, 15, 30, 58}) {
      Rgba sum(0);
      for (int i = 0; i < kReads; ++i)
        sum += sample_linear(scene.source, x + 0.5 + distance * ((i + 0.5) / kReads - 0.5), 15.5);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(made[4 * static_cast<std::size_t>(61 * 15 + x) + static_cast<std::size_t>(c)], sum[c] / kReads,
                    1e-5 * (1 + sum[c] / kReads))
            << distance << ' ' << x;
    }
  }
}

/// Beyond the picture lies its last pixel, however many pieces a line is laid of.
TEST_F(Effects, DirectionalBlurAtTheBordersIsTheMeanToo) {
  const Scene scene{
      "border", generate({120, 6}, [](int x, int) { return Rgba(Rgb(x < 2 || x == 119 ? 1 : 0), 1); }), {}, {}};
  for (const double distance : {34.9, 35.1, 40.0, 62.9, 63.1, 80.0, 99.1}) {
    const auto made =
        run_stack(fmt::format("fx.directional_blur {{ distance = {} }}", distance), scene, Way::plain).result;
    constexpr int kReads = 4000;
    for (const int x : {0, 1, 2, 5, 12, 110, 117, 119}) {
      double sum = 0;
      for (int i = 0; i < kReads; ++i)
        sum += sample_linear(scene.source, x + 0.5 + distance * ((i + 0.5) / kReads - 0.5), 3.5).r;
      EXPECT_NEAR(made[4 * static_cast<std::size_t>(120 * 3 + x)], sum / kReads, 0.012) << distance << ' ' << x;
    }
  }
}

/// How far apart two smears of a small light are: the sum of the absolute differences, in parts of the light.
double change(double from, double to, double angle) {
  const DoubleImage light = generate({141, 141}, [](int x, int y) {
    return Rgba(Rgb(std::exp(-((x - 70) * (x - 70) + (y - 70) * (y - 70)) / 4.0)), 1);
  });
  const DoubleImage a = directional_blur(light, from, angle), b = directional_blur(light, to, angle);
  double sum = 0, whole = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    sum += std::abs(a.pixels[i].r - b.pixels[i].r);
    whole += light.pixels[i].r;
  }
  return sum / whole;
}

TEST_F(Effects, DirectionalBlurGrowsWithoutJerks) {
  for (const double angle : {0.0, 20.0, 45.0, 90.0})
    for (double distance = 0.2; distance < 120; distance = 1.02 * distance + 0.1)
      EXPECT_LT(change(distance, 1.002 * distance, angle), 0.005) << distance << ' ' << angle;
  for (const double columns : {35.0, 63.0, 99.0})  // another number of reads begins
    for (const double angle : {0.0, 20.0, 45.0}) {
      const double at = columns / std::cos(angle * std::numbers::pi / 180);
      EXPECT_LT(change(0.9999 * at, 1.0001 * at, angle), angle == 20 ? 0.05 : 0.001) << columns << ' ' << angle;
    }
}

TEST_F(Effects, BokehBlurAgrees) {
  agree_everywhere({defocused({}), defocused({.radius = 3, .blades = 6, .rotation = 20, .highlights = 10}),
                    defocused({.radius = 40, .blades = 5}), defocused({.radius = 0.5, .highlights = 50}),
                    defocused({.radius = 64, .blades = 3, .rotation = -80}), defocused({.radius = 13}),
                    defocused({.radius = 2.6, .blades = 8}), defocused({.radius = 20, .blades = 6, .rotation = 10}),
                    defocused({.radius = 30}), defocused({.radius = 0.01}), defocused({.radius = 0.08, .blades = 3})});
  expect_skipped("fx.bokeh_blur { radius = 0 }", "radius is 0");
}

TEST_F(Effects, LengthsOfASmallReferenceAgreeOnALargePicture) {
  const Scene scene = neon_scene({160, 90}, 560, 330);
  const auto agree = [&](const std::string& entries, const DoubleImage& truth) {
    EXPECT_TRUE(agrees(run_stack(entries, scene, Way::plain).result, truth, kFullFloat, kRgba)) << entries;
  };
  for (const double factor : {2.0, 3.0, 7.5, 15.0, 90.0}) {
    agree(fmt::format("reference_height = {}, fx.bokeh_blur {{ radius = 50, blades = 5 }}", 90 / factor),
          bokeh_blur(scene.source, {.radius = 50 * factor, .blades = 5}));
    agree(fmt::format("reference_height = {}, fx.directional_blur {{ distance = 1000, angle = 20 }}", 90 / factor),
          directional_blur(scene.source, 1000 * factor, 20));
  }
}

TEST_F(Effects, BokehOfAPointIsAnEvenDiscOfItsLight) {
  for (const int radius : {3, 6, 9, 14, 20, 33, 50, 64}) {
    const int side = 2 * radius + 61, middle = side / 2;
    const auto made =
        run_stack(fmt::format("fx.bokeh_blur {{ radius = {} }}", radius), point({side, side}), Way::plain).result;
    double sum = 0, outside = 0, inside = 0, squares = 0;
    int count = 0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const double v = made[4 * static_cast<std::size_t>(side * y + x)], r = std::hypot(x - middle, y - middle);
        sum += v;
        if (r > 1.3 * radius + 4) outside += v;
        if (r > 0.75 * radius - 3) continue;
        inside += v, squares += v * v, ++count;
      }
    EXPECT_NEAR(sum, 1000, 20) << radius;
    EXPECT_LT(outside, 10) << radius;
    if (count == 0) continue;
    const double mean = inside / count;
    EXPECT_LT(std::sqrt(glm::max(squares / count - mean * mean, 0.0)), 0.06 * mean) << radius;
  }
}

/// Where the light is, from the middle of the picture, and how far spread: the root of the mean square of an axis.
struct Spread {
  double x = 0, y = 0, deviation = 0;
};

Spread spread_of_bokeh(double radius, int blades, int moved) {
  Scene scene{"point", DoubleImage(240, 240), {}, {}};
  scene.source.at(120 + moved, 120) = Rgba(1000, 1000, 1000, 1);
  const auto made =
      run_stack(fmt::format("fx.bokeh_blur {{ radius = {}, blades = {} }}", radius, blades), scene, Way::plain).result;
  double sum = 0, x = 0, y = 0, squares = 0;
  for (int j = 0; j < 240; ++j)
    for (int i = 0; i < 240; ++i) {
      const double v = made[4 * static_cast<std::size_t>(240 * j + i)];
      sum += v, x += v * (i - 120), y += v * (j - 120), squares += v * ((i - 120) * (i - 120) + (j - 120) * (j - 120));
    }
  x /= sum, y /= sum;
  return {x, y, std::sqrt((squares / sum - x * x - y * y) / 2)};
}

TEST_F(Effects, BokehIsAsWideAsItsIrisAtEveryRadius) {
  for (const double radius :
       {0.3, 1.0, 2.6, 3.2, 3.4, 3.9, 4.1, 4.95, 5.05, 10.9, 11.1, 13.9, 14.1, 15.9, 16.1, 27.9, 28.1, 39.9, 40.1})
    for (const int blades : {0, 3, 6}) {
      const double ideal = radius / 2 * (blades == 0 ? 1 : std::sqrt(blades == 3 ? 0.5 : 2.5 / 3));
      EXPECT_NEAR(spread_of_bokeh(radius, blades, 0).deviation, ideal, 0.03 * ideal) << radius << ' ' << blades;
    }
}

TEST_F(Effects, BokehGrowsWithoutJumps) {
  // A point's light at its middle, and how wide it is, while the radius of an iris grows by 2 %.
  const auto of_middle = [](double radius, int blades) {
    const auto entry = fmt::format("fx.bokeh_blur {{ radius = {}, blades = {}, rotation = 17 }}", radius, blades);
    return run_stack(entry, point({48, 48}), Way::plain).result[4 * (24 * 48 + 24)];
  };
  for (const int blades : {0, 3, 4, 5, 7}) {
    double before = of_middle(1.5, blades);
    for (double radius = 1.53; radius < 7.5; radius *= 1.02) {
      const double now = of_middle(radius, blades);
      EXPECT_GT(now, 0.85 * before) << radius << ' ' << blades;
      EXPECT_LT(now, 1.1 * before) << radius << ' ' << blades;
      before = now;
    }
  }
}

TEST_F(Effects, BokehMovesWithItsLight) {
  for (const double radius : {4.0, 10.0, 14.0, 24.0, 30.0, 60.0})
    for (const int moved : {0, 1, 2, 3, 5}) {
      const Spread light = spread_of_bokeh(radius, 0, moved);
      EXPECT_NEAR(light.x, moved, 0.02) << radius;
      EXPECT_NEAR(light.y, 0, 0.02) << radius;
    }
}

TEST_F(Effects, BlursKeepOneColour) {
  const Scene scene{"constant", DoubleImage(37, 22, Rgba(0.25, 0.75, 0.5, 1)), {}, {}};
  for (const char* entries : {"fx.dual_kawase {}", "fx.radial_blur {}", "fx.directional_blur { angle = 30 }",
                              "fx.bokeh_blur {}", "fx.bokeh_blur { blades = 6, highlights = 8 }"})
    EXPECT_TRUE(agrees(run_stack(entries, scene, Way::plain).result, scene.source, 2e-6, kRgba)) << entries;
}

}  // namespace
}  // namespace afterglow
