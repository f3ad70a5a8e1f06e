// SPDX-License-Identifier: MIT
// Whole stacks as users run them: passes fused, in full and half floats.
#include "harness.h"
#include "reference/bloom.h"
#include "reference/box_bloom.h"
#include "reference/color_adjustments.h"
#include "reference/outline.h"
#include "reference/tone_mapping.h"

namespace afterglow {
namespace {

using namespace reference;

struct Look {
  int effects;  ///< that run: each may differ by kFused, and those behind it make more of it or less
  const char* entries;
  DoubleImage (*oracle)(const Scene&);
};

const Look kLooks[] = {
    {3,
     "fx.bloom { mode = \"scattering\", fade_fireflies = true }, fx.tone_mapping {}, "
     "fx.color_adjustments { post_exposure = 0.3, contrast = 15, saturation = 10 }",
     [](const Scene& s) {
       const auto bloomed = bloom(s.source, {.mode = BloomMode::scattering, .fade_fireflies = true}).result;
       return tone_mapping(color_adjustments(bloomed, {.post_exposure = 0.3, .contrast = 15, .saturation = 10}),
                           ToneMode::aces);
     }},
    {3,
     "fx.color_adjustments { contrast = -10 }, fx.tone_mapping { mode = \"neutral\" }, fx.bloom { bicubic_upsampling = "
     "false }",
     [](const Scene& s) {  // listed in another order than they run
       const auto bloomed = bloom(s.source, {.bicubic_upsampling = false}).result;
       return tone_mapping(color_adjustments(bloomed, {.contrast = -10}), ToneMode::neutral);
     }},
    {2, "fx.box_bloom {}, fx.tone_mapping { mode = \"reinhard\" }",
     [](const Scene& s) { return tone_mapping(box_bloom(s.source, {}).result, ToneMode::reinhard); }},
    {2,
     "fx.outline { normal_scale = 0.5, depth_scale = 0.1, fade_distance = 1e12, color = { 0.5, 0.25, 0.125 } }, "
     "fx.tone_mapping { mode = \"neutral\" }",
     [](const Scene& s) {
       return tone_mapping(
           outline(s.source, &*s.depth, &*s.normal,
                   {.fade_distance = 1e12, .depth_scale = 0.1, .normal_scale = 0.5, .color = {0.5, 0.25, 0.125}}),
           ToneMode::neutral);
     }},
};

void check(const Scene& scene) {
  for (const auto& look : kLooks) {
    SCOPED_TRACE(scene.name + ": " + look.entries);
    const auto expected = look.oracle(scene);
    const Made plain = run_stack(look.entries, scene, Way::plain);
    EXPECT_TRUE(agrees(plain.result, expected, kFullFloat, kRgba)) << "plain";
    const Made fused = run_stack(look.entries, scene, Way::fused);
    EXPECT_TRUE(agrees(fused.result, expected, kFullFloat, kRgba)) << "fused";
    EXPECT_TRUE(agrees(fused.result, from_floats(plain.result.data(), plain.size, 4), look.effects * kFused, kRgba))
        << "fused and plain";
    const Made half = run_stack(look.entries, scene, Way::fused_half);
    EXPECT_TRUE(agrees(half.result, expected, kHalfFloat, kRgba)) << "half";
  }
}

TEST_F(Effects, LooksAgreeInFullAndHalfFloatsAtEverySize) {
  for (const Size size : kSizes) check(random_scene(size, 41));
}

TEST_F(Effects, LooksAgreeInFullAndHalfFloatsWithSpikes) { check(random_scene({240, 135}, 42, true)); }

TEST_F(Effects, LooksAgreeInFullAndHalfFloatsOnARealFrame) { check(neon_scene({320, 180}, 300, 380)); }

}  // namespace
}  // namespace afterglow
