// SPDX-License-Identifier: MIT
// How entries are put together: opacity, blend, masks, groups, mixes, arguments; and what is said where it is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "scene.h"

namespace afterglow::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Composition : testing::Test {
  Composition() {
    for (const std::string name : {"a", "b", "c"})
      scene.effect(name, "order = " + std::string(name == "c" ? "5" : "10") + R"(,
        settings = { strength = fx.float { min = 0, max = 10, default = 1 } },
        build = function(g, s, source) return g:pass { shader = "pixel", source = source } end,)");
    scene.write("shaders/pixel.glsl", "vec4 apply(vec4 color) { return color * 0.5; }\n");
  }
  std::string error(const std::string& entries) {
    scene.stack(entries);
    return scene.build_error();
  }
  std::vector<std::string> order(const std::string& entries) {
    scene.stack(entries);
    auto preset = scene.load();
    if (!preset) return {preset.error().text()};
    std::vector<std::string> out;
    for (const auto& entry : preset->entries()) out.push_back(std::string(entry.depth, '>') + entry.name);
    return out;
  }
  std::vector<std::string> passes(const std::string& entries) {
    scene.stack(entries);
    std::vector<std::string> out;
    const Graph graph = scene.graph();
    for (const auto& pass : graph.passes) out.push_back(pass.name);
    return out;
  }
  Scene scene;
};

TEST_F(Composition, ListsInListsAndFalseAreItems) {
  EXPECT_THAT(order("{ fx.a {}, { fx.b {} } }, false, 1 > 2 and fx.c {}"), ElementsAre("a", "b"));
  EXPECT_THAT(error("{ fx.a {}, name = 3 }"), HasSubstr("a list in it has a name, 'name'"));
  EXPECT_THAT(error("true"), HasSubstr("position 1 is true, not an effect or a volume"));
  EXPECT_THAT(error("{ 3 }"), HasSubstr("position 1 is 3, not an effect"));
}

TEST_F(Composition, AGroupStandsTogetherWhereItsFirstEffectWould) {
  EXPECT_THAT(order("fx.b {}, fx.group { fx.a {}, fx.c {} }"), ElementsAre("group", ">c", ">a", "b"));
  EXPECT_THAT(order("fx.b {}, fx.group { order = 11, fx.a {}, fx.c {} }"), ElementsAre("b", "group", ">c", ">a"));
  EXPECT_THAT(order("fx.group { fx.group { fx.a {} }, fx.c {} }, fx.group { }"),
              ElementsAre("group#3", "group", ">c", ">group#2", ">>a"));
  scene.options.overrides = {{"group", "order", "20"}};
  EXPECT_THAT(order("fx.b {}, fx.group { fx.c {} }"), ElementsAre("b", "group", ">c"));
}

TEST_F(Composition, WhatALookInAGroupSaysOfPicturesIsWarnedAbout) {
  EXPECT_THAT(order("fx.group { fx.stack { reference_height = 540, input_space = \"logc3\", gamut = \"keep\", alpha = "
                    "\"associated\", fx.a {} } }"),
              ElementsAre("group", ">a"));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("fx.group: the 'input_space' of the look in it does not count"),
                                          HasSubstr("'gamut'"), HasSubstr("'alpha'"), HasSubstr("'reference_height'")));
  scene.warnings.clear();
  EXPECT_THAT(order("fx.group { fx.stack { name = \"x\", fx.a {} } }"), ElementsAre("group", ">a"));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Composition, PassesOfMasksAndBlendsFollowThoseOfTheEffect) {
  EXPECT_THAT(passes("fx.a { }"), ElementsAre("a.pixel"));
  EXPECT_THAT(passes("fx.a { opacity = 0.5 }"), ElementsAre("a.pixel", "a.blend"));
  EXPECT_THAT(passes("fx.a { blend = \"screen\" }"), ElementsAre("a.pixel", "a.blend"));
  EXPECT_THAT(passes("fx.a { mask = fx.mask.luma { } * 0.5 }"),
              ElementsAre("a.pixel", "a.mask.luma", "a.mask.scale", "a.blend"));
  EXPECT_THAT(passes("fx.group { opacity = 0.5, fx.a {}, fx.b {} }"), ElementsAre("a.pixel", "b.pixel", "group.blend"));
  EXPECT_THAT(passes("fx.mix { fx.a {}, fx.b {}, amount = 0.25 }"), ElementsAre("a.pixel", "b.pixel", "mix.mix"));
}

