// SPDX-License-Identifier: MIT
// Anamorphic streaks and lens dirt.
#include <fmt/format.h>

#include "cases.h"
#include "files.h"
#include "reference/glare.h"

namespace afterglow {
namespace {

using namespace reference;

EffectCase streaked(const AnamorphicStreaks& v) {
  return {
      fmt::format("fx.anamorphic_streaks {{ threshold = {}, stretch = {}, intensity = {}, tint = {{ {}, {}, {} }} }}",
                  v.threshold, v.stretch, v.intensity, v.tint.r, v.tint.g, v.tint.b),
      [=](const Scene& s) { return anamorphic_streaks(s.source, v); }};
}

EffectCase dirty(const LensDirt& v) {
  return {fmt::format("fx.lens_dirt {{ intensity = {}, threshold = {}, density = {}, size = {}, seed = {} }}",
                      v.intensity, v.threshold, v.density, v.size, v.seed),
          [=](const Scene& s) { return lens_dirt(s.source, v); }};
}

TEST_F(Effects, AnamorphicStreaksAgree) {
  agree_everywhere({streaked({.threshold = 0.5}), streaked({.threshold = 0, .stretch = 1, .intensity = 3}),
                    streaked({.threshold = 1, .stretch = 0, .tint = {2, 0, 0.5}})});
  expect_skipped("fx.anamorphic_streaks { intensity = 0 }", "intensity is 0");
  expect_skipped("fx.anamorphic_streaks { tint = { 0, 0, 0 } }", "tint is black");
}

TEST_F(Effects, StreaksLieFlat) {
  Scene scene{"point", DoubleImage(128, 32), {}, {}};
  scene.source.at(64, 16) = Rgba(1000, 1000, 1000, 1);
  const auto made = run_stack("fx.anamorphic_streaks {}", scene, Way::plain).result;
  const auto blue = [&](int x, int y) { return made[4 * static_cast<std::size_t>(128 * y + x) + 2]; };
  EXPECT_GT(blue(40, 16), 0.1F);
  EXPECT_EQ(blue(64, 12), 0);
  EXPECT_EQ(blue(64, 20), 0);
}

TEST_F(Effects, LensDirtAgrees) {
  agree_everywhere({dirty({}), dirty({.intensity = 5, .threshold = 0, .density = 1, .size = 0.3, .seed = 3}),
                    dirty({.threshold = 0.3, .density = 0.1, .size = 0.01})},
                   {.full = 2e-3, .fused = 2e-4, .spikes = false});  // hard rims of specks, times light
  expect_skipped("fx.lens_dirt { intensity = 0 }", "intensity is 0");
  expect_skipped("fx.lens_dirt { density = 0 }", "density is 0");
}

TEST_F(Effects, LensDirtMayBeAPicture) {
  for (const Size size : {Size{7, 5}, Size{301, 190}}) {
    const DoubleImage dirt = write_test_picture("dirt.exr", size);
    agree_everywhere(
        {{"fx.lens_dirt { texture = \"dirt.exr\", density = 0, threshold = 0.5, intensity = 2 }",
          [&](const Scene& s) { return lens_dirt(s.source, {.intensity = 2, .threshold = 0.5, .texture = &dirt}); }}},
        kBetweenPixels);
  }
}

TEST_F(Effects, DirtComesBitByBit) {
  const Scene scene{"bright", DoubleImage(120, 80, Rgba(2, 2, 2, 1)), {}, {}};
  const auto made = [&](double density) {
    return run_stack(dirty({.intensity = 1, .threshold = 0.2, .density = density}).entries, scene, Way::plain).result;
  };
  std::vector<float> before = made(0.2);
  for (double density = 0.202; density < 0.4; density += 0.002) {
    const std::vector<float> now = made(density);
    for (std::size_t i = 0; i < now.size(); ++i) ASSERT_NEAR(now[i], before[i], 0.12) << density << ' ' << i / 4;
    before = now;
  }
}

TEST_F(Effects, LensDirtNeedsLight) {
  const Scene scene{"dim", DoubleImage(64, 64, Rgba(0.5, 0.75, 0.25, 1)), {}, {}};
  EXPECT_TRUE(agrees(run_stack("fx.lens_dirt { intensity = 50 }", scene, Way::plain).result, scene.source, 0, kRgba));
}

}  // namespace
}  // namespace afterglow
