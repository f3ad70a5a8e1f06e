// SPDX-License-Identifier: MIT
// A player follows what is edited: files, arguments, stacks, another look, another sequence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "player_test.h"

namespace afterglow {
namespace {

using ::testing::HasSubstr;

TEST_F(PlayerTest, AnEditOnDiskKeepsPositionZoomAndOverrides) {
  write_sequence(6);
  Player& player = open();
  turn();
  player.transport().play(seconds_);
  player.view().fit = false;
  player.view().zoom = 3;
  player.set("color_adjustments", "color_filter", {SettingType::color, {0.5, 1, 1}, ""});
  seconds_ += 0.2;
  turn();
  EXPECT_EQ(player.shown().number, 3);
  EXPECT_FLOAT_EQ(result(), 3.0f / 8 * 2 * 0.5f) << "the panel's filter, the preset's exposure";
  write_look("look.lua", 3);
  const Step step = reload();
  EXPECT_TRUE(step.reloaded);
  EXPECT_TRUE(step.changed);
  EXPECT_EQ(player.shown().number, 3);
  EXPECT_TRUE(player.transport().playing());
  EXPECT_EQ(player.view().zoom, 3);
  EXPECT_FLOAT_EQ(result(), 3.0f / 8 * 8 * 0.5f);
  ASSERT_TRUE(player.undo());
  turn();
  EXPECT_FLOAT_EQ(result(), 3.0f / 8 * 8);
}

TEST_F(PlayerTest, ArgumentsAndCompositionAreChangedWhilePlaying) {
  write_sequence(2);
  const auto look = [&](const std::string& arguments) {
    write("look.lua", "local fx = require \"afterglow\"\nlocal args = fx.args { " + arguments +
                          " }\nreturn fx.stack { fx.color_adjustments { post_exposure = args.stops or 0 } }\n");
  };
  look("stops = fx.float { min = 0, max = 4, default = 1 }");
  PlayerOptions options;
  options.live.stack.preset.arguments = {{"stops", "2"}};
  Player& player = open(options);
  turn();
  EXPECT_FLOAT_EQ(result(), 4.0f / 8);
  player.set("", "stops", {SettingType::number, {3}, ""});
  turn();
  EXPECT_FLOAT_EQ(result(), 8.0f / 8);
  player.set("color_adjustments", "opacity", {SettingType::number, {0.5}, ""});
  turn();
  EXPECT_FLOAT_EQ(result(), 4.5f / 8);
  ASSERT_TRUE(player.undo());
  ASSERT_TRUE(player.undo());
  turn();
  EXPECT_FLOAT_EQ(result(), 4.0f / 8) << "the command line's again";
  // A look that does not declare it any more plays on.
  ASSERT_TRUE(player.redo());
  look("stops = fx.float { min = 0, max = 1, default = 0 }");
  reload();
  EXPECT_FLOAT_EQ(result(), 1.0f / 8);
  EXPECT_THAT(player.live().status().warnings, ::testing::Contains(HasSubstr("--arg stops = 3 is out of range")));
}

/// What was written counts from then on, not what the command line says of the same setting; undo goes back over it.
TEST_F(PlayerTest, WhatIsSavedTakesThePlaceOfSet) {
  write_sequence(2);
  write("look.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.color_adjustments { post_exposure = 1 }, "
        "fx.color_adjustments { post_exposure = 0 } }\n");
  PlayerOptions options;
  options.live.stack.preset.overrides = {{"color_adjustments#2", "post_exposure", "0.5"},
                                         {"color_adjustments", "post_exposure", "2"}};
  Player& player = open(options);
  turn();
  EXPECT_FLOAT_EQ(result(), std::exp2(2.5f) / 8);
  player.set("color_adjustments", "post_exposure", {SettingType::number, {3}, ""});
  turn();
  EXPECT_FLOAT_EQ(result(), std::exp2(3.5f) / 8);
  write("look.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.color_adjustments { post_exposure = 3 }, "
        "fx.color_adjustments { post_exposure = 0 } }\n");
  player.rebase(
      {{"color_adjustments", "post_exposure", {SettingType::number, {1}, ""}, {SettingType::number, {3}, ""}}});
  reload();
  EXPECT_TRUE(player.edits().none());
  EXPECT_FLOAT_EQ(result(), std::exp2(3.5f) / 8) << "the file's, and the other entry's of the command line";
  ASSERT_TRUE(player.undo());
  turn();
  EXPECT_FLOAT_EQ(result(), std::exp2(2.5f) / 8) << "as it was on screen";
}

TEST_F(PlayerTest, AnErrorKeepsTheLastPictureUntilTheNextGoodSave) {
  write_sequence(2);
  Player& player = open();
  turn();
  const float before = result();
  write("look.lua", "return fx.nonsense {\n");
  reload();
  ASSERT_TRUE(player.live().status().error);
  EXPECT_THAT(player.live().status().error->text(), HasSubstr("look.lua:"));
  EXPECT_EQ(result(), before);
  player.transport().play(seconds_);
  seconds_ += 0.1;
  EXPECT_TRUE(turn().changed) << "playing goes on with the last good stack";
  EXPECT_FLOAT_EQ(result(), 0.5f);
  write_look("look.lua", 0);
  reload();
  EXPECT_FALSE(player.live().status().error);
  EXPECT_FLOAT_EQ(result(), 0.25f);
}

TEST_F(PlayerTest, APresetThatComesLaterShowsTheSourceUntilThen) {
  write_sequence(1);
  PlayerOptions options;
  options.preset = path("later.lua");
  Player& player = open(options);
  turn();
  EXPECT_TRUE(player.live().status().error);
  EXPECT_FLOAT_EQ(result(), 0.125f);
  write_look("later.lua", 2);
  reload();
  EXPECT_FLOAT_EQ(result(), 0.5f);
}

TEST_F(PlayerTest, ComparesTwoPresets) {
  write_sequence(2);
  write_look("other.lua", 2);
  PlayerOptions options;
  options.other_preset = path("other.lua");
  Player& player = open(options);
  turn();
  EXPECT_FALSE(player.images().other) << "not run until it is looked at";
  player.view().compare = Compare::other;
  EXPECT_TRUE(turn().changed);
  ASSERT_TRUE(player.images().other);
  const auto probe = player.probe({0, 0}).value();
  EXPECT_FLOAT_EQ(probe->result[0], 0.25f);
  EXPECT_FLOAT_EQ((*probe->other)[0], 0.5f);
  EXPECT_EQ(player.scopes({}, Player::Of::other).value().most[0], 0.5f);
}

TEST_F(PlayerTest, EditsAreMeasuredFromNoticeToPresent) {
  write_sequence(1);
  Player& player = open();
  turn();
  EXPECT_TRUE(player.stats().latencies.empty() || player.stats().latencies.size() == 1);
  const auto before = player.stats().latencies.size();
  write_look("look.lua", 2);
  reload();
  seconds_ += 0.007;
  player.presented();
  const auto latencies = player.stats().latencies;
  ASSERT_EQ(latencies.size(), before + 1);
  EXPECT_EQ(latencies.back().build.kind, BuildTimes::Kind::values);
  EXPECT_NEAR(latencies.back().present, 7, 1e-6);
  EXPECT_GT(latencies.back().execute, 0);
  player.presented();
  EXPECT_NEAR(player.stats().latencies.back().present, 7, 1e-6) << "once";
}

TEST_F(PlayerTest, PlaysSomethingElse) {
  write_sequence(2);
  Player& player = open();
  turn();
  EXPECT_FALSE(player.open_footage({path("none.#.exr")}));
  EXPECT_EQ(player.footage().frames(), 2);
  ASSERT_TRUE(player.open_footage({path("s.2.exr")}));
  turn();
  EXPECT_EQ(player.shown().name, "s.2.exr");
  EXPECT_FLOAT_EQ(result(), 0.5f);
  write_look("new.lua", 0);
  ASSERT_TRUE(player.open_preset(path("new.lua")));
  turn();
  EXPECT_FLOAT_EQ(result(), 0.25f);
}

/// Readers of the footage before end by themselves; what they bring is nobody's any more.
TEST_F(PlayerTest, FootageOpenedInTurnsIsTheLastOne) {
  write_sequence(6);
  Player& player = open();
  for (int i = 0; i < 60; ++i) {
    const int number = i * 5 % 6 + 1;
    ASSERT_TRUE(player.open_footage({path("s." + std::to_string(number) + ".exr")}));
    if (i % 7 != 6) continue;
    turn();
    EXPECT_EQ(source(), static_cast<float>(number) / 8) << i;
    EXPECT_EQ(player.stats().unreadable, 0) << i;
  }
}

/// An edit may ask for an input that no look has asked for: pictures are read anew with it before anybody judges.
class PlayerInputs : public PlayerTest {
 protected:
  void write_fog(const std::string& name, const std::string& more) {
    write(name,
          "local fx = require \"afterglow\"\nreturn fx.stack { fx.depth_fog { density = 100, start = 0, color = { 8, "
          "8, 8 }" +
              more + " } }\n");
  }
  Player& open_with_depth() {
    write_sequence(2);
    fs::copy_file(path("s.2.exr"), path("depth.exr"));
    PlayerOptions options;
    options.footage.read.depth.file = path("depth.exr");
    return open(options);
  }
  void expect_fog() {
    EXPECT_EQ(player_->live().status().error_text(), "");
    EXPECT_THAT(warnings_, ::testing::IsEmpty());
    EXPECT_GT(result(), source() + 0.5f);
  }
};

TEST_F(PlayerInputs, AnEditMayAskForMore) {
  for (const std::string more : {"", ", required = true"}) {
    Player& player = open_with_depth();
    turn();
    EXPECT_FLOAT_EQ(result(), 2.0f / 8);
    write_fog("look.lua", more);
    reload();
    turn();
    expect_fog();
    EXPECT_EQ(player.shown().number, 1);
    EXPECT_FALSE(player.shown().failed);
    write_look("look.lua", 1);
    reload();
    EXPECT_FLOAT_EQ(result(), 2.0f / 8);
    player_.reset();
    fs::remove(path("depth.exr"));
  }
}

TEST_F(PlayerInputs, ListsOfLooksMayReadThemAside) {
  Player& player = open_with_depth();
  turn();
  const auto read = player.reader_with_inputs();
  ASSERT_TRUE(read);
  player_.reset();
  const auto picture = read();
  ASSERT_TRUE(picture) << picture.error().text();
  EXPECT_EQ(picture->auxiliary.count("depth"), 1u);
  EXPECT_EQ(picture->asked.size(), 3u);
}

TEST_F(PlayerInputs, AnotherPresetMayAskForMore) {
  Player& player = open_with_depth();
  turn();
  write_fog("fog.lua", ", required = true");
  ASSERT_TRUE(player.open_preset(path("fog.lua")).ok());
  for (int i = 0; i < 3; ++i) {
    turn();
    EXPECT_FALSE(player.shown().failed);
  }
  expect_fog();
}

TEST_F(PlayerInputs, WhatPicturesDoNotHaveIsSaidOnceTheyWereRead) {
  write_sequence(2);
  open();
  turn();
  write_fog("look.lua", ", required = true");
  reload();
  for (int i = 0; i < 3; ++i) turn();
  EXPECT_THAT(player_->live().status().error_text(), HasSubstr("'depth_fog' is required, but there is no depth input"));
  EXPECT_FLOAT_EQ(result(), 2.0f / 8) << "the last good one plays on";
  write_fog("look.lua", "");
  reload();
  for (int i = 0; i < 3; ++i) turn();
  EXPECT_EQ(player_->live().status().error_text(), "");
  EXPECT_THAT(warnings_, ::testing::Contains(HasSubstr("no depth input")));
  EXPECT_FLOAT_EQ(result(), 1.0f / 8);
}

}  // namespace
}  // namespace afterglow