TEST_F(Composition, OpacityMovesAndIsSet) {
  scene.stack("fx.a { opacity = fx.curve { { 0, 0 }, { 10, 1 } } }");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  EXPECT_TRUE(preset->may_change());
  scene.context.frame = 5;
  const auto halfway = preset->evaluate(scene.context, scene.diagnostics);
  ASSERT_TRUE(halfway);
  EXPECT_DOUBLE_EQ((*halfway->entries)[0].opacity, 0.5);
  scene.context.frame = 0;
  const auto graph = scene.build(*preset);
  ASSERT_TRUE(graph);
  ASSERT_EQ(graph->skipped.size(), 1u);
  EXPECT_EQ(graph->skipped[0].reason, "opacity is 0");
  scene.options.overrides = {{"a", "opacity", "0.25"}, {"a", "blend", "add"}};
  EXPECT_THAT(passes("fx.a { }"), ElementsAre("a.pixel", "a.blend"));
}

TEST_F(Composition, PartsOfMasksAreSet) {
  const std::string shared = R"(local fx = require "afterglow"
local m = fx.mask.luma { from = 1 } + fx.mask.luma { from = 2 } * fx.mask.radial { }
return fx.stack { fx.a { mask = m }, fx.b { mask = m } })";
  scene.options.overrides = {{"a", "mask.luma#2.from", "3"}, {"a", "mask.radial.radius", "{0.25, 0.5}"}};
  scene.preset(shared);
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  const auto text = [&](std::size_t entry, const char* setting) {
    const SettingHistory* history = preset->explanation().entries[entry].find(setting);
    return history ? history->value.text() : "none";
  };
  EXPECT_EQ(text(0, "mask.luma.from"), "1");
  EXPECT_EQ(text(0, "mask.luma#2.from"), "3");
  EXPECT_EQ(text(0, "mask.radial.radius"), "{0.25, 0.5}");
  EXPECT_EQ(text(1, "mask.luma#2.from"), "2") << "the other entry of the same mask";
  const auto parts = preset->entries()[0].mask->parts();
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[1]->part, "mask.luma#2");
  EXPECT_EQ(parts[1]->settings[0].second.text(), "3") << "what the oracle sees";
  EXPECT_EQ(parts[1]->line, 2);
  EXPECT_EQ(preset->setting_schema(preset->entries()[0], "mask.luma#2.from")->max, 1e6);
  EXPECT_FALSE(preset->setting_schema(preset->entries()[0], "mask.luma#3.from"));

  scene.options.overrides = {{"a", "mask.lumma.from", "3"}};
  EXPECT_THAT(scene.load_error(),
              HasSubstr("--set a.mask.lumma.from: the entry has no mask 'lumma'; allowed: strength, "
                        "at, blend, enabled, mask, opacity, order, mask.luma.from, mask.luma.to"));
  EXPECT_THAT(scene.load_error(), HasSubstr("did you mean 'mask.luma.from'?"));
  scene.options.overrides = {{"a", "mask.luma.from", "-1"}};
  EXPECT_THAT(scene.load_error(), HasSubstr("--set a.mask.luma.from = -1 is out of range; allowed: 0…1000000"));
}

TEST_F(Composition, AMaskIsSetToANumber) {
  scene.options.overrides = {{"a", "mask", "0.25"}};
  scene.stack("fx.a { mask = fx.mask.luma { } }");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  EXPECT_EQ(preset->entries()[0].mask->text(), "0.25");
  EXPECT_EQ(preset->explanation().entries[0].preset_mask, "luma");
  EXPECT_THAT(passes("fx.a { mask = fx.mask.luma { } }"), ElementsAre("a.pixel", "a.blend"));
  scene.options.overrides = {{"a", "mask", "luma"}};
  EXPECT_THAT(scene.load_error(), HasSubstr("--set a.mask = \"luma\" is not a number; allowed: 0…1"));
  scene.options.overrides = {{"a", "blend", "sceen"}};
  EXPECT_THAT(scene.load_error(), HasSubstr("did you mean 'screen'?"));
}

