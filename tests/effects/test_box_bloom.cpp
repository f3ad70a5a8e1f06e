// SPDX-License-Identifier: MIT
// Box bloom, pass by pass.
#include <fmt/format.h>

#include "harness.h"
#include "reference/box_bloom.h"

namespace afterglow {
namespace {

using namespace reference;

std::string lua(const BoxBloomSettings& s) {
  return fmt::format("fx.box_bloom {{ threshold = {}, blur_iterations = {}, pattern = \"{}\", brightness = \"{}\" }}",
                     s.threshold, s.blur_iterations, s.pattern == BoxPattern::plus ? "plus" : "box",
                     s.brightness == BoxBrightness::max ? "max" : "luma");
}

std::string box_bloom_image(const char* name, std::size_t i) { return fmt::format("box_bloom.{}[{}]", name, i); }

void check(const Scene& scene, const BoxBloomSettings& settings) {
  SCOPED_TRACE(scene.name + ": " + lua(settings));
  const auto expected = box_bloom(scene.source, settings);
  const Made made = run_stack(lua(settings), scene, Way::plain);
  const std::size_t n = expected.down.size();

  EXPECT_TRUE(agrees(made.pixels("box_bloom.threshold"), expected.down[0], kFullFloat, kRgb));
  for (std::size_t i = 1; i < n; ++i) {
    const auto& down = made.pixels(box_bloom_image("down", i));
    EXPECT_TRUE(agrees(down, expected.down[i], kFullFloat, kRgb)) << "down " << i;
    const auto before = made.image(i == 1 ? "box_bloom.threshold" : box_bloom_image("down", i - 1));
    EXPECT_TRUE(agrees(down, box_bloom_blur(before, expected.down[i].size(), settings.pattern), kFullFloat, kRgb))
        << "down " << i;
  }
  EXPECT_FALSE(made.has(box_bloom_image("down", n)));
  for (std::size_t i = 1; i + 1 < n; ++i) {
    EXPECT_TRUE(agrees(made.pixels(box_bloom_image("up", i)), expected.blur_up[i], kFullFloat, kRgb)) << "up " << i;
    EXPECT_TRUE(agrees(made.pixels(box_bloom_image("combine", i)), expected.up[i], kFullFloat, kRgb))
        << "combine " << i;
  }
  if (n > 1) {
    EXPECT_TRUE(agrees(made.pixels("box_bloom.up"), expected.final_up, kFullFloat, kRgb));
  }
  EXPECT_TRUE(agrees(made.result, expected.result, kFullFloat, kRgba));
  EXPECT_TRUE(alpha_is_kept(made, scene));
  const Made fused = run_stack(lua(settings), scene, Way::fused);
  EXPECT_TRUE(agrees(fused.result, from_floats(made.result.data(), made.size, 4), kFused, kRgba)) << "fused";
}

TEST_F(Effects, BoxBloomAgreesAtEverySize) {
  int turn = 0;
  for (const Size size : kSizes)
    for (const auto pattern : {BoxPattern::plus, BoxPattern::box}) {
      const auto brightness = turn++ % 3 == 0 ? BoxBrightness::luma : BoxBrightness::max;
      check(random_scene(size, 11, turn % 2 == 0), {0.15 * turn, 7 - turn % 4, pattern, brightness});
    }
}

TEST_F(Effects, BoxBloomOfARealFrameAgreesAtEveryCount) {
  for (int n = 0; n <= 7; ++n) check(neon_scene({160, 91}, 350, 200), {.blur_iterations = n});
}

}  // namespace
}  // namespace afterglow
