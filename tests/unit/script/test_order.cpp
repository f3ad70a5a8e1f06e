// SPDX-License-Identifier: MIT
// Where an entry runs: injection point, then order, then position; and what entries are called.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene.h"

namespace afterglow::test {
namespace {

using testing::ElementsAre;

std::vector<std::string> names(const Preset& preset) {
  std::vector<std::string> out;
  for (const auto& entry : preset.entries()) out.push_back(entry.name);
  return out;
}

struct Order : testing::Test {
  Order() {
    for (const std::string name : {"a", "b", "c"})
      scene.effect(name, "order = " + std::string(name == "c" ? "5" : "10") + R"(,
        build = function(g, s, source) return source end,)");
  }
  std::vector<std::string> order(const std::string& entries) {
    scene.stack(entries);
    auto preset = scene.load();
    if (!preset) return {preset.error().text()};
    return names(*preset);
  }
  Scene scene;
};

TEST_F(Order, ByOrderThenPosition) {
  EXPECT_THAT(order("fx.b {}, fx.a {}, fx.c {}"), ElementsAre("c", "b", "a"));
  EXPECT_THAT(order("fx.b {}, fx.a { order = 9 }, fx.c { order = 9 }"), ElementsAre("a", "c", "b"));
  EXPECT_THAT(order("fx.a { order = -1 }, fx.b { order = -2 }"), ElementsAre("b", "a"));
}

TEST_F(Order, InjectionPointsComeFirst) {
  EXPECT_THAT(
      order(R"(fx.a { at = "after_post_process", order = -100, name = "w" }, fx.a { at = "post_process", name = "x" },
                       fx.a { at = "before_post_process", name = "y" },
                       fx.a { at = "after_opaque_and_sky", order = 1000, name = "z" })"),
      ElementsAre("z", "y", "x", "w"));
}

TEST_F(Order, LightIsFollowedThroughTheStack) {
  const auto effect = [&](const std::string& name, const std::string& space) {
    scene.effect(name,
                 space +
                     " active = function(s) return s.on, \"off\" end, settings = { on = fx.bool { default = true } },"
                     " build = function(g, s, source) return source end,");
  };
  effect("toner", "order = 10, space = { needs = \"scene\", makes = \"display\" },");
  effect("grade", "space = \"scene\",");
  effect("shine", "order = 20, space = function(s) return s.on and \"display\" or nil end,");
  const auto spaces = [&](const std::string& entries) {
    scene.stack(entries);
    auto preset = scene.load();
    EXPECT_TRUE(preset.ok());
    auto found = preset->spaces();
    EXPECT_TRUE(found.ok());
    return found.ok() ? *found : std::vector<EntrySpace>{};
  };
  auto found = spaces("fx.shine {}, fx.grade {}, fx.toner {}");
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].behind, LightSpace::scene);
  EXPECT_EQ(found[1].behind, LightSpace::display);
  EXPECT_EQ(found[2].before, LightSpace::display);
  EXPECT_EQ(found[2].use.needs, LightSpace::display);
  for (const auto& entry : found) EXPECT_EQ(entry.warning, "");
  found = spaces("fx.grade { order = 15 }, fx.shine { order = 1 }, fx.toner {}");
  EXPECT_NE(found[0].warning, "");
  EXPECT_EQ(found[1].warning, "");
  EXPECT_NE(found[2].warning, "");
  // Neither an entry that is off nor one that is left out makes light.
  for (const char* curve : {"fx.toner { on = false }", "fx.toner { enabled = false }"})
    for (const auto& entry : spaces("fx.grade { order = 15 }, fx.shine { order = 1 }, " + std::string(curve)))
      EXPECT_EQ(entry.warning, "");
  effect("shine", "space = function(s) return 7 end,");
  scene.stack("fx.shine {}");
  auto preset = scene.load();
  const auto wrong = preset->spaces();
  ASSERT_FALSE(wrong.ok());
  EXPECT_NE(wrong.error().text().find("space of effect 'shine' = 7 is no space; allowed: scene, display"),
            std::string::npos)
      << wrong.error().text();
}

TEST_F(Order, ManyEqualsKeepTheirPlaces) {
  std::string entries;
  std::vector<std::string> expected;
  for (int i = 0; i < 100; ++i) {
    entries += "fx.a { name = \"e" + std::to_string(i) + "\" },";
    expected.push_back("e" + std::to_string(i));
  }
  EXPECT_EQ(order(entries), expected);
}

TEST_F(Order, SecondOnesGetANumber) {
  EXPECT_THAT(order("fx.a {}, fx.a {}, fx.a {}"), ElementsAre("a", "a#2", "a#3"));
  EXPECT_THAT(order("fx.a {}, fx.b { name = \"a\" }"), ElementsAre("a#2", "a"));
}

TEST_F(Order, HolesInAStackDoNotMatter) { EXPECT_THAT(order("fx.a {}, nil, fx.b {}"), ElementsAre("a", "b")); }

TEST_F(Order, AnEmptyStackIsFine) {
  EXPECT_THAT(order(""), ElementsAre());
  const Graph graph = scene.graph();
  EXPECT_EQ(graph.result, graph.source);
}

TEST_F(Order, TheStackIsNamedByItsFileOtherwise) {
  scene.stack("");
  EXPECT_EQ(scene.load()->name(), "preset");
}

