// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "play/setting_edits.h"

namespace afterglow {
namespace {

SettingValue number(double value) { return {SettingType::number, {value}, ""}; }

TEST(SettingEdits, ADragIsOneStepOfUndo) {
  SettingEdits edits;
  for (const double value : {0.1, 0.2, 0.3}) edits.set("glow", "strength", number(value));
  edits.set("glow", "radius", number(4));
  EXPECT_EQ(edits.value("glow", "strength"), number(0.3));
  ASSERT_TRUE(edits.undo());
  EXPECT_EQ(edits.value("glow", "radius"), std::nullopt);
  EXPECT_EQ(edits.value("glow", "strength"), number(0.3));
  ASSERT_TRUE(edits.undo());
  EXPECT_TRUE(edits.edits().empty());
  EXPECT_FALSE(edits.undo());
  ASSERT_TRUE(edits.redo());
  EXPECT_EQ(edits.value("glow", "strength"), number(0.3));
}

TEST(SettingEdits, WhatIsTakenBackCannotBeDoneAgain) {
  SettingEdits edits;
  EXPECT_FALSE(edits.take_back());
  edits.set("glow", "radius", number(4));
  edits.set("glow", "strength", number(0.1));
  ASSERT_TRUE(edits.take_back());
  EXPECT_EQ(edits.value("glow", "strength"), std::nullopt);
  EXPECT_EQ(edits.value("glow", "radius"), number(4));
  EXPECT_FALSE(edits.can_redo());
}

TEST(SettingEdits, SnapshotsAreBroughtBackAsOneStep) {
  SettingEdits edits;
  EXPECT_FALSE(edits.has(0));
  EXPECT_FALSE(edits.recall(0)) << "nothing was kept";
  edits.set("glow", "strength", number(0.1));
  edits.keep(0);
  edits.set("glow", "strength", number(0.5));
  edits.set_stack({std::make_shared<const std::string>("changed"), {{"glow", "glow"}}, "", ""});
  edits.keep(1);
  ASSERT_TRUE(edits.recall(0));
  EXPECT_EQ(edits.value("glow", "strength"), number(0.1));
  EXPECT_FALSE(edits.stack_text());
  EXPECT_FALSE(edits.recall(0)) << "it is so already";
  ASSERT_TRUE(edits.recall(1));
  EXPECT_EQ(*edits.stack_text(), "changed");
  EXPECT_EQ(edits.value("glow", "strength"), number(0.5));
  ASSERT_TRUE(edits.undo());
  EXPECT_EQ(edits.value("glow", "strength"), number(0.1)) << "undo goes back over it";
}

/// A save does not change what a snapshot shows.
TEST(SettingEdits, SnapshotsStayWhatTheyWereOverASave) {
  SettingEdits edits;
  edits.keep(0);
  edits.set("glow", "strength", number(0.5));
  edits.keep(1);
  edits.rebase({{"glow", "strength", number(0.1), number(0.5)}});
  EXPECT_TRUE(edits.none()) << "it is in the file";
  ASSERT_TRUE(edits.recall(0));
  EXPECT_EQ(edits.value("glow", "strength"), number(0.1));
  ASSERT_TRUE(edits.recall(1));
  EXPECT_TRUE(edits.none());
}

TEST(SettingEdits, GesturesEndWhereTheyAreSaidTo) {
  SettingEdits edits;
  edits.set("glow", "strength", number(0.1));
  edits.end_gesture();
  edits.set("glow", "strength", number(0.2));
  ASSERT_TRUE(edits.undo());
  EXPECT_EQ(edits.value("glow", "strength"), number(0.1));
}

TEST(SettingEdits, AChangeAfterUndoForgetsWhatWasUndone) {
  SettingEdits edits;
  edits.set("glow", "strength", number(0.1));
  edits.set("glow", "radius", number(4));
  edits.undo();
  edits.set("glow", "strength", number(0.5));
  EXPECT_FALSE(edits.can_redo());
  ASSERT_TRUE(edits.undo());
  EXPECT_EQ(edits.value("glow", "strength"), number(0.1)) << "undo ends the gesture before it";
}

TEST(SettingEdits, ResetTakesAwayAndCanBeUndone) {
  SettingEdits edits;
  edits.set("glow", "strength", number(0.1));
  edits.set("glow#2", "strength", number(0.2));
  EXPECT_FALSE(edits.reset("glow", "radius"));
  EXPECT_TRUE(edits.reset("glow", "strength"));
  EXPECT_EQ(edits.edits().size(), 1u);
  edits.undo();
  EXPECT_TRUE(edits.reset("glow#2", "strength"));
  EXPECT_TRUE(edits.reset_all());
  EXPECT_FALSE(edits.reset_all());
  edits.undo();
  edits.undo();
  EXPECT_EQ(edits.edits().size(), 2u);
}

TEST(SettingEdits, StandOverThoseOfTheCommandLine) {
  SettingEdits edits;
  edits.set("glow", "strength", number(0.25));
  edits.set("glow", "tint", {SettingType::color, {1, 0.5, 0}, ""});
  const auto all = edits.overrides({{"glow", "strength", "0.7"}});
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].value, "0.7");
  EXPECT_EQ(all[1].value, "0.25");
  EXPECT_EQ(all[2].value, "{1, 0.5, 0}");
}

