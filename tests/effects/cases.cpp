// SPDX-License-Identifier: MIT
#include "cases.h"

namespace afterglow {
namespace {

using namespace reference;

void check(const Scene& scene, const EffectCase& one, const Tolerances& tolerances, bool half_too) {
  SCOPED_TRACE(scene.name + ": " + one.entries);
  const auto expected = one.oracle(scene);
  const Made plain = run_stack(one.entries, scene, Way::plain);
  ASSERT_TRUE(plain.ran());
  EXPECT_TRUE(agrees(plain.result, expected, tolerances.full, kRgba)) << "plain";
  EXPECT_TRUE(alpha_is_kept(plain, scene));
  const Made fused = run_stack(one.entries, scene, Way::fused);
  EXPECT_TRUE(agrees(fused.result, from_floats(plain.result.data(), plain.size, 4), tolerances.fused, kRgba))
      << "fused";
  const Made computed = run_stack(one.entries, scene, Way::computed);
  if (computed.dispatches > 0) {
    EXPECT_TRUE(agrees(computed.result, expected, tolerances.full, kRgba)) << "by workgroups";
  }
  if (half_too) {
    const Made dispatched = run_stack(one.entries, scene, Way::dispatched);
    EXPECT_TRUE(agrees(dispatched.result, from_floats(plain.result.data(), plain.size, 4), tolerances.fused, kRgba))
        << "dispatched";
    EXPECT_GT(dispatched.dispatches, 0u) << "dispatched";
    DoubleImage held = expected;
    for (auto& p : held.pixels) p = glm::min(p, Rgba(65504));
    const Made half = run_stack(one.entries, scene, Way::fused_half);
    EXPECT_TRUE(agrees(half.result, held, tolerances.half, kRgba)) << "half";
  }
}

}  // namespace

void agree_everywhere(const std::vector<EffectCase>& cases, const Tolerances& tolerances) {
  for (const Size size : kSizes) {
    const auto scene = random_scene(size, 61, tolerances.spikes && size.width % 2 == 1);
    for (const auto& one : cases) check(scene, one, tolerances, size.width == 101);
  }
  const auto scene = neon_scene({160, 90}, 560, 330);
  for (const auto& one : cases) check(scene, one, tolerances, true);
}

void expect_skipped(const std::string& entries, const std::string& reason) {
  const Made made = run_stack(entries, random_scene({8, 8}, 62), Way::plain);
  EXPECT_FALSE(made.ran()) << entries;
  ASSERT_EQ(made.graph.skipped.size(), 1u) << entries;
  EXPECT_EQ(made.graph.skipped[0].reason, reason) << entries;
}

}  // namespace afterglow
