// SPDX-License-Identifier: MIT
// Curves and functions of t as settings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "scene.h"
#include "script/explanation.h"

namespace afterglow::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Animation : testing::Test {
  Animation() {
    scene.effect("glow", R"(
      settings = {
        mode = fx.enum { "soft", "hard", default = "soft" },
        levels = fx.int { min = 0, max = 9, default = 1 },
        gain = fx.float { min = 0, max = 4, default = 1 },
        tint = fx.color { default = { 1, 1, 1 } },
        shift = fx.vec2 { default = { 0, 0 } },
      },
      active = function(s) return s.gain > 0, "gain is 0" end,
      build = function(g, s, source)
        for i = 1, s.levels do
          source = g:pass { shader = "glow", source = source, gain = s.gain, tint = s.tint, hard = s.mode == "hard" }
        end
        return source
      end,)");
    scene.write("shaders/glow.glsl",
                "uniform float gain; uniform vec3 tint; layout(constant_id = 0) const bool hard = false;\n"
                "vec4 apply(vec4 color) { return color * (hard ? gain : gain * gain) * vec4(tint, 1.0); }\n");
  }
  void at(double frame) {
    scene.context.frame = frame;
    scene.context.time = frame / scene.context.fps;
  }
  // The setting's values at the frames.
  std::vector<std::string> values(const std::string& setting, const std::string& given,
                                  const std::vector<double>& frames) {
    scene.stack("fx.glow { " + setting + " = " + given + " }");
    auto preset = scene.load();
    if (!preset) return {preset.error().text()};
    std::vector<std::string> out;
    for (const double frame : frames) {
      at(frame);
      const auto build = scene.evaluate(*preset);
      if (!build) return {scene.shorten(build.error().text())};
      for (const auto& [name, value] : build->entries->at(0).settings)
        if (name == setting) out.push_back(value.text());
    }
    return out;
  }
  std::string error(const std::string& entry) {
    scene.stack(entry);
    return scene.load_error();
  }
  std::string build_error(const std::string& entry) {
    scene.stack(entry);
    return scene.build_error();
  }
  Scene scene;
};

TEST_F(Animation, LinearIsHeldAtBothEnds) {
  EXPECT_THAT(values("gain", "fx.curve { { 1, 0.5 }, { 5, 2.5 }, { 7, 0 } }", {-3, 1, 2, 3, 5, 6, 7, 90}),
              ElementsAre("0.5", "0.5", "1", "1.5", "2.5", "1.25", "0", "0"));
  EXPECT_THAT(values("gain", "fx.curve { { 4, 2 } }", {1, 4, 9}), ElementsAre("2", "2", "2"));
}

TEST_F(Animation, Eases) {
  // 3u² − 2u³ at u = 0, 1/4, 1/2, 3/4, 1
  EXPECT_THAT(values("gain", "fx.curve { { 0, 0 }, { 4, 2 }, ease = \"smooth\" }", {0, 1, 2, 3, 4}),
              ElementsAre("0", "0.3125", "1", "1.6875", "2"));
  EXPECT_THAT(values("gain", "fx.curve { { 0, 0 }, { 4, 2 }, ease = \"step\" }", {0, 3.9, 4}),
              ElementsAre("0", "0", "2"));
}

TEST_F(Animation, SecondsInsteadOfFrames) {
  EXPECT_THAT(values("gain", "fx.curve { { 0, 0 }, { 2, 4 }, unit = \"seconds\" }", {12, 24, 48}),
              ElementsAre("1", "2", "4"));
}

TEST_F(Animation, OtherTypes) {
  EXPECT_THAT(values("tint", "fx.curve { { 0, \"#000000\" }, { 2, { 1, 2, 4 } } }", {0, 1}),
              ElementsAre("{0, 0, 0}", "{0.5, 1, 2}"));
  EXPECT_THAT(values("shift", "fx.curve { { 0, { 0, 1 } }, { 2, { 1, -1 } } }", {1}), ElementsAre("{0.5, 0}"));
  EXPECT_THAT(values("levels", "fx.curve { { 0, 1 }, { 4, 5 } }", {0.4, 0.5, 1.4}), ElementsAre("1", "2", "2"));
}

TEST_F(Animation, FunctionsOfT) {
  EXPECT_THAT(values("gain", "function(t) return t.time * t.fps / t.frame end", {1, 7}), ElementsAre("1", "1"));
  EXPECT_THAT(values("mode", "function(t) return t.frame < 10 and \"soft\" or \"hard\" end", {9, 10}),
              ElementsAre("\"soft\"", "\"hard\""));
  EXPECT_THAT(values("tint", "function(t) return { t.frame, 0, 0 } end", {3}), ElementsAre("{3, 0, 0}"));
}

