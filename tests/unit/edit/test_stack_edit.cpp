// SPDX-License-Identifier: MIT
// Effects that are added to a preset's text, taken out, copied and moved: what the text looks like afterwards, what
// stays, what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file.h"
#include "edit/stack_edit.h"
#include "scene.h"

namespace afterglow::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using Kind = StackEdit::Kind;

class StackEditing : public ::testing::Test {
 protected:
  StackEditing() {
    const std::string rest =
        "settings = { amount = fx.float { default = 0.5 } }, build = function(g, s, source) return source end";
    scene.effect("glow", "at = \"post_process\", order = 100, " + rest);
    scene.effect("grade", "at = \"post_process\", order = 100, " + rest);
    scene.effect("curve_of", "at = \"post_process\", order = 200, " + rest);
    scene.effect("lines", "at = \"before_post_process\", " + rest);
  }
  std::string file() const { return (scene.folder() / "preset.lua").string(); }
  Result<StackRewrite> rewrite(const std::string& text, const StackEdit& edit) {
    return rewrite_stack(scene.folder() / "preset.lua", text, edit, scene.options);
  }
  std::string edited(const std::string& text, const StackEdit& edit) {
    const auto out = rewrite(text, edit);
    return out ? out->text : scene.shorten(out.error().text());
  }
  /// The same for what stands inside a stack.
  std::string inside(const std::string& entries, const StackEdit& edit) {
    const std::string text = edited(head + entries + tail, edit);
    if (!text.starts_with(head) || !text.ends_with(tail)) return text;
    return text.substr(head.size(), text.size() - head.size() - tail.size());
  }

  const std::string head = "local fx = require \"afterglow\"\nreturn fx.stack {", tail = "}\n";
  Scene scene;
};

TEST_F(StackEditing, AnEffectThatCannotBeAddedNamesNoLineOfTheFile) {
  const auto out = rewrite(head + "}\n", {Kind::add, "nothing_like_it"});
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().line, 0);
  EXPECT_THAT(out.error().message, HasSubstr("nothing_like_it"));
}

TEST_F(StackEditing, AddsWhereItRuns) {
  EXPECT_EQ(inside("\n  fx.glow { amount = 1 }, -- mine\n  fx.curve_of {},\n", {Kind::add, "grade"}),
            "\n  fx.glow { amount = 1 }, -- mine\n  fx.grade {},\n  fx.curve_of {},\n");
  EXPECT_EQ(inside("\n  fx.glow {},\n  fx.curve_of {}\n", {Kind::add, "curve_of"}),
            "\n  fx.glow {},\n  fx.curve_of {},\n  fx.curve_of {}\n");
  EXPECT_EQ(inside(" fx.glow {}, fx.curve_of {} ", {Kind::add, "grade"}), " fx.glow {}, fx.grade {}, fx.curve_of {} ");
  EXPECT_EQ(inside(" fx.curve_of {}; name = 'x' ", {Kind::add, "curve_of"}),
            " fx.curve_of {}; fx.curve_of {}; name = 'x' ");
  EXPECT_EQ(inside("", {Kind::add, "glow"}), " fx.glow {} ");
  EXPECT_EQ(inside("\n  name = [[a } b]],\n", {Kind::add, "glow"}), "\n  name = [[a } b]],\n  fx.glow {},\n");
  const auto out = rewrite(head + "fx.glow { amount = 1 }" + tail, {Kind::add, "glow"});
  ASSERT_TRUE(out);
  EXPECT_EQ(out->entry, "glow#2");
  EXPECT_EQ(out->line, 2);
}