TEST(SettingEdits, ArgumentsAreNoSettings) {
  SettingEdits edits;
  edits.set("", "strength", number(0.25));
  edits.set("glow", "strength", number(0.5));
  EXPECT_EQ(edits.overrides({}).size(), 1u);
  const auto arguments = edits.arguments({{"strength", "0.7"}});
  ASSERT_EQ(arguments.size(), 2u);
  EXPECT_EQ(arguments[1].name, "strength");
  EXPECT_EQ(arguments[1].value, "0.25");
}

/// Saving moves edits into the preset; every step of the history still shows what it showed.
TEST(SettingEdits, SavingKeepsTheHistory) {
  const auto number = [](double value) { return SettingValue{SettingType::number, {value}, ""}; };
  SettingEdits edits;
  edits.set("glow", "knee", number(0.3));
  edits.end_gesture();
  edits.set("glow", "intensity", number(1));
  edits.end_gesture();
  edits.set("glow", "knee", number(0.7));
  edits.rebase({{"glow", "knee", number(0.5), number(0.7)}, {"glow", "intensity", number(0), number(1)}});
  EXPECT_TRUE(edits.edits().empty()) << "the preset says it all";
  ASSERT_TRUE(edits.undo());
  EXPECT_EQ(edits.value("glow", "knee"), number(0.3));
  EXPECT_FALSE(edits.value("glow", "intensity")) << "1, as the preset says now";
  ASSERT_TRUE(edits.undo());
  EXPECT_EQ(edits.value("glow", "knee"), number(0.3));
  EXPECT_EQ(edits.value("glow", "intensity"), number(0)) << "as the preset said before";
  ASSERT_TRUE(edits.undo());
  EXPECT_EQ(edits.value("glow", "knee"), number(0.5));
  EXPECT_FALSE(edits.can_undo());
  // The save is taken back: the other way round.
  edits.rebase({{"glow", "knee", number(0.7), number(0.5)}, {"glow", "intensity", number(1), number(0)}});
  EXPECT_TRUE(edits.edits().empty());
  while (edits.redo()) {
  }
  EXPECT_EQ(edits.value("glow", "knee"), number(0.7));
  EXPECT_EQ(edits.value("glow", "intensity"), number(1));
}

StackText text_of(const char* text) { return std::make_shared<const std::string>(text); }

TEST(SettingEdits, StacksAreStepsAndSettingsFollowTheirEntries) {
  SettingEdits edits;
  edits.set("glow", "knee", number(0.1));
  edits.set("glow#2", "knee", number(0.2));
  edits.set("", "strength", number(3));
  edits.set_stack({text_of("without the first"), {{"glow#2", "glow"}}, "", ""});
  EXPECT_EQ(*edits.stack_text(), "without the first");
  EXPECT_EQ(edits.value("glow", "knee"), number(0.2));
  EXPECT_FALSE(edits.value("glow#2", "knee"));
  EXPECT_TRUE(edits.value("", "strength"));
  edits.set_stack({text_of("twice"), {{"glow", "glow"}}, "glow", "glow#2"});
  EXPECT_EQ(edits.value("glow#2", "knee"), number(0.2));
  ASSERT_TRUE(edits.undo());
  ASSERT_TRUE(edits.undo());
  EXPECT_FALSE(edits.stack_text());
  EXPECT_EQ(edits.value("glow", "knee"), number(0.1));
  ASSERT_TRUE(edits.redo());
  EXPECT_TRUE(edits.reset_stack());
  EXPECT_FALSE(edits.reset_stack());
  EXPECT_EQ(edits.value("glow", "knee"), number(0.2));
  EXPECT_TRUE(edits.reset_all());
  EXPECT_TRUE(edits.none());
}

TEST(SettingEdits, SavingAStackKeepsTheHistory) {
  SettingEdits edits;
  edits.set("glow", "knee", number(0.1));
  edits.set_stack({text_of("B"), {{"glow", "glow"}}, "", ""});
  const StackText saved = edits.stack_text();
  edits.set("glow", "knee", number(0.7));
  edits.rebase({{"glow", "knee", number(0.5), number(0.7)}}, {"A", "B with 0.7", saved});
  EXPECT_TRUE(edits.none()) << "the file says it all";
  ASSERT_TRUE(edits.undo());
  EXPECT_FALSE(edits.stack_text()) << "the stack of the file";
  EXPECT_EQ(edits.value("glow", "knee"), number(0.1));
  ASSERT_TRUE(edits.undo());
  EXPECT_EQ(*edits.stack_text(), "A") << "as the file was";
  EXPECT_EQ(edits.value("glow", "knee"), number(0.1));
  ASSERT_TRUE(edits.undo());
  EXPECT_EQ(*edits.stack_text(), "A");
  EXPECT_TRUE(edits.edits().empty());
  // The save is taken back.
  edits.rebase({}, {"B with 0.7", "A", nullptr});
  EXPECT_TRUE(edits.none());
  while (edits.redo()) {
  }
  EXPECT_EQ(*edits.stack_text(), "B with 0.7");
}

}  // namespace
}  // namespace afterglow