TEST_F(Animation, OnlyParameterBytesChange) {
  scene.stack("fx.glow { gain = fx.curve { { 1, 0.5 }, { 5, 2.5 } }, levels = 2 }");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  EXPECT_TRUE(preset->may_change());
  const Graph first = *scene.build(*preset);
  at(3);
  const Graph third = *scene.build(*preset);
  EXPECT_TRUE(same_structure(first, third));
  EXPECT_EQ(third.passes[1].params.at("gain").v[0], 1.5);
  EXPECT_NE(first.passes[1].params.at("gain").v[0], 1.5);
}

TEST_F(Animation, StructureAndActivityFollow) {
  scene.stack(
      "fx.glow { levels = fx.curve { { 1, 1 }, { 5, 5 } }, gain = function(t) return t.frame == 9 and 0 or 1 end }");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  for (const int frame : {4, 2, 9, 4}) {
    at(frame);
    EXPECT_EQ(scene.build(*preset)->passes.size(), frame == 9 ? 0u : static_cast<std::size_t>(frame));
  }
}

TEST_F(Animation, TheSameFrameIsTheSameWhateverWasPlayedBefore) {
  scene.stack(R"(fx.glow {
      gain = fx.curve { { 1, 0.1 }, { 24, 0.9 }, ease = "smooth" }, levels = fx.curve { { 1, 1 }, { 40, 6 } },
      mode = function(t) return t.frame % 3 == 0 and "hard" or "soft" end,
      tint = function(t) return { 1 + math.sin(t.time), 1, 1 } end },
    fx.volume { shape = { "sphere", radius = 2 }, blend_distance = 9, weight = fx.curve { { 1, 0 }, { 20, 1 } },
                settings = { glow = { gain = fx.curve { { 1, 4 }, { 40, 0.5 } } } } },
    position = fx.curve { { 1, { -12, 0, 0 } }, { 40, { 12, 0, 0 } } },)");
  auto straight = scene.load();
  ASSERT_TRUE(straight) << straight.error().text();
  std::vector<std::string> expected(41);
  for (int frame = 1; frame <= 40; ++frame) {
    at(frame);
    expected[static_cast<std::size_t>(frame)] = to_json(*scene.build(*straight));
  }
  std::mt19937 random(7);
  for (int round = 0; round < 5; ++round) {
    auto seeking = scene.load();
    for (int step = 0; step < 60; ++step) {
      const int frame = 1 + static_cast<int>(random() % 40);
      at(frame);
      EXPECT_EQ(to_json(*scene.build(*seeking)), expected[static_cast<std::size_t>(frame)]) << "frame " << frame;
    }
  }
  std::sort(expected.begin(), expected.end());
  EXPECT_GT(std::unique(expected.begin(), expected.end()) - expected.begin(), 30);
}

TEST_F(Animation, AFunctionThatRemembersIsRefused) {
  scene.preset(R"(local fx = require "afterglow"
local n = 0
return fx.stack { fx.glow {
  gain = function(t)
    n = n + 0.25
    return n
  end } })");
  EXPECT_EQ(scene.build_error(),
            "preset.lua:4: error: glow.gain is 0.75 and then 1 at the same frame; its function must depend on t alone");
}

TEST_F(Animation, OverridesEndTheMotion) {
  scene.options.overrides.push_back(*parse_override("glow.gain=2"));
  EXPECT_THAT(values("gain", "fx.curve { { 1, 0.5 }, { 5, 2.5 } }", {1, 3, 5}), ElementsAre("2", "2", "2"));
}