TEST_F(StackEditing, AddsIntoListsThatAreNotTheStacksOwn) {
  const std::string text =
      "local f = require('afterglow')\nlocal list = {\n\tf.glow {}, --[[ two\n lines ]]\n}\nreturn f.stack(list)\n";
  EXPECT_EQ(
      edited(text, {Kind::add, "curve_of"}),
      "local f = require('afterglow')\nlocal list = {\n\tf.glow {}, --[[ two\n lines ]]\n\tf.curve_of {},\n}\nreturn "
      "f.stack(list)\n");
  scene.write("base.lua", head + " fx.glow {} " + tail);
  EXPECT_EQ(edited("local fx = require \"afterglow\"\nreturn fx.extend(\"base\", { glow = { amount = 2 } })\n",
                   {Kind::add, "grade"}),
            "local fx = require \"afterglow\"\nreturn fx.extend(\"base\", { glow = { amount = 2 }, fx.grade {} })\n");
}

TEST_F(StackEditing, KeepsCarriageReturns) {
  const std::string begin = "local fx = require 'afterglow'\r\nreturn fx.stack {\r\n", end = "}\r\n";
  EXPECT_EQ(edited(begin + "  fx.glow {},  -- a\r\n" + end, {Kind::add, "grade"}),
            begin + "  fx.glow {},  -- a\r\n  fx.grade {},\r\n" + end);
  EXPECT_EQ(edited(begin + "  fx.glow {},  -- a\r\n  -- over it\r\n  fx.grade {}\r\n" + end, {Kind::remove, "glow"}),
            begin + "  -- over it\r\n  fx.grade {}\r\n" + end);
  EXPECT_EQ(edited(begin + "  -- a\r\n  fx.glow {},\r\n  fx.grade {}\r\n" + end, {Kind::later, "glow"}),
            begin + "  fx.grade {},\r\n  -- a\r\n  fx.glow {}\r\n" + end);
}

TEST_F(StackEditing, MovesEntriesBehindPartsThatAreCommentedOut) {
  EXPECT_EQ(inside("\n  fx.glow {},\n  --[[\n  fx.glare {},\n  --]]\n  -- colour\n  fx.grade {},\n",
                   {Kind::earlier, "grade"}),
            "\n  -- colour\n  fx.grade {},\n  --[[\n  fx.glare {},\n  --]]\n  fx.glow {},\n");
}

TEST_F(StackEditing, RemovesAnEntryWithItsLinesAndNothingElse) {
  const std::string entries =
      "\n  name = \"x\",\n  -- light\n  fx.glow { amount = 1,  -- inside\n    },  -- behind\n  -- colour\n  fx.grade "
      "{}\n";
  EXPECT_EQ(inside(entries, {Kind::remove, "glow"}), "\n  name = \"x\",\n  -- light\n  -- colour\n  fx.grade {}\n");
  EXPECT_EQ(inside(entries, {Kind::remove, "grade"}),
            "\n  name = \"x\",\n  -- light\n  fx.glow { amount = 1,  -- inside\n    }  -- behind\n  -- colour\n");
  EXPECT_EQ(inside(" fx.glow {}, fx.grade {}, fx.curve_of {} ", {Kind::remove, "glow"}),
            " fx.grade {}, fx.curve_of {} ");
  EXPECT_EQ(inside(" fx.glow {}, fx.grade {}, fx.curve_of {} ", {Kind::remove, "grade"}),
            " fx.glow {}, fx.curve_of {} ");
  EXPECT_EQ(inside(" fx.glow {}, fx.grade {}, fx.curve_of {} ", {Kind::remove, "curve_of"}),
            " fx.glow {}, fx.grade {} ");
  EXPECT_EQ(inside(" fx.glow {}, --[[ c ]] fx.grade {}, ", {Kind::remove, "grade"}), " fx.glow {}, --[[ c ]] ");
  EXPECT_EQ(inside(" fx.glow {} ", {Kind::remove, "glow"}), "");
  // The one that is meant, of several that look alike.
  EXPECT_EQ(
      inside(" fx.glow { amount = 1 }, fx.glow { amount = 2 }, fx.glow { amount = 3 } ", {Kind::remove, "glow#2"}),
      " fx.glow { amount = 1 }, fx.glow { amount = 3 } ");
  EXPECT_EQ(
      inside("\n  fx.group { opacity = 0.5, fx.glow {}, fx.grade {} },\n  fx.curve_of {},\n", {Kind::remove, "grade"}),
      "\n  fx.group { opacity = 0.5, fx.glow {} },\n  fx.curve_of {},\n");
  EXPECT_EQ(inside("\n  fx.group { fx.glow {},\n    fx.grade {} },\n  fx.curve_of {},\n", {Kind::remove, "group"}),
            "\n  fx.curve_of {},\n");
}

