// SPDX-License-Identifier: MIT
// fx.extend: another preset with some of it changed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene.h"

namespace afterglow::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Extend : testing::Test {
  Extend() {
    scene.effect("glow", R"(
      settings = { gain = fx.float { min = 0, max = 4, default = 1 }, levels = fx.int { min = 1, max = 9, default = 3 } },
      build = function(g, s, source) return source end,)");
    write_preset("base.lua",
                 "name = \"Base\", max_error = 0.1, fx.glow { gain = 2, levels = 5 }, fx.glow { name = \"rim\" }");
  }
  void write_preset(const std::string& name, const std::string& stack) {
    scene.write(name, "local fx = require \"afterglow\"\nreturn fx.stack { " + stack + " }\n");
  }
  void extend(const std::string& arguments) {
    scene.preset("local fx = require \"afterglow\"\nreturn fx.extend(" + arguments + ")\n");
  }
  std::string error(const std::string& arguments) {
    extend(arguments);
    return scene.load_error();
  }
  // "NAME gain levels" of each entry, in the order of execution.
  std::vector<std::string> entries() {
    auto preset = scene.load();
    if (!preset) return {scene.shorten(preset.error().text())};
    std::vector<std::string> out;
    for (const auto& entry : preset->entries())
      out.push_back(entry.name + " " + entry.settings[0].second.text() + " " + entry.settings[1].second.text());
    return out;
  }
  Scene scene;
};

TEST_F(Extend, ChangesWhatIsNamedAndKeepsTheRest) {
  extend("\"base\", { glow = { gain = 0.5 } }");
  EXPECT_THAT(entries(), ElementsAre("glow 0.5 5", "rim 1 3"));
  auto preset = scene.load();
  EXPECT_EQ(preset->name(), "Base");
  EXPECT_EQ(preset->max_error(), 0.1);
  extend("\"base\"");
  EXPECT_THAT(entries(), ElementsAre("glow 2 5", "rim 1 3"));
  extend(
      "\"base\", { name = \"Mine\", max_error = 0.2, rim = { levels = 9, order = -1 }, glow = { enabled = false } }");
  EXPECT_THAT(entries(), ElementsAre("rim 1 9", "glow 2 5"));
  preset = scene.load();
  EXPECT_EQ(preset->name(), "Mine");
  EXPECT_EQ(preset->max_error(), 0.2);
  EXPECT_FALSE(preset->entries()[1].enabled);
}

TEST_F(Extend, AnEffectsNameMeansAllItsEntriesWhenNoneIsCalledSo) {
  write_preset("base.lua", "fx.glow { name = \"a\" }, fx.glow { name = \"b\" }");
  extend("\"base\", { glow = { gain = 3 } }");
  EXPECT_THAT(entries(), ElementsAre("a 3 3", "b 3 3"));
}

TEST_F(Extend, AddsEffectsAndVolumes) {
  extend(R"("base", { fx.glow { gain = 4 }, fx.volume { weight = 0.5, settings = { rim = { gain = 2 } } } })");
  EXPECT_THAT(entries(), ElementsAre("glow 2 5", "rim 1.5 3", "glow#2 4 3"));
}

TEST_F(Extend, VolumesOfTheBaseStay) {
  write_preset("base.lua", "fx.glow {}, fx.volume { weight = 0.5, settings = { glow = { gain = 4 } } }");
  extend("\"base\", { glow = { gain = 2 } }");
  EXPECT_THAT(entries(), ElementsAre("glow 3 3"));
}

TEST_F(Extend, OverSeveralGenerations) {
  scene.write(
      "middle.lua",
      "local fx = require \"afterglow\"\nreturn fx.extend(\"base\", { glow = { gain = 3 }, rim = { gain = 3 } })\n");
  extend("\"middle\", { rim = { gain = fx.curve { { 1, 0 }, { 3, 4 } } } }");
  scene.context.frame = 2;
  EXPECT_THAT(entries(), ElementsAre("glow 3 5", "rim 0 3"));
}

TEST_F(Extend, LooksBesideThePresetThenInPathsThenInTheInstallation) {
  extend("\"neon_night\", { tone_mapping = { mode = \"reinhard\" } }");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  EXPECT_EQ(preset->name(), "Neon night");
  scene.options.paths = {scene.folder() / "more"};
  write_preset("more/presets/neon_night.lua", "name = \"More\", fx.tone_mapping {}");
  EXPECT_EQ(scene.load()->name(), "More");
  write_preset("neon_night.lua", "name = \"Beside\", fx.tone_mapping {}");
  EXPECT_EQ(scene.load()->name(), "Beside");
}

