// SPDX-License-Identifier: MIT
// A failing case becomes as small as it can.
#include "bad_effects.h"
#include "stress/shrink.h"

namespace afterglow::stress {
namespace {

SettingValue of(double v) { return {.type = SettingType::number, .number = {v, 0, 0}}; }

int bright_pixels(const Picture& picture, float above) {
  int count = 0;
  for (std::size_t i = 0; i < picture.color.pixels.size(); i += 4) count += picture.color.pixels[i] > above;
  return count;
}

/// A fault that wants one entry, one setting of it, and two bright pixels in one row.
bool planted(const Situation& s) {
  bool strong = false;
  for (const auto& entry : s.look.entries)
    if (const auto* value = entry.find("strength"); entry.effect == "b" && value) strong = value->number[0] > 0.25;
  if (!strong) return false;
  for (int y = 0; y < s.picture.color.height; ++y) {
    int bright = 0;
    for (int x = 0; x < s.picture.color.width; ++x) bright += s.picture.color.at(x, y)[0] > 10;
    if (bright >= 2) return true;
  }
  return false;
}

TEST(StressShrink, FindsTheMinimalCaseOfAPlantedFault) {
  Look look{{{.effect = "a", .settings = {{"strength", of(1)}}, .at = {}},
             {.effect = "b", .settings = {{"level", of(3)}, {"strength", of(0.75)}, {"width", of(2)}}, .at = {}},
             {.effect = "c", .settings = {}, .at = {}}},
            {}};
  Situation start = situation(look, "finite", {"log_uniform", {64, 48}, 5});
  ASSERT_TRUE(planted(start));
  const Shrunk small = shrink(start, planted, 400);
  EXPECT_TRUE(planted(small.situation));
  ASSERT_EQ(small.situation.look.entries.size(), 1u);
  EXPECT_EQ(small.situation.look.entries[0].effect, "b");
  ASSERT_EQ(small.situation.look.entries[0].settings.size(), 1u);
  EXPECT_EQ(small.situation.look.entries[0].settings[0].first, "strength");
  EXPECT_EQ(small.situation.picture.color.height, 1);
  EXPECT_EQ(bright_pixels(small.situation.picture, 0), 2);
  // Auxiliary images stay as large as the colour.
  for (const auto& [name, image] : small.situation.picture.auxiliary)
    EXPECT_EQ(image.size(), small.situation.picture.color.size()) << name;
  EXPECT_LE(small.tries, 400);
}

TEST(StressShrink, StopsAfterItsTries) {
  int calls = 0;
  const auto count = [&](const Situation&) {
    ++calls;
    return false;
  };
  const Situation start =
      situation({{{.effect = "a", .settings = {{"x", of(1)}}, .at = {}}}, {}}, "finite", {"render", {64, 64}, 1});
  const Shrunk same = shrink(start, count, 10);
  EXPECT_EQ(calls, 10);
  EXPECT_EQ(same.tries, 10);
  EXPECT_EQ(same.situation.picture.color.size(), (Size{64, 64}));
}

TEST(StressShrink, OnADevice) {
  const EffectFolder folder;
  folder.effect("broken",
                "vec4 apply(vec4 color) { return strength > 0.8 && color.r > 20.0 ? vec4(1.0 / (color.r - color.r)) : "
                "color * level; }");
  folder.effect("other", "vec4 apply(vec4 color) { return color * (strength + level); }");
  Look look = folder.look("other");
  look.entries.push_back({.effect = "broken", .settings = {{"strength", of(0.9)}, {"level", of(2)}}, .at = {}});
  const auto fails = [](const Situation& s) {
    harness().forget();
    const auto outcome = run_check(harness(), s);
    return outcome && outcome->applies && !outcome->holds;
  };
  const Situation start = situation(look, "finite", {"spike", {40, 30}, 2});
  ASSERT_TRUE(fails(start));
  const Shrunk small = shrink(start, fails);
  EXPECT_EQ(small.situation.look.line(), "fx.broken { strength = 0.9 }");
  EXPECT_EQ(small.situation.picture.color.size(), (Size{1, 1}));
}

}  // namespace
}  // namespace afterglow::stress