TEST_F(StackEditing, CopiesAnEntryAndGivesItANameOfItsOwn) {
  EXPECT_EQ(inside("\n  fx.glow { amount = 1, -- two\n    name = \"lamp\" }, -- c\n  fx.grade {},\n",
                   {Kind::duplicate, "lamp"}),
            "\n  fx.glow { amount = 1, -- two\n    name = \"lamp\" }, -- c\n  fx.glow { amount = 1 -- two\n    },\n  "
            "fx.grade {},\n");
  const auto out = rewrite(head + " fx.glow { amount = 1 }, fx.glow { amount = 2 } " + tail, {Kind::duplicate, "glow"});
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_EQ(out->text, head + " fx.glow { amount = 1 }, fx.glow { amount = 1 }, fx.glow { amount = 2 } " + tail);
  EXPECT_EQ(out->entry, "glow#2");
  EXPECT_THAT(out->renamed, ::testing::ElementsAre(std::pair<std::string, std::string>("glow", "glow"),
                                                   std::pair<std::string, std::string>("glow#2", "glow#3")));
}

TEST_F(StackEditing, MovesWithinAnInjectionPoint) {
  EXPECT_EQ(inside("\n  -- light\n  fx.glow { amount = 1 },  -- a\n\n  -- colour\n  fx.grade {}  -- b\n",
                   {Kind::later, "glow"}),
            "\n  -- colour\n  fx.grade {},  -- b\n\n  -- light\n  fx.glow { amount = 1 }  -- a\n");
  EXPECT_EQ(inside(" fx.glow { amount = 1 }, name = 'x', fx.grade {} ", {Kind::earlier, "grade"}),
            " fx.grade {}, name = 'x', fx.glow { amount = 1 } ");
  // Another order takes a key, and back again takes it away.
  const std::string later = inside("\n  fx.glow {},\n  fx.curve_of {},\n", {Kind::later, "glow"});
  EXPECT_EQ(later, "\n  fx.curve_of {},\n  fx.glow { order = 200 },\n");
  EXPECT_EQ(inside(later, {Kind::earlier, "glow"}), "\n  fx.curve_of {},\n  fx.glow {},\n");
  EXPECT_THAT(inside(" fx.lines {}, fx.glow {} ", {Kind::earlier, "glow"}),
              HasSubstr("glow runs at post_process, and lines at before_post_process"));
  EXPECT_THAT(inside(" fx.glow {} ", {Kind::later, "glow"}), HasSubstr("glow is the last already"));
  EXPECT_EQ(inside(" fx.group { fx.glow {}, fx.grade {} }, fx.grade { amount = 2 } ", {Kind::later, "grade"}),
            "error: grade is the last already");
}

TEST_F(StackEditing, MasksComeAndGo) {
  const std::string entries = "\n  fx.glow { amount = 1 },  -- a\n";
  const std::string masked = inside(entries, {Kind::mask, "glow", "luma"});
  EXPECT_EQ(masked, "\n  fx.glow { amount = 1, mask = fx.mask.luma {} },  -- a\n");
  EXPECT_EQ(inside(masked, {Kind::mask, "glow", ""}), entries);
  EXPECT_THAT(inside(masked, {Kind::mask, "glow", "radial"}),
              HasSubstr("glow has a mask: luma; remove that one first"));
  EXPECT_THAT(inside(entries, {Kind::mask, "glow", "lumma"}), HasSubstr("luma"));
}

