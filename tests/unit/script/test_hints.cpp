// SPDX-License-Identifier: MIT
// What beginners of Lua read at the usual slips: what is missing, and where.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene.h"

namespace afterglow::test {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Hints : testing::Test {
  Hints() {
    scene.effect("glow", R"(
      settings = { mode = fx.enum { "soft", "hard", default = "soft" }, gain = fx.float { default = 1 },
                   knee = fx.float { default = 1 } },
      build = function(g, s, source) return source end,)");
  }
  std::string error(const std::string& entries) {
    scene.stack(entries);
    return scene.load_error();
  }
  std::string of_text(const std::string& text) {
    scene.preset(text);
    return scene.load_error();
  }
  Scene scene;
};

TEST_F(Hints, TheLibraryIsNamedWithItsLine) {
  EXPECT_EQ(
      of_text("return fx.stack { fx.glow {} }"),
      "preset.lua:1: error: nothing here has the name 'fx': begin the file with local fx = require \"afterglow\"");
}

TEST_F(Hints, WordsWithoutQuotationMarks) {
  for (const char* entry :
       {"fx.glow { mode = soft }", "fx.glow { mode = soft, gain = 2 }", "fx.glow { gain = 2, mode=soft -- a word\n }"})
    EXPECT_EQ(
        error(entry),
        "preset.lua:3: error: nothing here has the name 'soft'; allowed: words in quotation marks (\"soft\"), and "
        "variables and functions that stand above this line")
        << entry;
  for (const char* entry :
       {"fx.glow { gain = soft * 2 }", "fx.glow { fade = 1 == soft }", "fx.glow { gain = soft() }", "soft {}"})
    EXPECT_THAT(error(entry), Not(HasSubstr("quotation"))) << entry;
  EXPECT_THAT(of_text("local gain = soft\n"), Not(HasSubstr("quotation")));
}

TEST_F(Hints, ACommaThatIsMissing) {
  EXPECT_EQ(error("fx.glow { gain = 1.0 knee = 0.2 },"),
            "preset.lua:3: error: '}' expected near 'knee'; a comma may be missing before it");
  EXPECT_EQ(error("fx.glow {},\n  fx.glow { gain = 1 }  -- the lamps\n\n  -- a note\n  fx.glow {},"),
            "preset.lua:4: error: '}' expected (to close '{' at line 2) near 'fx' in line 7; a comma may be missing at "
            "the end of this line");
  EXPECT_EQ(error("fx.glow {\n  mode = \"soft\"\n  gain = 2,\n},"),
            "preset.lua:4: error: '}' expected (to close '{' at line 3) near 'gain' in line 5; a comma may be missing "
            "at the end of this line");
  EXPECT_EQ(error("fx.glow {},\n  fx.glow {} fx.glow {},"),
            "preset.lua:4: error: '}' expected (to close '{' at line 2) near 'fx'; a comma may be missing before it");
  // A brace that is missing is no comma.
  EXPECT_EQ(of_text("local a = { 1\nreturn a\n"),
            "preset.lua:2: error: '}' expected (to close '{' at line 1) near 'return'");
  EXPECT_THAT(error("fx.glow { a.b = 1 }"), Not(HasSubstr("comma")));
}

TEST_F(Hints, AColonForASignOfEquality) {
  for (const char* entry : {"fx.glow { mode: \"soft\" }", "fx.glow { mode : 3 }", "fx.glow { mode: soft }"})
    EXPECT_THAT(error(entry), HasSubstr("; allowed: mode = …, with a sign of equality")) << entry;
  EXPECT_THAT(of_text("local s = g:pass shader\n"), Not(HasSubstr("equality")));
}

TEST_F(Hints, ACommaInANumber) {
  EXPECT_THAT(error("fx.glow { gain = 0,2 }"),
              HasSubstr("effect 'glow' has a value without a name at position 1: 2; numbers have a point, as 0.5 has"));
  EXPECT_THAT(error("fx.glow { gain = 1, \"soft\" }"), Not(HasSubstr("point")));
}

TEST_F(Hints, AReturnThatIsMissing) {
  EXPECT_EQ(of_text("local fx = require \"afterglow\"\n\nfx.stack {\n  fx.glow {},\n}\n"),
            "preset.lua:3: error: 'return' is missing before fx.stack: a preset must return what it makes");
  EXPECT_EQ(of_text("local fx = require \"afterglow\"\n"),
            "preset.lua: error: a preset must return fx.stack { … }, not nil; allowed: return fx.stack { … }, at the "
            "end");
  scene.write("effects/late.lua",
              "local fx = require \"afterglow\"\nfx.effect { name = \"late\", build = function() end }\n");
  EXPECT_EQ(error("fx.late {}"),
            "effects/late.lua:2: error: 'return' is missing before fx.effect: an effect's file must return what it "
            "makes");
}

TEST_F(Hints, ArgumentsThatAreSwapped) {
  scene.effect("turned", "build = function(s, g, source) return g:pass { shader = \"a\", source = source } end,");
  scene.stack("fx.turned {}");
  EXPECT_THAT(scene.build_error(),
              HasSubstr("effect 'turned' has no setting \"pass\"; it is one of the graph's; allowed: build = "
                        "function(g, s, source), the graph before the settings"));
}

TEST_F(Hints, EffectsThatAreNotFound) {
  EXPECT_EQ(error("fx.screened {}"),
            "preset.lua:3: error: unknown effect 'screened'; allowed: those that `afterglow effects` lists, and "
            "effects/screened.lua beside the preset or below a --path");
  EXPECT_THAT(error("fx.glow { mask = fx.mask.odd {} }"), HasSubstr("masks/odd.lua beside the preset"));
}

/// Beyond 2^31 a square could run over.
TEST_F(Hints, WholeFramesAreIntegers) {
  scene.effect("told", R"(settings = { word = fx.text {} },
      build = function(g, s, source) print("built " .. g.frame .. " for " .. s.word); return source end,)");
  scene.stack("fx.told { word = function(t) return \"img.\" .. t.frame .. \".\" .. t.frame // 2 .. \".png\" end }");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  const auto told = [&](double frame) {
    scene.notes.clear();
    scene.context.frame = frame;
    const auto graph = scene.build(*preset);
    EXPECT_TRUE(graph) << graph.error().text();
    for (const auto& note : scene.notes)
      if (note.find("built ") != std::string::npos) return note.substr(note.find("built "));
    return std::string();
  };
  EXPECT_EQ(told(7), "built 7 for img.7.3.png");
  EXPECT_EQ(told(-3), "built -3 for img.-3.-2.png");
  EXPECT_EQ(told(0), "built 0 for img.0.0.png");
  EXPECT_EQ(told(7.5), "built 7.5 for img.7.5.3.0.png");
  EXPECT_EQ(told(1e10), "built 10000000000.0 for img.10000000000.0.5000000000.0.png");
}

}  // namespace
}  // namespace afterglow::test
