// SPDX-License-Identifier: MIT
// The first frame is built twice: what keeps state between frames is found. And settings that nothing reads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene.h"

namespace afterglow::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kPass = "return g:pass { shader = \"e/e\", source = source, k = n }";

class RepeatedBuild : public testing::Test {
 protected:
  void SetUp() override {
    scene.write("shaders/e/e.glsl", "uniform float k;\nvec4 apply(vec4 color) { return color * k; }\n");
    scene.stack("fx.e {}");
  }
  /// What is warned about an effect whose file holds `local n = 0` and this body of `build`.
  std::vector<std::string> warnings(const std::string& body) {
    scene.warnings.clear();
    scene.write("effects/e.lua",
                "local fx = require \"afterglow\"\nlocal n, last = 0, nil\nreturn fx.effect { name = \"e\",\n"
                "build = function(g, s, source) " +
                    body + " end }\n");
    EXPECT_EQ(scene.build_error(), "");
    return scene.warnings;
  }
  Scene scene;
};

TEST_F(RepeatedBuild, StateInAnUpvalueIsWarnedAbout) {
  const std::string begin = "effect 'e': build gives another graph the second time: it keeps state between frames ";
  EXPECT_THAT(warnings(std::string("n = n + 1 ") + kPass), ElementsAre(begin + "(k of pass 'e.e' is 1, then 3)"));
  EXPECT_THAT(warnings(std::string("count = (rawget(_ENV, \"count\") or 0) + 1 n = 2 * count ") + kPass),
              ElementsAre(HasSubstr(begin)));
  EXPECT_THAT(
      warnings(std::string("n = n + 1 for i = 1, n do source = g:pass { shader = \"e/e\", source = source, k = 1 "
                           "} end return source")),
      ElementsAre(begin + "(the number of its passes is 1, then 3)"));
  EXPECT_THAT(warnings(std::string("n = n + 1 if n > 1 then return source end ") + kPass),
              ElementsAre(begin + "(the number of its passes is 1, then 0)"));
  // What only shows when another frame was made in between.
  EXPECT_THAT(warnings(std::string("n = last and g.frame - last or 0 last = g.frame ") + kPass),
              ElementsAre(HasSubstr(begin)));
}

TEST_F(RepeatedBuild, WhatComesOutTheSameIsNot) {
  EXPECT_THAT(warnings(std::string("n = g.frame ") + kPass), IsEmpty());
  EXPECT_THAT(warnings(std::string("if n == 0 then n = 5 end ") + kPass), IsEmpty());
  scene.notes.clear();
  EXPECT_THAT(warnings(std::string("print(\"here\") ") + kPass), IsEmpty());
  EXPECT_THAT(scene.notes, ElementsAre("effects/e.lua:4: here")) << "said once";
}

TEST_F(RepeatedBuild, SettingsThatNothingReads) {
  scene.options.note_reads = true;
  const auto unread = [&](const std::string& settings, const std::string& body) {
    scene.write("effects/e.lua",
                "local fx = require \"afterglow\"\n-- gone is not read\nreturn fx.effect { name = "
                "\"e\", settings = { " +
                    settings + " },\nbuild = function(g, s, source) " + body +
                    " return g:pass { shader = \"e/e\", source = source, k = 1 } end }\n");
    std::vector<std::string> out;
    auto preset = scene.load();
    EXPECT_TRUE(preset) << preset.error().text();
    const auto build = scene.evaluate(*preset);
    EXPECT_TRUE(build) << build.error().text();
    for (const auto& [effect, setting] : build->unread) out.push_back(effect + "." + setting);
    return out;
  };
  const std::string two = "used = fx.float { default = 1 }, gone = fx.float { default = 1, doc = \"Is gone.\" }";
  EXPECT_THAT(unread("used = fx.float { default = 1 }, gone = fx.float { default = 1 }", "local k = s.used"),
              ElementsAre("e.gone"));
  EXPECT_THAT(unread(two, "local k = s.used"), IsEmpty()) << "a text that names it may be what reads it";
  EXPECT_THAT(unread("gone = fx.float { default = 1 }", "if g.frame > 100 then local k = s.gone end"), IsEmpty());
  EXPECT_THAT(unread("gone = fx.float { default = 1 }", "for name, value in pairs(s) do end"), IsEmpty());
  EXPECT_THAT(unread("gone = fx.float { default = 1 }", "local k = s[\"go\" .. \"ne\"]"), IsEmpty());
  scene.stack("fx.e { enabled = false }");
  EXPECT_THAT(unread("gone = fx.float { default = 1 }", ""), IsEmpty()) << "it did not run";
}

}  // namespace
}  // namespace afterglow::test