TEST_F(Composition, HowItCameAboutIsKept) {
  scene.options.overrides = {{"a", "opacity", "0.25"}};
  scene.stack("fx.a { opacity = fx.curve { { 0, 0 }, { 10, 1 } }, blend = function(t) return \"add\" end }, fx.b { }");
  scene.context.frame = 5;
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  const auto build = scene.evaluate(*preset);
  ASSERT_TRUE(build) << build.error().text();
  const EntryHistory& a = build->explanation->entries[0];
  const SettingHistory *opacity = a.find("opacity"), *blend = a.find("blend");
  ASSERT_TRUE(opacity && blend);
  EXPECT_EQ(opacity->kind, "curve");
  EXPECT_EQ(opacity->preset->number[0], 0.5);
  EXPECT_EQ(opacity->overridden->number[0], 0.25);
  EXPECT_EQ(opacity->value.number[0], 0.25);
  EXPECT_EQ(blend->kind, "function");
  EXPECT_EQ((*build->entries)[0].blend, "add");
  EXPECT_THAT((*build->entries)[0].changed, ElementsAre("opacity", "blend"));
  EXPECT_FALSE(build->explanation->entries[1].find("opacity")->preset);
  EXPECT_THAT(error("fx.a { blend = fx.curve { { 0, \"add\" }, { 1, \"screen\" } } }"), HasSubstr("a.blend"));
}

TEST_F(Composition, MasksOfMasksEnd) {
  const auto doubled = [&](int times) {
    scene.preset("local fx = require \"afterglow\"\nlocal m = fx.mask.luma { }\nfor i = 1, " + std::to_string(times) +
                 " do m = m + m end\nreturn fx.stack { fx.a { mask = m } }");
    return scene.load_error();
  };
  EXPECT_EQ(doubled(8), "");
  EXPECT_THAT(doubled(60), HasSubstr("preset.lua:3: error: a mask is made of more than 256 masks and numbers"));
}

TEST_F(Composition, ArgumentsThatDoNotFitAreLeftOutWhereThatIsAllowed) {
  scene.options.arguments = {{"strength", "3"}, {"gone", "1"}};
  scene.options.leave_out_unfit = true;
  scene.preset(R"(local fx = require "afterglow"
local args = fx.args { strength = fx.float { min = 0, max = 2, default = 0.5 } }
return fx.stack { fx.a { strength = args.strength } })");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  EXPECT_EQ(preset->entries()[0].settings[0].second.text(), "0.5");
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("--arg strength = 3 is out of range; it is left out"),
                                          HasSubstr("--arg gone: the preset declares no argument of this name; it is "
                                                    "left out")));
}

TEST_F(Composition, WhatIsWrongIsSaid) {
  EXPECT_THAT(
      error("fx.a { blend = \"sceen\" }"),
      HasSubstr("a.blend = \"sceen\" is not a choice; allowed: normal, add, screen, multiply, overlay, soft_light, "
                "lighten, darken, hard_light, color, luminosity; did you mean 'screen'?"));
  EXPECT_THAT(error("fx.a { opacity = 2 }"), HasSubstr("a.opacity = 2 is out of range; allowed: 0…1"));
  EXPECT_THAT(error("fx.a { mask = \"luma\" }"), HasSubstr("mask = \"luma\" is not a mask; allowed: fx.mask.NAME"));
  EXPECT_THAT(error("fx.a { mask = fx.mask.lumma { } }"), HasSubstr("unknown mask 'lumma'"));
  EXPECT_THAT(error("fx.a { mask = fx.mask.lumma { } }"), HasSubstr("did you mean 'luma'?"));
  EXPECT_THAT(error("fx.a { mask = fx.mask.luma { form = 1 } }"), HasSubstr("did you mean 'from'?"));
  EXPECT_THAT(error("fx.a { mask = fx.mask.luma { } + {} }"), HasSubstr("a mask cannot be combined with"));
  EXPECT_THAT(error("fx.group { opacty = 1, fx.a {} }"), HasSubstr("did you mean 'opacity'?"));
  EXPECT_THAT(error("fx.mix { fx.a {} }"), HasSubstr("fx.mix has 1 looks; allowed: two"));
  EXPECT_THAT(error("fx.group { fx.volume { settings = {} } }"), HasSubstr("not an effect"));
}

