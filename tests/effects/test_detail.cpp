// SPDX-License-Identifier: MIT
// Effects on fine detail: sharpening, squares, edges, FXAA.
#include <fmt/format.h>

#include "cases.h"
#include "reference/detail.h"

namespace afterglow {
namespace {

using namespace reference;

EffectCase sharpened(double intensity, double contrast) {
  return {fmt::format("fx.sharpen {{ intensity = {}, contrast = {} }}", intensity, contrast),
          [=](const Scene& s) { return sharpen(s.source, intensity, contrast); }};
}

EffectCase pixelated(double size) {
  return {fmt::format("fx.pixelate {{ size = {} }}", size), [=](const Scene& s) { return pixelate(s.source, size); }};
}

EffectCase edged(const EdgeDetection& v) {
  static constexpr const char* kNames[] = {"sobel", "scharr", "roberts"};
  return {
      fmt::format("fx.edge_detection {{ operator = \"{}\", intensity = {}, threshold = {}, color = {{ {}, {}, {} }}, "
                  "background = {{ {}, {}, {} }}, background_opacity = {} }}",
                  kNames[static_cast<int>(v.kind)], v.intensity, v.threshold, v.color.r, v.color.g, v.color.b,
                  v.background.r, v.background.g, v.background.b, v.background_opacity),
      [=](const Scene& s) { return edge_detection(s.source, v); }};
}

EffectCase smoothed(const Fxaa& v) {
  static constexpr const char* kNames[] = {"low", "medium", "high"};
  return {
      fmt::format("fx.fxaa {{ fixed_threshold = {}, relative_threshold = {}, subpixel_blending = {}, quality = "
                  "\"{}\" }}",
                  v.fixed_threshold, v.relative_threshold, v.subpixel_blending, kNames[static_cast<int>(v.quality)]),
      [=](const Scene& s) { return fxaa(s.source, v); }};
}

TEST_F(Effects, SharpenAgrees) {
  agree_everywhere({sharpened(1, 0), sharpened(0.4, 0.5), sharpened(1, 1)});
  expect_skipped("fx.sharpen { intensity = 0 }", "intensity is 0");
}

TEST_F(Effects, SharpenLeavesFlatAndBrightPlacesAlone) {
  Scene scene{"steps", DoubleImage(12, 8, Rgba(0.3, 0.6, 0.9, 1)), {}, {}};
  for (int y = 0; y < 8; ++y)
    for (int x = 6; x < 12; ++x) scene.source.at(x, y) = Rgba(5, 7, 9, 1);  // above white: no room left
  scene.source = in_floats(scene.source);
  EXPECT_TRUE(agrees(run_stack("fx.sharpen { intensity = 1, contrast = 1 }", scene, Way::plain).result, scene.source,
                     1e-6, kRgba));
}

TEST_F(Effects, PixelateAgrees) {
  agree_everywhere({pixelated(2), pixelated(7), pixelated(64), pixelated(1024), pixelated(1.0000001), pixelated(1.3),
                    pixelated(2.5), pixelated(4.8078866)});
  expect_skipped("fx.pixelate { size = 1 }", "size is 1");
  // A picture of which the look sees one line: squares of 1024 of its pixels are larger than any picture.
  const auto scene = random_scene({240, 135}, 61);
  EXPECT_TRUE(agrees(run_stack("reference_height = 1, fx.pixelate { size = 1024 }", scene, Way::fused).result,
                     pixelate(scene.source, 1024), 1e-5, kRgba));
}

TEST_F(Effects, EdgeDetectionAgrees) {
  for (const auto kind : {EdgeOperator::sobel, EdgeOperator::scharr, EdgeOperator::roberts})
    agree_everywhere({edged({.kind = kind}), edged({.kind = kind,
                                                    .intensity = 0.7,
                                                    .threshold = 0.3,
                                                    .color = {0.1, 2, 0.3},
                                                    .background = {0.9, 0.8, 0.1},
                                                    .background_opacity = 0.6})},
                     kSteep);
  expect_skipped("fx.edge_detection { intensity = 0 }", "intensity and background_opacity are 0");
}

/// Lengths three times as long: no pixel between those that are compared is left out.
TEST_F(Effects, EdgeDetectionOfLargerPicturesAgrees) {
  for (const auto kind : {EdgeOperator::sobel, EdgeOperator::roberts}) {
    const auto scene = random_scene({75, 60}, 41);
    const EdgeDetection settings{.kind = kind, .intensity = 0.7, .apart = 3};
    for (const Way way : {Way::plain, Way::fused})
      EXPECT_TRUE(agrees(run_stack(edged(settings).entries, scene, way, 3).result,
                         edge_detection(scene.source, settings), way == Way::plain ? kSteep.full : kSteep.fused,
                         kRgba));
  }
}

TEST_F(Effects, AStepFromBlackToWhiteIsAnEdgeOfOne) {
  Scene scene{"step", DoubleImage(8, 8), {}, {}};
  for (int y = 0; y < 8; ++y)
    for (int x = 4; x < 8; ++x) scene.source.at(x, y) = Rgba(1, 1, 1, 1);
  for (const char* kind : {"sobel", "scharr", "roberts"}) {
    const auto made =
        run_stack(fmt::format("fx.edge_detection {{ operator = \"{}\", intensity = 0.5, threshold = 0, color "
                              "= {{ 1, 1, 1 }}, background = {{ 0, 0, 0 }}, background_opacity = 1 }}",
                              kind),
                  scene, Way::plain);
    EXPECT_NEAR(made.result[4 * (4 * 8 + 3)], 0.5, 1e-6) << kind;  // half of it: nothing is clamped
    EXPECT_NEAR(made.result[4 * (4 * 8 + 1)], 0, 1e-6) << kind;
  }
}

TEST_F(Effects, FxaaAgrees) {
  agree_everywhere({smoothed({}), smoothed({.subpixel_blending = 0, .quality = FxaaQuality::low}),
                    smoothed({.fixed_threshold = 0.0312, .relative_threshold = 0.063, .quality = FxaaQuality::medium})},
                   kDecisions);
  // Two flat tones: between two steps of an edge luma is off by just what is looked for.
  for (const double bright : {0.2, 0.5, 0.9, 1.0}) {
    const Scene scene{
        "tones",
        generate({90, 40}, [&](int x, int y) { return Rgba(Rgb(y > 6 + x / 7 && x < 70 + y / 5 ? bright : 0.05), 1); }),
        {},
        {}};
    for (const FxaaQuality quality : {FxaaQuality::low, FxaaQuality::medium, FxaaQuality::high}) {
      const EffectCase one = smoothed({.quality = quality});
      EXPECT_TRUE(agrees(run_stack(one.entries, scene, Way::plain).result, one.oracle(scene), kFullFloat, kRgba))
          << one.entries << bright;
    }
  }
}

TEST_F(Effects, FxaaSmoothsASlantAndKeepsFlatPlaces) {
  Scene scene{"slant", DoubleImage(64, 32), {}, {}};
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x)
      if (y > 8 + x / 8) scene.source.at(x, y) = Rgba(1, 1, 1, 1);
  const Made made = run_stack("fx.fxaa { subpixel_blending = 0 }", scene, Way::plain);
  int between = 0, changed_far_away = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) {
      const float v = made.result[4 * static_cast<std::size_t>(64 * y + x)];
      between += v > 0.02F && v < 0.98F;
      changed_far_away += std::abs(y - 8 - x / 8) > 2 && v != static_cast<float>(scene.source.at(x, y).r);
    }
  EXPECT_GT(between, 40);
  EXPECT_EQ(changed_far_away, 0);
}

}  // namespace
}  // namespace afterglow
