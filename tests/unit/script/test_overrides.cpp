// SPDX-License-Identifier: MIT
// --set ENTRY.SETTING=VALUE.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene.h"

namespace afterglow::test {
namespace {

using testing::ElementsAre;

struct Overrides : testing::Test {
  Overrides() {
    scene.effect("glow", R"(
      settings = {
        mode = fx.enum { "soft", "hard", default = "soft" },
        levels = fx.int { min = 1, max = 9, default = 4 },
        gain = fx.float { min = -1, default = 1 },
        fade = fx.bool { default = false },
        tint = fx.color { default = { 1, 1, 1 } },
        shift = fx.vec2 { default = { 0, 0 } },
      },
      build = function(g, s, source) return source end,)");
    scene.stack("fx.glow { levels = 5 }, fx.glow { name = \"rim\", levels = 6 }");
  }
  void set(const std::string& text) {
    auto given = parse_override(text);
    ASSERT_TRUE(given) << given.error().text();
    scene.options.overrides.push_back(*given);
  }
  // Settings of the first entry as texts.
  std::vector<std::string> values(std::size_t index = 0) {
    auto preset = scene.load();
    if (!preset) return {preset.error().text()};
    std::vector<std::string> out;
    for (const auto& [name, value] : preset->entries()[index].settings) out.push_back(value.text());
    return out;
  }
  std::string error(const std::string& text) {
    scene.options.overrides.clear();
    auto given = parse_override(text);
    if (!given) return given.error().text();
    scene.options.overrides.push_back(*given);
    auto preset = scene.load();
    if (preset) return "";
    EXPECT_EQ(preset.error().kind, ErrorKind::usage);
    return preset.error().text();
  }
  Scene scene;
};

TEST_F(Overrides, EachType) {
  for (const char* text : {"glow.mode=hard", "glow.levels=7", "glow.gain=-0.5", "glow.fade=true", "glow.tint=1,0.5,2",
                           "glow.shift={1, -2}"})
    set(text);
  EXPECT_THAT(values(), ElementsAre("\"hard\"", "7", "-0.5", "true", "{1, 0.5, 2}", "{1, -2}"));
  EXPECT_THAT(values(1), ElementsAre("\"soft\"", "6", "1", "false", "{1, 1, 1}", "{0, 0}"));
}

TEST_F(Overrides, OtherSpellings) {
  for (const char* text : {"glow.mode=\"hard\"", "glow.levels=7.0", "glow.gain=1e2", "glow.tint=#ffffff"}) set(text);
  EXPECT_THAT(values(), ElementsAre("\"hard\"", "7", "100", "false", "{1, 1, 1}", "{0, 0}"));
}

TEST_F(Overrides, ChangedKeepsTheSchemasOrderAndTheLastWins) {
  for (const char* text : {"glow.gain=2", "glow.mode=hard", "glow.gain=3"}) set(text);
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  EXPECT_THAT(preset->entries()[0].changed, ElementsAre("mode", "levels", "gain"));
  EXPECT_EQ(preset->entries()[0].settings[2].second.number[0], 3);
}

TEST_F(Overrides, ByNameBeforeEffect) {
  set("rim.gain=2");
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  EXPECT_EQ(preset->entries()[0].settings[2].second.number[0], 1);
  EXPECT_EQ(preset->entries()[1].settings[2].second.number[0], 2);
}

TEST_F(Overrides, AnEffectsNameMeansAllItsEntriesWhenNoneIsCalledSo) {
  scene.stack("fx.glow { name = \"a\" }, fx.glow { name = \"b\" }");
  set("glow.gain=4");
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  for (const auto& entry : preset->entries()) EXPECT_EQ(entry.settings[2].second.number[0], 4);
}

TEST_F(Overrides, Placement) {
  for (const char* text : {"glow.enabled=false", "glow.order=7", "rim.at=after_opaque_and_sky"}) set(text);
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  EXPECT_EQ(preset->entries()[0].name, "rim");
  EXPECT_EQ(preset->entries()[0].at, "after_opaque_and_sky");
  EXPECT_EQ(preset->entries()[1].order, 7);
  EXPECT_FALSE(preset->entries()[1].enabled);
}

TEST_F(Overrides, Messages) {
  const std::string form = "; allowed: ENTRY.SETTING=VALUE";
  EXPECT_EQ(error("glow"), "error: --set 'glow' is no override" + form);
  EXPECT_EQ(error("glow.gain"), "error: --set 'glow.gain' is no override" + form);
  EXPECT_EQ(error("gain=1.5"), "error: --set 'gain=1.5' is no override" + form);
  EXPECT_EQ(error(".gain=1"), "error: --set '.gain=1' is no override" + form);
  EXPECT_EQ(error("glow.=1"), "error: --set 'glow.=1' is no override" + form);
  EXPECT_EQ(error("glw.gain=1"),
            "error: --set glw.gain: the stack has no entry 'glw'; allowed: glow, rim; did you mean 'glow'?");
  EXPECT_EQ(error("glow.gian=1"),
            "error: --set glow.gian: effect 'glow' has no such setting; allowed: mode, levels, gain, fade, tint, "
            "shift, at, blend, enabled, mask, opacity, "
            "order; did you mean 'gain'?");
  EXPECT_EQ(error("glow.levels=4.5"), "error: --set glow.levels = 4.5 is not an integer; allowed: integer 1…9");
  EXPECT_EQ(error("glow.levels=10"), "error: --set glow.levels = 10 is out of range; allowed: integer 1…9");
  EXPECT_EQ(error("glow.gain=much"), "error: --set glow.gain = \"much\" is not a number; allowed: ≥ -1");
  EXPECT_EQ(error("glow.gain="), "error: --set glow.gain = \"\" is not a number; allowed: ≥ -1");
  EXPECT_EQ(error("glow.gain=nan"), "error: --set glow.gain = nan is not finite; allowed: ≥ -1");
  EXPECT_EQ(error("glow.fade=1"), "error: --set glow.fade = 1 is not a boolean; allowed: true, false");
  EXPECT_EQ(error("glow.mode=sotf"),
            "error: --set glow.mode = \"sotf\" is not a choice; allowed: soft, hard; did you mean 'soft'?");
  EXPECT_EQ(error("glow.at=late"),
            "error: --set glow.at = \"late\" is not a choice; allowed: after_opaque_and_sky, before_post_process, "
            "post_process, "
            "after_post_process");
}

TEST_F(Overrides, ParseErrorsAreUsage) { EXPECT_EQ(parse_override("x").error().kind, ErrorKind::usage); }

}  // namespace
}  // namespace afterglow::test