TEST_F(Composition, AMissingLayerIsNamedWithThoseThatAreThere) {
  scene.context.layers = {"ViewLayer.albedo", "ViewLayer.Depth"};
  scene.stack("fx.a { mask = fx.mask.layer { layer = \"albdo\" } }");
  const Graph graph = scene.graph();
  ASSERT_EQ(graph.skipped.size(), 1u);
  EXPECT_EQ(graph.skipped[0].reason,
            "no layer:albdo input; the picture has the layers ViewLayer.albedo, ViewLayer.Depth");
  EXPECT_EQ(scene.warnings.size(), 1u);
  EXPECT_THAT(error("fx.a { required = true, mask = fx.mask.layer { layer = \"albdo\" } }"),
              HasSubstr("preset.lua:3: error: effect 'a' is required, but there is no layer:albdo input"));
  scene.context.auxiliary["layer:albdo"] = scene.context.size;
  EXPECT_EQ(error("fx.a { required = true, mask = fx.mask.layer { layer = \"albdo\" } }"), "");
}

TEST_F(Composition, AnEffectMayAskForLayers) {
  scene.effect("layered", R"(needs = { "layer:albedo" },
    build = function(g, s, source) return g:pass { shader = "two", source = source, other = g:input("layer:albedo") } end,)");
  scene.write("shaders/two.glsl", "vec4 apply(vec4 color, vec4 other) { return color * other; }\n");
  scene.context.auxiliary["layer:albedo"] = scene.context.size;
  EXPECT_EQ(error("fx.layered { }"), "");
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  EXPECT_THAT(preset->needs(), ElementsAre("layer:albedo"));
}

TEST_F(Composition, WhatAMaskCanUseIsAskedFor) {
  scene.stack("fx.a { mask = fx.mask.cryptomatte { names = \"Lamp\" } }");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  EXPECT_THAT(preset->needs(), ElementsAre("layer:CryptoObject00", "layer:CryptoObject01", "layer:CryptoObject02"));
}

TEST_F(Composition, InputsThatDependOnTheFrameAreAskedFor) {
  // A mask that selects nothing in the first frame.
  scene.stack("fx.a { mask = fx.mask.depth { from = fx.curve { { 1, 20 }, { 2, 0 } }, to = 10 } }");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  EXPECT_THAT(preset->needs(), ElementsAre("depth"));
  // A layer whose name depends on the frame is known with it.
  scene.stack("fx.a { mask = fx.mask.layer { layer = function(t) return t.frame < 3 and \"ma\" or \"mb\" end } }");
  preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  EXPECT_THAT(preset->needs(), ElementsAre("layer:ma"));
  const auto asks_for_more = [&](double frame) {
    scene.context.frame = frame;
    const auto more = preset->note_needs(scene.context);
    EXPECT_TRUE(more.ok());
    return more.ok() && *more;
  };
  EXPECT_FALSE(asks_for_more(2));
  EXPECT_TRUE(asks_for_more(3));
  EXPECT_THAT(preset->needs(), ElementsAre("layer:ma", "layer:mb"));
  EXPECT_FALSE(asks_for_more(3));
  EXPECT_TRUE(usual_context(*preset, {8, 8}, 3, 24).auxiliary.contains("layer:mb"));
  // Evaluation notes them too.
  preset = scene.load();
  ASSERT_TRUE(scene.evaluate(*preset));
  EXPECT_THAT(preset->needs(), ElementsAre("layer:ma", "layer:mb"));
}