TEST_F(Animation, MessagesOfCurves) {
  const std::string form = "; allowed: { FRAME, VALUE }, with unit = \"seconds\" { TIME, VALUE }";
  EXPECT_EQ(error("fx.glow { gain = fx.curve {\n { 0, 1 },\n { 1 } } }"),
            "preset.lua:5: error: fx.curve: key 2 is {1}" + form);
  EXPECT_EQ(error("fx.glow { gain = fx.curve { 3 } }"), "preset.lua:3: error: fx.curve: key 1 is 3" + form);
  EXPECT_EQ(error("fx.glow { gain = fx.curve { { 2, 1 },\n { 2, 1 } } }"),
            "preset.lua:4: error: fx.curve: key 2 is at 2, not after the one before it at 2");
  EXPECT_EQ(error("fx.glow { gain = fx.curve { } }"),
            "preset.lua:3: error: fx.curve has no keys; allowed: { FRAME, VALUE }, …");
  EXPECT_EQ(
      error("fx.glow { gain = fx.curve { { 2, 1 },\n ease = \"smoth\" } }"),
      "preset.lua:4: error: fx.curve: unknown ease 'smoth'; allowed: linear, smooth, step; did you mean 'smooth'?");
  EXPECT_EQ(error("fx.glow { gain = fx.curve { { 2, 1 },\n eas = \"smooth\" } }"),
            "preset.lua:4: error: fx.curve has no 'eas'; allowed: ease, unit; did you mean 'ease'?");
  EXPECT_EQ(error("fx.glow {\n gain = fx.curve { { 2, 1 }, { 3, 5 } } }"),
            "preset.lua:4: error: glow.gain: key 2 of the curve = 5 is out of range; allowed: 0…4");
  EXPECT_EQ(
      error("fx.glow {\n mode = fx.curve { { 2, \"soft\" } } }"),
      "preset.lua:4: error: glow.mode cannot be a curve: it has nothing between its values; allowed: soft, hard, a "
      "function of t");
}

TEST_F(Animation, MessagesOfFunctions) {
  EXPECT_EQ(build_error("fx.glow { gain =\n function(t) return t.frame * 5 end }"),
            "preset.lua:4: error: glow.gain at frame 1 = 5 is out of range; allowed: 0…4");
  EXPECT_EQ(build_error("fx.glow { gain = function(t)\n return t.frmae end }"),
            "preset.lua:4: error: t has no \"frmae\"; allowed: fps, frame, time; did you mean 'frame'?");
  EXPECT_EQ(build_error("fx.glow { gain = function(t)\n t.frame = 3 return 1 end }"),
            "preset.lua:4: error: this table is read-only");
  EXPECT_THAT(build_error("fx.glow { gain = function(t) while true do end end }"),
              HasSubstr("instruction budget spent"));
  // What goes wrong at a later frame only.
  EXPECT_THAT(values("gain", "function(t) return t.frame > 5 and -1 or 1 end", {1, 6}),
              ElementsAre("preset.lua:3: error: glow.gain at frame 6 = -1 is out of range; allowed: 0…4"));
}

// What was said of a frame stays said, whatever is asked about others.
TEST_F(Animation, WhatWasSaidOfAFrameStays) {
  scene.stack("fx.glow { gain = function(t) return t.frame end }");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  at(3);
  const auto third = scene.evaluate(*preset);
  ASSERT_TRUE(third);
  const std::string graph = to_json(third->graph);
  const auto gain_of = [](const Build& build) { return build.entries->at(0).settings.at(2).second.text(); };
  at(4);
  const auto fourth = scene.evaluate(*preset);
  ASSERT_TRUE(fourth);
  EXPECT_EQ(gain_of(*third), "3");
  EXPECT_EQ(gain_of(*fourth), "4");
  EXPECT_EQ(third->explanation->entries.at(0).settings.at(2).value.text(), "3");
  EXPECT_EQ(fourth->explanation->entries.at(0).settings.at(2).value.text(), "4");
  EXPECT_EQ(third->context.frame, 3);
  EXPECT_EQ(to_json(third->graph), graph);
  EXPECT_EQ(preset->evaluations(), 2u);
  EXPECT_EQ(third->files, fourth->files) << "nothing else was looked at";
  EXPECT_FALSE(third->files->empty());
}

TEST_F(Animation, AFunctionNeedsValuesForTheFramesThatAreRunAlone) {
  const std::string baked = "function(t) return ({ [1001] = 0.25, [1002] = 0.5 })[t.frame] end";
  EXPECT_THAT(values("gain", baked, {1001, 1002}), ElementsAre("0.25", "0.5"));
  EXPECT_THAT(values("gain", baked, {1001, 7}),
              ElementsAre("preset.lua:3: error: glow.gain at frame 7 = nil is not a number; allowed: 0…4"));
  EXPECT_THAT(values("gain", "function(t) return t.nothing.there end", {3}),
              ElementsAre(HasSubstr("preset.lua:3: error: ")));
  EXPECT_THAT(error("fx.glow { gain = function(t) while true do end end }"), HasSubstr("instruction budget spent"));
}

}  // namespace
}  // namespace afterglow::test
