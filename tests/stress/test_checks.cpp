// SPDX-License-Identifier: MIT
// Each check catches an effect that breaks just that, and lets a good one pass.
#include <algorithm>

#include "bad_effects.h"
#include "script/schema.h"

namespace afterglow::stress {
namespace {

struct BadEffect {
  const char* check;  ///< that must fail
  const char* glsl;
  const char* holds = "";  ///< what it promises falsely
  const char* pass = "";   ///< further keys of g:pass
  const char* picture = "render";
  Size size{33, 18};
};

const BadEffect kBad[] = {
    {"finite", "vec4 apply(vec4 color) { return vec4(color.rgb / max(color.r - 0.5, 0.0), color.a); }"},
    {"finite_fused", "vec4 apply(vec4 color) { return vec4(sqrt(0.5 - color.rgb), color.a); }"},
    {"alpha", "vec4 apply(vec4 color) { return color * 0.5; }"},
    {"region",
     "uniform sampler2D source;\nvec4 sample_at(ivec2 p) { return fetch(source, p + ivec2(9, 5)); }",
     "",
     "reach = 1",
     "render",
     {64, 64}},
    // What is beyond the reach is read of the picture itself, which has all of its pixels.
    {"region",
     "uniform sampler2D source;\nvec4 sample_at(ivec2 p) { return vec4(fetch(source, p + ivec2(20, 0)).rgb, "
     "fetch(source, p).a); }",
     "",
     "reach = 0",
     "render",
     {64, 64}},
    {"idle", "vec4 apply(vec4 color) { return vec4(color.rgb * 0.5, color.a); }"},
    {"rebuilt", "vec4 apply(vec4 color) { return vec4(color.rgb * strength, color.a); }", "",
     "strength = (function() made = (rawget(_ENV, 'made') or 0) + 1 return 1 / made end)()"},
    {"black", "vec4 apply(vec4 color) { return vec4(color.rgb + 1e-6, color.a); }", "\"black\""},
    {"constant", "vec4 apply(vec4 color, ivec2 p) { return vec4(color.rgb * (1.0 + 0.001 * float(p.x)), color.a); }",
     "\"constant\""},
    {"mean", "vec4 apply(vec4 color) { return vec4(color.rgb * 0.999, color.a); }", "mean = 1e-4"},
    {"no_added_light", "vec4 apply(vec4 color) { return vec4(color.rgb * 1.001, color.a); }", "no_added_light = 1e-4"},
    {"monotone", "vec4 apply(vec4 color) { return vec4(1.0 / (1.0 + color.rgb), color.a); }", "\"monotone\""},
    {"bounded", "vec4 apply(vec4 color) { return vec4(color.rgb * 1.01, color.a); }", "\"bounded\""},
    {"bounded", "vec4 apply(vec4 color) { return color; }", "bounded = { from = 0, to = 1 }"},
    {"continuous", "vec4 apply(vec4 color) { return vec4(color.rgb + 0.01 * step(1.37, color.rgb), color.a); }",
     "continuous = 1.01"},
    {"linear", "vec4 apply(vec4 color) { return vec4(color.rgb * (1.0 + 1e-3 * color.rgb), color.a); }", "\"linear\""},
    {"proportional", "vec4 apply(vec4 color) { return vec4(color.rgb * (1.0 + strength * strength), color.a); }",
     "proportional = { setting = \"strength\", up_to = 1 }"},
    {"mirror", "vec4 apply(vec4 color, ivec2 p) { return vec4(color.rgb * (1.0 + 0.001 * float(p.y)), color.a); }",
     "\"mirror\""},
    {"turn_180", "vec4 apply(vec4 color, ivec2 p) { return vec4(color.rgb * (1.0 + 0.001 * float(p.x)), color.a); }",
     "\"turn_180\""},
    {"turn_90",
     "uniform sampler2D source;\nvec4 sample_at(ivec2 p) { return 0.5 * (fetch(source, p + ivec2(1, 0)) + "
     "fetch(source, p - ivec2(1, 0))); }",
     "\"turn_90\""},
    {"shift", "vec4 apply(vec4 color, ivec2 p) { return p.x % 2 == 0 ? color : vec4(color.rgb * 0.5, color.a); }",
     "shift = 1"},
};

void PrintTo(const BadEffect& bad, std::ostream* out) { *out << bad.check << ": " << bad.glsl; }

class BadEffects : public testing::TestWithParam<BadEffect> {};

/// Some seed brings it out: a check may choose where it looks.
Outcome worst_of(const Look& look, const BadEffect& bad) {
  Outcome last;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    last = outcome_of(situation(look, bad.check, {bad.picture, bad.size, seed}, seed));
    EXPECT_TRUE(last.applies) << bad.check;
    if (!last.holds) break;
  }
  return last;
}

TEST_P(BadEffects, AreCaught) {
  const BadEffect& bad = GetParam();
  const EffectFolder folder;
  std::string holds = std::string("holds = { ") + bad.holds + " },";
  if (std::string(bad.check) == "idle") holds = "idle = function() return { brightest = 50 } end,";
  folder.effect("broken", bad.glsl, holds, bad.pass);
  const Outcome outcome = worst_of(folder.look("broken"), bad);
  EXPECT_FALSE(outcome.holds);
  EXPECT_GT(outcome.measured, outcome.allowed);
  EXPECT_FALSE(outcome.what.empty());
}

INSTANTIATE_TEST_SUITE_P(, BadEffects, testing::ValuesIn(kBad));

constexpr const char* kEverything =
    "holds = { \"black\", \"constant\", \"monotone\", \"bounded\", \"linear\", \"mirror\", \"turn_180\", \"turn_90\", "
    "mean = 1e-6, "
    "no_added_light = 1e-6, continuous = 1, shift = 1, proportional = { setting = \"strength\", up_to = 1 } },";

TEST(StressChecks, AGoodEffectPassesAll) {
  const EffectFolder folder;
  folder.effect("honest", "vec4 apply(vec4 color) { return color * (0.999999 + 1e-6 * min(strength + level, 1.0)); }",
                kEverything);
  const Look look = folder.look("honest");
  for (const auto& kind : picture_kinds())
    for (const Check& check : checks()) {
      const std::string name = check.name;
      if (!kind.gentle || name.starts_with("error") || name == "finite_frames") continue;
      const Outcome outcome = outcome_of(situation(look, check.name, {kind.name, {24, 24}, 3}));
      EXPECT_TRUE(outcome.applies) << check.name;
      EXPECT_TRUE(outcome.holds) << check.name << " on " << kind.name << ": " << outcome.what;
    }
  EXPECT_EQ(validation_errors(), 0);
}

TEST(StressChecks, APassOfTwoWaysThatDifferIsCaughtWhereItIsTheLast) {
  const EffectFolder folder;
  const std::string uniforms = "uniform sampler2D source;\n";
  folder.effect("two", uniforms + "vec4 sample_at(ivec2 p) { return fetch(source, p); }", "",
                "compute = \"two/group\"");
  folder.write("shaders/two/group.glsl",
               "layout(local_size_x = 16, local_size_y = 8) in;\nuniform float strength;\nuniform float level;\n" +
                   uniforms +
                   "vec4 compute_at(ivec2 p) { vec4 c = fetch(source, p); return vec4(c.rgb * 1.001, c.a); }\n");
  bool caught = false;
  for (std::uint64_t seed = 1; seed <= 40 && !caught; ++seed)
    caught = !outcome_of(situation(folder.look("two"), "same_ways", {"render", {33, 18}, seed}, seed)).holds;
  EXPECT_TRUE(caught);
}

TEST(StressChecks, WhatAFrameHandsOnIsLookedAt) {
  const EffectFolder folder;
  folder.write("effects/after.lua", R"(local fx = require "afterglow"
return fx.effect { name = "after", doc = "Made for a test.", settings = {},
  build = function(g, s, source)
    local before = g:history { name = "before", size = source, pre_roll = 1 }
    local now = g:pass { shader = "after/after", source = source, before = before }
    g:keep(before, now)
    return now
  end })");
  const auto outcome = [&](const std::string& shader) {
    folder.write("shaders/after/after.glsl", "vec4 apply(vec4 c, vec4 before) { return vec4(" + shader + ", c.a); }\n");
    harness().forget();
    return outcome_of(situation(folder.look("after"), "finite_frames", {"render", {33, 18}, 3}));
  };
  EXPECT_TRUE(outcome("0.5 * (c.rgb + before.rgb)").holds);
  const Outcome bad = outcome("c.rgb / (1.0 - before.a)");
  EXPECT_FALSE(bad.holds);
  EXPECT_NE(bad.what.find("frame 2 of a sequence"), std::string::npos) << bad.what;
  folder.effect("plain", "vec4 apply(vec4 c) { return c; }");
  EXPECT_FALSE(outcome_of(situation(folder.look("plain"), "finite_frames", {"render", {8, 8}, 1})).applies);
}

TEST(StressChecks, EveryPromiseHasACheckAndEveryCheckABreaker) {
  for (const auto& kind : invariant_kinds())
    EXPECT_TRUE(std::ranges::any_of(checks(), [&](const Check& c) { return c.promise && kind.name == c.promise; }))
        << kind.name;
  for (const Check& check : checks()) {
    // What no effect can break, and what has a test of its own.
    const std::string name = check.name;
    if (name == "repeated" || name == "same_ways" || name == "finite_frames" || name.starts_with("error")) continue;
    EXPECT_TRUE(std::ranges::any_of(kBad, [&](const BadEffect& bad) { return name == bad.check; })) << name;
  }
}

TEST(StressChecks, ImagesAreComparedToTheBitOrByTheMeasure) {
  Image a(3, 2, 4), b = a;
  EXPECT_TRUE(compare(a, b, 0, "x").holds);
  b.pixels[7] = 1e-9f;  // alpha counts, to the bit
  const Outcome bits = compare(b, a, 0, "x");
  EXPECT_FALSE(bits.holds);
  EXPECT_THAT(bits.what, testing::HasSubstr("1 of 24 samples differ, first pixel 1 0 alpha"));
  EXPECT_TRUE(compare(b, a, 1e-6, "x").holds);
  b.pixels[4] = 1e-4f;
  EXPECT_FALSE(compare(b, a, 1e-6, "x").holds);
  b.pixels[4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(compare(b, a, 1, "x").holds);
  EXPECT_FALSE(compare(Image(2, 3, 4), a, 1, "x").holds);
}

// A small channel beside large ones is a difference of these.
TEST(StressChecks, WaysAreComparedByTheLargestChannelOfAPixel) {
  Image a(2, 1, 4), b = a;
  a.pixels = {6.f, 0.01f, 2.f, 1.f, 0.01f, 0.01f, 0.01f, 1.f};
  b = a;
  b.pixels[1] += 1e-6f;
  EXPECT_FALSE(compare(b, a, 1e-6, "x").holds);
  EXPECT_TRUE(compare(b, a, 1e-6, "x", MeasuredBy::pixel).holds);
  b = a;
  b.pixels[5] += 1e-6f;
  EXPECT_FALSE(compare(b, a, 1e-6, "x", MeasuredBy::pixel).holds);
  b = a;
  b.pixels[0] += 1e-4f;
  EXPECT_FALSE(compare(b, a, 1e-6, "x", MeasuredBy::pixel).holds);
}

/// An effect of the name of one with an oracle, with its settings, but another result.
TEST(StressChecks, AFalseBoundOfTheErrorIsCaught) {
  const EffectFolder folder;
  folder.write("effects/color_blit.lua", R"(local fx = require "afterglow"
return fx.effect { name = "color_blit", settings = { intensity = fx.float { min = 0, max = 2, default = 1 } }, holds = { error = 1e-5 },
  build = function(g, s, source) return g:pass { shader = "wrong", source = source, intensity = s.intensity } end }
)");
  folder.write("shaders/wrong.glsl",
               "uniform float intensity;\nvec4 apply(vec4 color) { return vec4(0.0, color.g * intensity * 1.0001, 0.0, "
               "color.a); }\n");
  const Outcome wrong = outcome_of(situation(folder.look("color_blit"), "error_fp32", {"render", {16, 16}, 1}));
  EXPECT_TRUE(wrong.applies);
  EXPECT_FALSE(wrong.holds);
  folder.write(
      "shaders/wrong.glsl",
      "uniform float intensity;\nvec4 apply(vec4 color) { return vec4(0.0, color.g * intensity, 0.0, color.a); }\n");
  const Outcome right = outcome_of(situation(folder.look("color_blit"), "error_fp32", {"render", {16, 16}, 1}));
  EXPECT_TRUE(right.applies && right.holds) << right.what;
}

/// The same for an effect that is faded, blended and masked: 1e-3 in its result is seen behind all of that.
TEST(StressChecks, AFalseResultIsSeenThroughAMask) {
  const EffectFolder folder;
  folder.write("effects/color_blit.lua", R"(local fx = require "afterglow"
return fx.effect { name = "color_blit", settings = { intensity = fx.float { min = 0, max = 2, default = 1 } }, holds = { error = 1e-5 },
  build = function(g, s, source) return g:pass { shader = "wrong", source = source, intensity = s.intensity } end }
)");
  const auto outcome = [&](const char* factor, bool composed) {
    folder.write(
        "shaders/wrong.glsl",
        std::string("uniform float intensity;\nvec4 apply(vec4 color) { return vec4(0.0, color.g * intensity * ") +
            factor + ", 0.0, color.a); }\n");
    Look look = folder.look("color_blit");
    if (composed)
      look.entries.front().composition = {{"opacity", "0.75"},
                                          {"blend", "\"lighten\""},
                                          {"mask", "fx.mask.layer { layer = \"matte\", channel = \"r\" }"}};
    harness().forget();
    return outcome_of(situation(look, "error_composed", {"display", {16, 16}, 1}));
  };
  EXPECT_FALSE(outcome("1.0", false).applies) << "nothing is composed";
  const Outcome right = outcome("1.0", true), wrong = outcome("1.1", true);
  EXPECT_TRUE(right.applies && right.holds) << right.what;
  EXPECT_TRUE(wrong.applies);
  EXPECT_FALSE(wrong.holds);
}

/// Of a pyramid of few levels, where pictures are large enough for light to stay away from the edges: what its promises
/// with margins and conditions say does apply, and holds.
TEST(StressChecks, AScatteringPyramidKeepsItsPromises) {
  const auto number = [](SettingType type, double v) {
    return SettingValue{.type = type, .number = {v, 0, 0}, .choice = {}};
  };
  for (const int levels : {1, 2})
    for (const double threshold : {0.0, 0.5}) {
      Look look{{{.effect = "bloom", .settings = {}, .at = {}}}, {}};
      auto& entry = look.entries.front();
      entry.set("mode", {.type = SettingType::enumeration, .number = {}, .choice = "scattering"});
      entry.set("max_iterations", number(SettingType::integer, levels));
      entry.set("threshold", number(SettingType::number, threshold));
      entry.set("intensity", number(SettingType::number, 0.9));
      const int side = 128 * levels;
      for (const char* check : {"mean", "no_added_light", "turn_90", "shift", "bounded", "monotone"})
        for (const char* kind : {"render", "fireflies", "checkerboard", "diagonals"}) {
          const Outcome outcome = outcome_of(situation(look, check, {kind, {side, side}, 11}, 3));
          if (std::string(check) == "mean" && threshold > 0) {
            EXPECT_FALSE(outcome.applies);
            continue;
          }
          EXPECT_TRUE(outcome.applies) << check << " " << levels;
          EXPECT_TRUE(outcome.holds) << check << " " << levels << " " << threshold << " " << kind << ": "
                                     << outcome.what;
        }
    }
}

TEST(StressChecks, PromisesOfOtherSettingsDoNotApply) {
  const EffectFolder folder;
  folder.effect("sometimes", "vec4 apply(vec4 color) { return vec4(color.rgb + level * 0.0 + strength, color.a); }",
                "holds = { black = { when = function(s) return s.strength == 0 end } },");
  Look look = folder.look("sometimes");
  EXPECT_FALSE(outcome_of(situation(look, "black", {"render", {8, 8}, 1})).applies);
  look.entries.front().set("strength", {.type = SettingType::number, .number = {0, 0, 0}});
  const Outcome outcome = outcome_of(situation(look, "black", {"render", {8, 8}, 1}));
  EXPECT_TRUE(outcome.applies && outcome.holds);
}

}  // namespace
}  // namespace afterglow::stress