TEST_F(Composition, ShadersOfMasksAreWarnedOf) {
  scene.write("masks/leveled.lua", R"(local fx = require "afterglow"
    return fx.effect { name = "leveled", settings = {},
      build = function(g, s, source) return g:pass { shader = "leveled", source = source } end })");
  scene.write("shaders/leveled.glsl",
              "uniform sampler2D source;\nvec4 sample_at(ivec2 p) { return textureLod(source, vec2(0.5), 1.0); }\n");
  EXPECT_EQ(error("fx.a { mask = fx.mask.leveled {} }"), "");
  EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("level")));
}

TEST_F(Composition, LongTextsAreWholeOrRefused) {
  const auto with = [&](std::size_t size) {
    scene.stack("fx.a { mask = fx.mask.cryptomatte { names = \"" + std::string(size, 'x') + "\" } }");
    auto preset = scene.load();
    if (!preset) return std::size_t{0};
    const auto& settings = preset->entries()[0].mask->parts()[0]->settings;
    return std::ranges::find(settings, "names", [](const auto& one) { return one.first; })->second.choice.size();
  };
  EXPECT_EQ(with(4096), 4096u);
  EXPECT_EQ(with(4097), 0u);
  EXPECT_THAT(scene.load_error(), HasSubstr("is too long; allowed: a text of at most 4096 bytes"));
}

TEST_F(Composition, ArgumentsComeFromTheCommandLine) {
  const std::string text = R"(local fx = require "afterglow"
local args = fx.args { strength = fx.float { min = 0, max = 2, default = 0.5, doc = "How much." },
                       warm = fx.bool { default = false }, name = fx.text { } }
return fx.stack { fx.a { strength = args.strength }, args.warm and fx.b { } })";
  const auto strength = [&] {
    scene.preset(text);
    auto preset = scene.load();
    if (!preset) return preset.error().text();
    return preset->entries()[0].settings[0].second.text() + " " + std::to_string(preset->entries().size());
  };
  EXPECT_EQ(strength(), "0.5 1");
  scene.options.arguments = {{"strength", "1.5"}, {"warm", "true"}};
  EXPECT_EQ(strength(), "1.5 2");
  scene.options.arguments = {{"strength", "3"}};
  EXPECT_THAT(strength(), HasSubstr("--arg strength = 3 is out of range; allowed: 0…2"));
  scene.options.arguments = {{"strenght", "1"}};
  EXPECT_THAT(strength(), HasSubstr("--arg strenght: the preset declares no argument of this name; allowed: strength, "
                                    "warm, name; did you mean 'strength'?"));
  scene.options.arguments = {{"x", "1"}};
  scene.stack("fx.a { }");
  EXPECT_THAT(scene.load_error(), HasSubstr("the preset declares no arguments (fx.args)"));
}

TEST_F(Composition, AnArgumentThatIsNotDeclaredIsAnError) {
  scene.preset(
      "local fx = require \"afterglow\"\nlocal args = fx.args { strength = fx.float { default = 1 } }\n"
      "return fx.stack { fx.a { strength = args.strenght } }");
  EXPECT_THAT(scene.load_error(), HasSubstr("did you mean 'strength'?"));
}

TEST_F(Composition, StraightColourIsForPixelShaders) {
  scene.effect("bent", R"(alpha = "straight",
    build = function(g, s, source) return g:pass { shader = "pixel", source = source } end,)");
  scene.stack("fx.bent { }");
  EXPECT_TRUE(scene.graph().passes[0].straight);
  scene.effect("blurred", R"(alpha = "straight",
    build = function(g, s, source) return g:filter { source = source, filter = fx.filters.tent() } end,)");
  EXPECT_THAT(error("fx.blurred { }"), HasSubstr("is for effects of pixel shaders, not of filters"));
  scene.effect("wrong", R"(alpha = "strait",
    build = function(g, s, source) return source end,)");
  EXPECT_THAT(
      error("fx.wrong { }"),
      HasSubstr("effects/wrong.lua:3: error: fx.effect: alpha cannot be 'strait'; allowed: associated, straight; did "
                "you mean 'straight'?"));
}

}  // namespace
}  // namespace afterglow::test
