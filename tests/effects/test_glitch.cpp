// SPDX-License-Identifier: MIT
// Glitch: whole pixels, so device and oracle agree to the bit.
#include <fmt/format.h>

#include "cases.h"
#include "reference/glitch.h"

namespace afterglow {
namespace {

using namespace reference;

EffectCase broken(const Glitch& v) {
  return {fmt::format("fx.glitch {{ scan_line_jitter = {}, line_height = {}, horizontal_shake = {}, rgb_split = {}, "
                      "vertical_roll = {}, edges = \"{}\", seed = {} }}",
                      v.scan_line_jitter, v.line_height, v.horizontal_shake, v.rgb_split, v.vertical_roll,
                      v.stretch ? "stretch" : "wrap", v.seed),
          [=](const Scene& s) {
            auto settings = v;
            settings.frame = static_cast<std::uint32_t>(s.frame);
            settings.time = (s.frame - 1) / 24;
            return glitch(s.source, settings);
          }};
}

TEST_F(Effects, GlitchAgreesToTheBit) {
  const std::vector<EffectCase> cases{
      broken({}),
      broken({.scan_line_jitter = 1, .line_height = 1, .horizontal_shake = 1, .rgb_split = 1, .seed = 9}),
      broken({.scan_line_jitter = 0, .rgb_split = 0, .vertical_roll = 1.7}),
      broken({.scan_line_jitter = 1, .horizontal_shake = 1, .rgb_split = 1, .vertical_roll = 0.3, .stretch = true}),
      broken({.scan_line_jitter = 0.6, .line_height = 7, .vertical_roll = -0.9}),
      broken({.scan_line_jitter = 0.96592265, .line_height = 12.414532})};
  for (const Size size : kSizes)
    for (const auto& one : cases)
      for (const double frame : {1.0, 12.0}) {
        auto scene = random_scene(size, 68);
        scene.frame = frame;
        for (const Way way : {Way::plain, Way::fused, Way::fused_half})
          EXPECT_TRUE(agrees(run_stack(one.entries, scene, way).result, one.oracle(scene),
                             way == Way::fused_half ? kHalfFloat : 0, kRgba))
              << one.entries << scene.name << " frame " << frame;
      }
  expect_skipped("fx.glitch { scan_line_jitter = 0, rgb_split = 0 }", "all settings are 0");
}

TEST_F(Effects, GlitchDependsOnTheFrameAlone) {
  auto scene = random_scene({64, 64}, 69);
  const auto run = [&](double frame) {
    scene.frame = frame;
    return run_stack("fx.glitch { scan_line_jitter = 0.8 }", scene, Way::plain).result;
  };
  const auto first = run(1);
  EXPECT_NE(first, run(2));
  EXPECT_EQ(first, run(1));
}

}  // namespace
}  // namespace afterglow