TEST_F(StackEditing, WhatIsComputedStaysAndIsTold) {
  const std::string loop =
      "local fx = require \"afterglow\"\nlocal list = {}\nfor i = 1, 3 do list[i] = fx.glow { amount = i } end\nreturn "
      "fx.stack(list)\n";
  EXPECT_EQ(edited(loop, {Kind::remove, "glow#2"}),
            "preset.lua:3: error: glow#2 is no item of a list that is written out: the script makes it");
  EXPECT_THAT(edited(loop, {Kind::later, "glow"}), StartsWith("preset.lua:3: error: "));
  EXPECT_EQ(edited(loop, {Kind::add, "grade"}),
            "preset.lua: error: no list of effects is written out in this file: the script makes the stack");
  scene.write("base.lua", head + " fx.glow {} " + tail);
  EXPECT_THAT(
      edited("local fx = require \"afterglow\"\nreturn fx.extend(\"base\", { fx.grade {} })\n", {Kind::remove, "glow"}),
      StartsWith("base.lua:2: error: glow: the entry is made here, not in "));
  EXPECT_THAT(inside(" fx.glow { order = 50 + 50 }, fx.curve_of {} ", {Kind::later, "glow"}),
              HasSubstr("glow.order is computed"));
  EXPECT_THAT(inside(" fx.glow {} ", {Kind::remove, "glov"}), HasSubstr("did you mean 'glow'?"));
  EXPECT_THAT(inside(" fx.glow {} ", {Kind::add, "glov"}), HasSubstr("did you mean 'glow'?"));
  // What others of the script say about an entry would be an error without it.
  EXPECT_THAT(
      inside(" fx.glow {}, fx.grade {}, fx.volume { settings = { glow = { amount = 1 } } } ", {Kind::remove, "glow"}),
      HasSubstr("glow"));
}

TEST_F(StackEditing, VariablesAndConditionsAreItemsToo) {
  EXPECT_EQ(edited("local fx = require \"afterglow\"\nlocal g = fx.glow {}\nreturn fx.stack { g, fx.grade {} }\n",
                   {Kind::remove, "glow"}),
            "local fx = require \"afterglow\"\nlocal g = fx.glow {}\nreturn fx.stack { fx.grade {} }\n");
  EXPECT_EQ(inside(" true and fx.glow {}, fx.grade {} ", {Kind::later, "glow"}), " fx.grade {}, true and fx.glow {} ");
}

/// Every look that comes with the program: what is added and removed again leaves no trace, and so does a copy.
TEST(StackEditOfPresets, AddedAndRemovedIsByteForByteTheSame) {
  const std::filesystem::path project = AFTERGLOW_PROJECT_FOLDER;
  PresetOptions options;
  options.installation = project;
  int presets = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(project / "presets")) {
    if (file.path().extension() != ".lua" || file.path().parent_path().filename() == "effects") continue;
    ++presets;
    const std::string text = read_file(file.path()).value();
    for (const char* effect : {"lift_gamma_gain", "exposure", "fxaa", "pixelate"}) {
      const auto added = rewrite_stack(file.path(), text, {Kind::add, effect}, options);
      ASSERT_TRUE(added) << added.error().text();
      EXPECT_EQ(added->text.size(), text.size() + std::string(effect).size() + 10) << "a line more: " << added->text;
      const auto removed = rewrite_stack(file.path(), added->text, {Kind::remove, added->entry}, options);
      ASSERT_TRUE(removed) << removed.error().text();
      EXPECT_EQ(removed->text, text) << file.path();
      const auto copied = rewrite_stack(file.path(), added->text, {Kind::duplicate, added->entry}, options);
      ASSERT_TRUE(copied) << copied.error().text();
      const auto once = rewrite_stack(file.path(), copied->text, {Kind::remove, copied->entry}, options);
      ASSERT_TRUE(once) << once.error().text();
      EXPECT_EQ(once->text, added->text) << file.path();
    }
  }
  EXPECT_GE(presets, 24);
}

}  // namespace
}  // namespace afterglow::test