TEST_F(Order, SettingsKeepTheOrderOfDeclaration) {
  scene.effect("many", R"(settings = {
      zeta = fx.bool { default = true }, alpha = fx.bool { default = true }, mid = fx.bool { default = true },
      beta = fx.bool { default = true }, last = fx.bool { default = true }, },
    build = function(g, s, source) return source end,)");
  scene.stack("fx.many { mid = false, alpha = true }");
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  std::vector<std::string> declared;
  for (const auto& setting : preset->schema("many").settings) declared.push_back(setting.name);
  EXPECT_THAT(declared, ElementsAre("zeta", "alpha", "mid", "beta", "last"));
  EXPECT_THAT(preset->entries()[0].changed, ElementsAre("alpha", "mid"));
}

TEST_F(Order, LightIsFollowedThroughGroupsAndMixes) {
  scene.effect("view",
               "order = 10, space = { needs = \"scene\", makes = \"display\", view = true },"
               " build = function(g, s, source) return source end,");
  scene.effect("plain", "order = 10, build = function(g, s, source) return source end,");
  const auto trace = [&](const std::string& entries) {
    scene.stack(entries);
    auto preset = scene.load();
    EXPECT_TRUE(preset.ok());
    auto found = preset->spaces();
    EXPECT_TRUE(found.ok());
    return found.ok() ? *found : std::vector<EntrySpace>{};
  };
  for (const std::string seen :
       {"fx.view {}", "fx.group { fx.view {} }", "fx.view { opacity = 0.5 }", "fx.mix { {}, fx.view {}, amount = 0.5 }",
        "fx.mix { fx.view {}, {}, amount = 0.5 }", "fx.mix { fx.view {}, fx.plain {}, amount = 0 }"})
    EXPECT_TRUE(ends_in_view(trace(seen))) << seen;
  for (const std::string unseen :
       {"fx.view { enabled = false }", "fx.view { opacity = 0 }", "fx.view { mask = 0 }",
        "fx.group { enabled = false, fx.view {} }", "fx.group { opacity = 0, fx.view {} }",
        "fx.group { mask = 0, fx.group { fx.view {} } }", "fx.mix { {}, fx.view {}, amount = 0 }",
        "fx.mix { fx.view {}, {}, amount = 1 }", "fx.plain {}"})
    EXPECT_FALSE(ends_in_view(trace(unseen))) << unseen;
  // Both looks of a mix get the scene's light; what is behind it gets what they make.
  auto found = trace("fx.mix { fx.view {}, fx.view {} }, fx.view { order = 20 }");
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[1].warning + found[2].warning, "");
  EXPECT_EQ(found[2].before, LightSpace::scene);
  EXPECT_EQ(found[0].behind, LightSpace::display);
  EXPECT_THAT(found[3].warning, testing::HasSubstr("is made for scene-linear light"));
}

TEST_F(Order, WhatIsWrittenBetweenTwoChangesOfSpaceRunsBetweenThem) {
  scene.effect("to", "order = 10, space = { makes = \"other\" }, build = function(g, s, source) return source end,");
  scene.effect("from",
               "order = 10, space = { needs = \"other\", makes = \"scene\" },"
               " build = function(g, s, source) return source end,");
  scene.effect("grade", "order = 20, space = \"scene\", build = function(g, s, source) return source end,");
  scene.effect("view",
               "order = 30, space = { needs = \"scene\", makes = \"display\" },"
               " build = function(g, s, source) return source end,");
  const auto warnings = [&](const std::string& entries) {
    scene.stack(entries);
    auto preset = scene.load();
    EXPECT_TRUE(preset.ok());
    std::vector<std::string> out;
    const auto spaces = preset->spaces();
    for (const auto& space : *spaces)
      if (!space.warning.empty()) out.push_back(space.warning);
    return out;
  };
  EXPECT_THAT(warnings("fx.to {}, fx.grade {}, fx.from {}, fx.view {}"),
              ElementsAre("'from' comes back from what 'to' makes before 'grade', which is written between them, runs: "
                          "`order` says when"));
  EXPECT_THAT(warnings("fx.to {}, fx.grade { order = 10 }, fx.from {}, fx.view {}"), testing::IsEmpty());
  EXPECT_THAT(warnings("fx.from {}, fx.grade {}, fx.view {}"), testing::IsEmpty()) << "the picture's own space";
  EXPECT_THAT(warnings("fx.to {}, fx.grade {}, fx.view {}"),
              ElementsAre("'view' is made for scene-linear light, but 'to' before it makes values of another space"));
}

TEST_F(Order, AGroupHasWhatItDoesNotSayFromItsFirstEffect) {
  scene.effect("late", "at = \"after_post_process\", order = 7, build = function(g, s, source) return source end,");
  const auto place = [&](const std::string& keys, const std::vector<Override>& overrides = {}) {
    scene.options.overrides = overrides;
    scene.stack("fx.group { name = \"edges\", " + keys + "fx.late {} }");
    auto preset = scene.load();
    if (!preset) return preset.error().text();
    const StackEntry& group = preset->entries().front();
    return group.at + " " + std::to_string(group.order);
  };
  EXPECT_EQ(place(""), "after_post_process 7");
  EXPECT_EQ(place("order = 130, "), "after_post_process 130");
  EXPECT_EQ(place("at = \"before_post_process\", "), "before_post_process 7");
  EXPECT_EQ(place("at = \"post_process\", order = 1, "), "post_process 1");
  EXPECT_EQ(place("", {{"edges", "order", "130"}}), "after_post_process 130");
}

}  // namespace
}  // namespace afterglow::test