TEST_F(Extend, APresetMayExtendTheOneThatItHides) {
  scene.write("preset.lua", "");
  scene.options.paths = {scene.folder() / "more"};
  write_preset("more/preset.lua", "name = \"Hidden\", fx.glow {}");
  extend("\"preset\", { glow = { gain = 2 } }");
  EXPECT_THAT(entries(), ElementsAre("glow 2 3"));
}

TEST_F(Extend, WhatTheBaseBringsAlongIsFound) {
  scene.write("kit/kit.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.invert {} }\n");
  scene.write(
      "kit/effects/invert.lua",
      "local fx = require \"afterglow\"\nreturn fx.effect { name = \"invert\", settings = { by = fx.float { default = "
      "1 } "
      "},\n build = function(g, s, source) return g:pass { shader = \"invert\", source = source, by = s.by } end }\n");
  scene.write("kit/shaders/invert.glsl", "uniform float by;\nvec4 apply(vec4 color) { return by - color; }\n");
  extend("\"kit\", { invert = { by = 2 } }");
  EXPECT_EQ(scene.graph().passes.at(0).params.at("by").v[0], 2);
}

TEST_F(Extend, Messages) {
  EXPECT_THAT(error("\"neon_nigth\""), HasSubstr("preset.lua:2: error: there is no preset 'neon_nigth'; allowed: "));
  EXPECT_THAT(error("\"neon_nigth\""), HasSubstr("did you mean 'neon_night'?"));
  EXPECT_THAT(error("\"../base\""), HasSubstr("there is no preset '../base'"));
  EXPECT_EQ(error("3"),
            "preset.lua:2: error: fx.extend: 3 is not the name of a preset; allowed: fx.extend(\"NAME\", { ENTRY = { "
            "SETTING = "
            "VALUE } })");
  EXPECT_EQ(
      error("\"base\", {\n glwo = {} }"),
      "preset.lua:3: error: fx.extend: the stack has no entry 'glwo'; allowed: glow, rim, alpha, gamut, input_space, "
      "max_error, name, "
      "position, reference_height, requires; "
      "did you mean 'glow'?");
  EXPECT_EQ(error("\"base\", {\n glow = {\n gian = 1 } }"),
            "preset.lua:4: error: effect 'glow' has no setting 'gian'; allowed: gain, levels; did you mean 'gain'?");
  EXPECT_EQ(error("\"base\", {\n rim = {\n gain = 5 } }"),
            "preset.lua:4: error: glow.gain = 5 is out of range; allowed: 0…4");
  EXPECT_EQ(error("\"base\", { glow = 5 }"), "preset.lua:2: error: fx.extend: glow = 5 is not a table");
  EXPECT_EQ(error("\"base\", { glow = { name = \"x\" } }"),
            "preset.lua:2: error: fx.extend: 'glow' cannot be named anew: volumes and --set call it so");
  EXPECT_EQ(error("\"preset\""), "preset.lua:2: error: preset 'preset' extends itself");
  write_preset("base.lua", "\nfx.glow { gain = 9 }");
  EXPECT_EQ(error("\"base\""), "base.lua:3: error: glow.gain = 9 is out of range; allowed: 0…4");
}

TEST_F(Extend, ACircleIsAnError) {
  scene.write("one.lua", "return require(\"afterglow\").extend(\"two\")\n");
  scene.write("two.lua", "return require(\"afterglow\").extend(\"one\")\n");
  EXPECT_EQ(error("\"one\""), "two.lua:1: error: preset 'one' extends itself");
}

TEST_F(Extend, ALinkMayNotLeadOut) {
  scene.write("../afterglow_outside.lua", "return require(\"afterglow\").stack {}\n");
  std::filesystem::create_symlink(scene.folder().parent_path() / "afterglow_outside.lua", scene.folder() / "out.lua");
  EXPECT_THAT(error("\"out\""), HasSubstr("preset 'out' is a link that leads out of"));
  std::filesystem::remove(scene.folder().parent_path() / "afterglow_outside.lua");
}

}  // namespace
}  // namespace afterglow::test
