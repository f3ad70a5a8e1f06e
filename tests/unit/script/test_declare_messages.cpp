// SPDX-License-Identifier: MIT
// What the author of an effect reads when its declaration is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene.h"

namespace afterglow::test {
namespace {

constexpr const char* kBuild = "\n  build = function(g, s, source) return source end,";

// Lines of the body begin at 3.
std::string declared(const std::string& body) {
  Scene scene;
  scene.effect("glow", body + kBuild);
  scene.stack("fx.glow {}");
  return scene.load_error();
}

std::string setting(const std::string& type) { return declared("  settings = {\n    amount = " + type + ",\n  },"); }

TEST(DeclareMessages, Effects) {
  EXPECT_EQ(declared("  odrer = 3,"),
            "effects/glow.lua:3: error: fx.effect has no 'odrer'; allowed: active, alpha, at, build, detail, doc, "
            "holds, idle, name, "
            "needs, optional, order, "
            "settings, space; did you mean 'order'?");
  EXPECT_EQ(declared("\n  at = \"post\","),
            "effects/glow.lua:4: error: fx.effect: unknown injection point 'post'; allowed: after_opaque_and_sky, "
            "before_post_process, post_process, after_post_process; did you mean 'post_process'?");
  EXPECT_EQ(
      declared("  order = \"last\","),
      "effects/glow.lua:3: error: fx.effect: order = \"last\" is not an integer; allowed: integer −1000000…1000000");
  EXPECT_EQ(declared("  active = true,"), "effects/glow.lua:3: error: fx.effect: active = true is not a function");
  EXPECT_EQ(declared("  settings = 4,"), "effects/glow.lua:3: error: fx.effect: settings = 4 is not a table");
  EXPECT_EQ(declared("  needs = {\n   \"dept\" },"),
            "effects/glow.lua:4: error: fx.effect: needs: unknown input 'dept'; allowed: depth, normal, motion, "
            "layer:NAME; did "
            "you mean 'depth'?");
  EXPECT_EQ(declared("  optional = { 1 },"),
            "effects/glow.lua:3: error: fx.effect: optional holds 1, not the name of an input; allowed: depth, normal, "
            "motion");
  EXPECT_EQ(declared("  needs = \"depth\","),
            "effects/glow.lua:3: error: fx.effect: needs = \"depth\" is not a list of inputs; allowed: { \"depth\" }");
  EXPECT_EQ(declared("  space = \"scen\","),
            "effects/glow.lua:3: error: fx.effect: space = \"scen\" is no space; allowed: scene, display, other; did you mean "
            "'scene'?");
  EXPECT_EQ(declared("  space = {\n   makes = 1 },"),
            "effects/glow.lua:4: error: fx.effect: space: makes = 1 is no space; allowed: scene, display, other");
  EXPECT_EQ(
      declared("  space = {\n   make = \"scene\" },"),
      "effects/glow.lua:4: error: fx.effect: space has no 'make'; allowed: makes, needs, view; did you mean 'makes'?");
  EXPECT_EQ(declared("  7,"),
            "effects/glow.lua:3: error: fx.effect has a value without a name at position 1; allowed: active, alpha, "
            "at, build, detail, doc, "
            "holds, idle, name, needs, optional, order, settings, space");
}

TEST(DeclareMessages, EffectFiles) {
  Scene scene;
  scene.stack("fx.glow {}");
  const auto file = [&](const std::string& text) {
    scene.write("effects/glow.lua", "local fx = require \"afterglow\"\n" + text);
    return scene.load_error();
  };
  EXPECT_EQ(file("return 1"), "effects/glow.lua: error: an effect's file must return fx.effect { … }, not 1");
  EXPECT_EQ(file("return fx.effect { name = \"shine\", build = function() end }"),
            "effects/glow.lua: error: declares the effect 'shine', but its file is named 'glow.lua'");
  EXPECT_EQ(file("return fx.effect {\n build = function() end,\n name = \"stack\" }"),
            "effects/glow.lua:4: error: fx.effect: the name 'stack' is taken by the library");
  EXPECT_EQ(file("return fx.effect { build = function() end }"),
            "effects/glow.lua:2: error: fx.effect needs a name; allowed: letters, digits and '_'");
  EXPECT_EQ(file("return fx.effect { name = \"glow\" }"),
            "effects/glow.lua:2: error: fx.effect needs 'build', a function");
  EXPECT_THAT(
      file("return fx.effect { name = \"glow\",\n biuld = function() end }"),
      testing::AllOf(testing::StartsWith("effects/glow.lua:3: error: fx.effect has no 'biuld'; allowed: active"),
                     testing::EndsWith("did you mean 'build'?")));
  EXPECT_EQ(file("return fx.effect { name = \"glow\", build = fx.glow }"),
            "effects/glow.lua:2: error: 'effects.glow' needs itself while it loads");
  EXPECT_EQ(file("return fx.effect {"), "effects/glow.lua:2: error: unexpected symbol near <eof>");
}

TEST(DeclareMessages, Settings) {
  EXPECT_EQ(setting("5"),
            "effects/glow.lua:4: error: fx.effect: setting 'amount' = 5 is not a setting type; allowed: fx.int, "
            "fx.float, fx.bool, "
            "fx.enum, fx.color, fx.vec2, fx.vec3, fx.file, fx.text");
  EXPECT_EQ(
      setting("fx.float {\n mim = 0, default = 0 }"),
      "effects/glow.lua:5: error: fx.float has no 'mim'; allowed: default, doc, max, min, unit; did you mean 'min'?");
  EXPECT_EQ(setting("fx.float { min = 0 }"), "effects/glow.lua:4: error: fx.float has no default; allowed: ≥ 0");
  EXPECT_EQ(setting("fx.float { min = 0,\n default = -1 }"),
            "effects/glow.lua:5: error: fx.float: default = -1 is out of range; allowed: ≥ 0");
  EXPECT_EQ(setting("fx.int { min = 2, max = 1, default = 1 }"),
            "effects/glow.lua:4: error: fx.int: min 2 is above max 1");
  EXPECT_EQ(setting("fx.int { min = 1/0, default = 1 }"),
            "effects/glow.lua:4: error: fx.int: min = inf is not a finite number");
  EXPECT_EQ(setting("fx.bool { default = 1 }"),
            "effects/glow.lua:4: error: fx.bool: default = 1 is not a boolean; allowed: true, false");
  EXPECT_EQ(setting("fx.bool { min = 1, default = true }"),
            "effects/glow.lua:4: error: fx.bool has no 'min'; allowed: default, doc");
  EXPECT_EQ(setting("fx.enum { default = \"a\" }"), "effects/glow.lua:4: error: fx.enum has no choices");
  EXPECT_EQ(setting("fx.enum { \"a\",\n \"a\", default = \"a\" }"),
            "effects/glow.lua:5: error: fx.enum: 'a' is there twice");
  EXPECT_EQ(setting("fx.enum { \"a\", 5, default = \"a\" }"),
            "effects/glow.lua:4: error: fx.enum: choice 2 is 5; allowed: texts of letters, digits and '_'");
  EXPECT_EQ(setting("fx.enum { \"a\", default = \"b\" }"),
            "effects/glow.lua:4: error: fx.enum: default = \"b\" is not a choice; allowed: a");
  EXPECT_EQ(setting("fx.float(5)"),
            "effects/glow.lua:4: error: fx.float takes a table, not 5; allowed: fx.float { … }");
  EXPECT_EQ(declared("  settings = { name = fx.bool { default = true } },"),
            "effects/glow.lua:3: error: fx.effect: no setting may be named 'name', which every entry has");
  EXPECT_EQ(declared("  settings = { fx.bool { default = true } },"),
            "effects/glow.lua:3: error: fx.effect: a setting needs a name; allowed: letters, digits and '_'");
  EXPECT_EQ(
      declared("  settings = { [\"my size\"] = fx.bool { default = true } },"),
      "effects/glow.lua:3: error: fx.effect: 'my size' cannot be the name of a setting; allowed: 1 to 64 letters, "
      "digits and '_', no digit first");
}

TEST(DeclareMessages, FunctionsOfSettings) {
  EXPECT_EQ(
      declared("  settings = { amount = fx.float { default = 1 } },\n  active = function(s) return s.amonut > 0 end,"),
      "effects/glow.lua:4: error: effect 'glow' has no setting \"amonut\"; allowed: amount; did you mean 'amount'?\n"
      "  in effect 'glow' of preset.lua:3");
  EXPECT_EQ(declared("\n  active = function(s) end,"),
            "effects/glow.lua:4: error: active of effect 'glow' returned nil, not true or false\n  in effect 'glow' of "
            "preset.lua:3");
  EXPECT_EQ(declared("\n  needs = function(s) return { \"sky\" } end,"),
            "effects/glow.lua:4: error: needs of effect 'glow': unknown input 'sky'; allowed: depth, normal, motion, "
            "layer:NAME\n"
            "  in effect 'glow' of preset.lua:3");
  EXPECT_EQ(declared("  active = function(s)\n    s.x = 1\n  end,"),
            "effects/glow.lua:4: error: this table is read-only\n  in effect 'glow' of preset.lua:3");
}

TEST(DeclareMessages, OnlyWhileLoading) {
  Scene scene;
  scene.effect("glow", R"(build = function(g, s, source)
    fx.float { default = 1 }
  end,)");
  scene.stack("fx.glow {}");
  EXPECT_EQ(
      scene.build_error(),
      "effects/glow.lua:4: error: fx.float can only be used while a script loads\n  in effect 'glow' of preset.lua:3");
}

}  // namespace
}  // namespace afterglow::test
