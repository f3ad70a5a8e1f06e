// SPDX-License-Identifier: MIT
// What a lens does: vignette, chromatic aberration, lens distortion.
#include <fmt/format.h>

#include "cases.h"
#include "reference/lens.h"

namespace afterglow {
namespace {

using namespace reference;

EffectCase darkened(const Vignette& v) {
  return {
      fmt::format("fx.vignette {{ intensity = {}, smoothness = {}, color = {{ {}, {}, {} }}, center = {{ {}, {} }}, "
                  "rounded = {} }}",
                  v.intensity, v.smoothness, v.color.r, v.color.g, v.color.b, v.center.x, v.center.y, v.rounded),
      [=](const Scene& s) { return vignette(s.source, v); }};
}

EffectCase fringed(double intensity, int samples) {
  return {fmt::format("fx.chromatic_aberration {{ intensity = {}, samples = {} }}", intensity, samples),
          [=](const Scene& s) { return chromatic_aberration(s.source, intensity, samples); }};
}

EffectCase bent(const LensDistortion& v) {
  return {fmt::format("fx.lens_distortion {{ intensity = {}, x_multiplier = {}, y_multiplier = {}, center = {{ {}, {} "
                      "}}, scale = {}, edges = \"{}\" }}",
                      v.intensity, v.x_multiplier, v.y_multiplier, v.center.x, v.center.y, v.scale,
                      v.edges == LensEdges::mirror  ? "mirror"
                      : v.edges == LensEdges::black ? "black"
                                                    : "stretch"),
          [=](const Scene& s) { return lens_distortion(s.source, v); }};
}

TEST_F(Effects, VignetteAgrees) {
  agree_everywhere({darkened({}), darkened({.intensity = 1, .smoothness = 1, .rounded = true}),
                    darkened({.intensity = 0.6, .smoothness = 0.05, .color = {0.2, 0.05, 0.4}, .center = {0.3, 0.9}})},
                   kSteep);
  expect_skipped("fx.vignette { intensity = 0 }", "intensity is 0");
  expect_skipped("fx.vignette { color = { 1, 1, 1 } }", "color is white");
}

TEST_F(Effects, ChromaticAberrationAgrees) {
  agree_everywhere({fringed(0.1, 3), fringed(1, 3), fringed(0.6, 8), fringed(1, 24)}, kBetweenPixels);
  expect_skipped("fx.chromatic_aberration { intensity = 0 }", "intensity is 0");
}

TEST_F(Effects, ChromaticAberrationKeepsWhatHasOneColour) {
  for (const Size size :
       {Size{33, 20}, Size{1, 3528}, Size{1917, 7}}) {  // long ways too, and those of parts of a pixel
    const Scene scene{"constant", DoubleImage(size, Rgba(0.25, 3, 0.5, 1)), {}, {}};
    EXPECT_TRUE(agrees(run_stack("fx.chromatic_aberration { intensity = 1, samples = 7 }", scene, Way::plain).result,
                       scene.source, size.width == 33 ? 1e-6 : 3e-6, kRgba))
        << size.width;
  }
}

TEST_F(Effects, LensDistortionAgrees) {
  agree_everywhere(
      {bent({.intensity = 0.4}), bent({.intensity = -0.6}), bent({.intensity = 0, .scale = 1.7}),
       bent({.intensity = 0.3, .x_multiplier = 0, .y_multiplier = 0.6, .center = {0.4, 0.55}, .scale = 0.8}),
       bent({.intensity = -0.3, .center = {0.6, 0.4}, .scale = 0.5, .edges = LensEdges::black}),
       bent({.intensity = 0.3, .center = {0.2, 0.9}}), bent({.intensity = -1, .scale = 2})},
      kBetweenPixels);
  // What is mirrored lies beyond the picture, where positions have fewer digits.
  agree_everywhere({bent({.intensity = 0.3, .scale = 0.6, .edges = LensEdges::mirror})},
                   {.full = 5e-3, .fused = 5e-4, .spikes = false});
  expect_skipped("fx.lens_distortion { intensity = 0 }", "nothing bends and scale is 1");
  expect_skipped("fx.lens_distortion { x_multiplier = 0, y_multiplier = 0 }", "nothing bends and scale is 1");
}

TEST_F(Effects, LensDistortionLeavesItsCentreAlone) {
  // A point of light at the centre of pixel (8, 30) of 32×40.
  Scene scene{"point", DoubleImage(32, 40, Rgba(0, 0, 0, 1)), {}, {}};
  scene.source.at(8, 30) = Rgba(4, 4, 4, 1);
  for (const char* entry : {"fx.lens_distortion { intensity = 0.6, center = { 8.5 / 32, 30.5 / 40 } }",
                            "fx.lens_distortion { intensity = -0.6, center = { 8.5 / 32, 30.5 / 40 }, scale = 1.7 }"}) {
    const auto pixels = run_stack(entry, scene, Way::plain).result;
    EXPECT_NEAR(pixels[(30 * 32 + 8) * 4], 4, 1e-3) << entry;
    EXPECT_LT(pixels[(20 * 32 + 16) * 4], 1e-3) << entry;
  }
}

}  // namespace
}  // namespace afterglow
