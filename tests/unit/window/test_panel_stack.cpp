// SPDX-License-Identifier: MIT
// The panel: the stack of entries, and what is saved of both.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file.h"
#include "panel_test.h"

namespace afterglow::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(PanelTest, TheStackIsEditedAndSaved) {
  Ui& ui = interface.ui();
  const auto done = [&] {
    frame();
    panel->stack().wait();
    frame();
    EXPECT_FALSE(panel->stack().failed()) << panel->stack().message();
    port->reload();
    frame();
  };
  port->changes.set("bloom", "intensity", {SettingType::number, {0.5}, ""});
  panel->choose_next(ui, *port, 1);
  EXPECT_EQ(panel->chosen(), "bloom");
  panel->act(ui, *port, Panel::EntryAction::duplicate);
  done();
  EXPECT_EQ(panel->chosen(), "bloom#2");
  EXPECT_EQ(edited("bloom#2", "intensity").number[0], 0.5) << "the copy has what was changed in the panel";
  EXPECT_EQ(*read_file(file), kPreset) << "not before Save";
  EXPECT_EQ(panel->unsaved(*port), "the stack and 2 settings of look.lua");
  port->set("bloom#2", "intensity", {SettingType::number, {0.25}, ""});
  panel->choose_next(ui, *port, -1);
  panel->act(ui, *port, Panel::EntryAction::remove);
  done();
  EXPECT_EQ(edited("bloom", "intensity").number[0], 0.25) << "what was bloom#2 is called bloom now";
  panel->act(ui, *port, Panel::EntryAction::later);
  done();
  panel->save(*port);
  panel->saving().wait();
  frame();
  const std::string text = *read_file(file);
  EXPECT_THAT(text, HasSubstr("  fx.tone_mapping { mode = \"aces\" },\n"));
  EXPECT_THAT(text, HasSubstr("fx.bloom { intensity = 0.25, order = 190 }"));
  EXPECT_TRUE(port->changes.none()) << "the file says it all";
  EXPECT_EQ(panel->unsaved(*port), "");
  // Over the save, back to where it began.
  int steps = 0;
  while (port->undo()) ++steps;
  EXPECT_EQ(steps, 5);
  ASSERT_TRUE(port->changes.stack_text());
  EXPECT_EQ(*port->changes.stack_text(), kPreset);
  port->reload();
  EXPECT_EQ(panel->unsaved(*port), "the stack of look.lua");
  while (port->redo()) {
  }
  EXPECT_TRUE(port->changes.none());
  port->reload();
  panel->undo_save(interface.ui(), *port);
  EXPECT_EQ(interface.ui().message, "look.lua is as it was before");
  frame();
  EXPECT_EQ(*read_file(file), kPreset);
  EXPECT_EQ(panel->unsaved(*port), "the stack of look.lua") << "what was saved is still on screen";
}

/// Behind it, or before it where it was the last.
TEST_F(PanelTest, WhereAnEntryIsRemovedTheNextIsChosen) {
  Ui& ui = interface.ui();
  const auto names = [&] {
    std::vector<std::string> out;
    for (const StackEntry& entry : *port->build()->entries) out.push_back(entry.name);
    return out;
  };
  const auto act = [&](Panel::EntryAction action) {
    change_stack(action);
    port->reload();
    frame();
  };
  panel->choose_next(ui, *port, 1);
  const std::string first = panel->chosen();
  act(Panel::EntryAction::duplicate);
  ASSERT_EQ(panel->chosen(), first + "#2");
  panel->choose_next(ui, *port, -1);
  act(Panel::EntryAction::remove);
  EXPECT_EQ(panel->chosen(), first) << "the second is called so now";
  while (names().size() > 1) {
    const auto before = names();
    const auto at = std::ranges::find(before, panel->chosen()) - before.begin();
    act(Panel::EntryAction::remove);
    const auto after = names();
    EXPECT_EQ(panel->chosen(), after[std::min<std::size_t>(static_cast<std::size_t>(at), after.size() - 1)]);
  }
}

TEST_F(PanelTest, WhatIsDoneToAnEntryThatIsNotBuiltYetWaits) {
  Ui& ui = interface.ui();
  panel->choose_next(ui, *port, 1);
  change_stack(Panel::EntryAction::duplicate);
  const std::string made = panel->chosen();
  EXPECT_THAT(made, ::testing::EndsWith("#2"));
  ui.message.clear();
  panel->act(ui, *port, Panel::EntryAction::toggle);
  frame();
  EXPECT_FALSE(port->changes.value(made, "enabled"));
  EXPECT_EQ(ui.message, "");
  port->reload();
  frame();
  ASSERT_TRUE(port->changes.value(made, "enabled"));
  EXPECT_EQ(port->changes.value(made, "enabled")->number[0], 0);
  EXPECT_EQ(ui.message, made + " is off");
}

TEST_F(PanelTest, StackAndFileDisagree) {
  Ui& ui = interface.ui();
  panel->choose_next(ui, *port, 1);
  change_stack(Panel::EntryAction::remove);
  std::string text = kPreset;
  text.replace(text.find("aces"), 4, "none");
  std::ofstream(file) << text;
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(2));
  port->reload();
  EXPECT_THAT(words(), HasSubstr("look.lua was changed since its stack was changed here."));
  EXPECT_THAT(ui.message, HasSubstr("edits of look.lua have no effect")) << "over the picture";
  ui.message.clear();
  frame();
  EXPECT_EQ(ui.message, "") << "once";
  EXPECT_TRUE(find_in_outcome("Keep mine")) << "where nothing scrolls";
  EXPECT_TRUE(find_in_outcome("Take the file's"));
  panel->save(*port);
  frame();
  EXPECT_EQ(*read_file(file), text) << "nothing is written over it";
  ASSERT_TRUE(find({"Settings", "Take the file's"}));
  click();
  EXPECT_TRUE(port->changes.none());
  EXPECT_TRUE(port->undo()) << "a step like any other";
  frame();
  ASSERT_TRUE(find({"Settings", "Keep mine"}));
  click();
  panel->save(*port);
  panel->saving().wait();
  frame();
  EXPECT_THAT(*read_file(file), Not(HasSubstr("fx.bloom")));
}

/// Undo brings back a stack that was made before another program changed the file: it is in conflict again.
TEST_F(PanelTest, AStackOfTheHistoryGoesByTheFileThatItWasMadeFrom) {
  const auto remove_next = [&] {
    panel->choose_next(interface.ui(), *port, panel->chosen().empty() ? 1 : -1);
    change_stack(Panel::EntryAction::remove);
    ASSERT_FALSE(panel->stack().failed()) << panel->stack().message();
    port->reload();
    frame();
  };
  ASSERT_NO_FATAL_FAILURE(remove_next());  // of the file as it was
  std::string text = kPreset;
  text.replace(text.find("aces"), 4, "none");
  std::ofstream(file) << text;
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(2));
  frame();
  EXPECT_TRUE(panel->stack().conflict());
  ASSERT_TRUE(find({"Settings", "Take the file's"}));
  click();
  port->reload();
  frame();
  EXPECT_FALSE(panel->stack().conflict());
  ASSERT_NO_FATAL_FAILURE(remove_next());  // of the file as it is
  EXPECT_FALSE(panel->stack().conflict());
  EXPECT_TRUE(port->undo());
  EXPECT_TRUE(port->undo());
  frame();
  EXPECT_TRUE(panel->stack().conflict());
  panel->save(*port);
  frame();
  EXPECT_EQ(*read_file(file), text) << "nothing is written over it";
  EXPECT_TRUE(port->redo());
  EXPECT_TRUE(port->redo());
  frame();
  EXPECT_FALSE(panel->stack().conflict()) << "that one was made from it";
  panel->save(*port);
  panel->saving().wait();
  frame();
  EXPECT_THAT(*read_file(file), HasSubstr("none"));
  EXPECT_NE(*read_file(file), text);
}

TEST_F(PanelTest, WhatTheScriptMakesIsToldWithItsPlace) {
  std::ofstream(file) << "local fx = require \"afterglow\"\nlocal list = {}\nfor i = 1, 2 do list[i] = fx.vignette {} "
                         "end\nreturn fx.stack(list)\n";
  port->reload();
  panel->choose_next(interface.ui(), *port, 1);
  panel->act(interface.ui(), *port, Panel::EntryAction::remove);
  frame();
  panel->stack().wait();
  EXPECT_THAT(words(), HasSubstr("look.lua:3: error: vignette is no item of a list that is written out"));
  EXPECT_TRUE(port->changes.none());
}

TEST_F(PanelTest, SettingsAreCopiedAndPastedAsOneStep) {
  Ui& ui = interface.ui();
  std::string copied;
  ui.copy = [&](const std::string& text) { copied = text; };
  std::ofstream(file)
      << "local fx = require \"afterglow\"\nreturn fx.stack { fx.vignette { intensity = 0.5, opacity = 0.5 }, "
         "fx.vignette { smoothness = 0.3 } }\n";
  port->reload();
  panel->choose_next(ui, *port, 1);
  panel->act(ui, *port, Panel::EntryAction::copy);
  EXPECT_EQ(copied, "fx.vignette { intensity = 0.5 },");
  panel->choose_next(ui, *port, 1);
  panel->act(ui, *port, Panel::EntryAction::paste);
  EXPECT_EQ(edited("vignette#2", "intensity").number[0], 0.5);
  EXPECT_EQ(edited("vignette#2", "opacity").number[0], 0.5);
  EXPECT_NE(edited("vignette#2", "smoothness").number[0], 0.3) << "the default, as the other one has it";
  EXPECT_TRUE(port->undo());
  EXPECT_TRUE(port->changes.none());
}

TEST_F(PanelTest, EffectsAreSearchedAndAdded) {
  EffectLibrary library;
  library.read(port->preset()->path());
  while (library.reading()) library.poll();
  EXPECT_GT(library.effects().size(), 40u);
  EXPECT_GT(library.masks().size(), 7u);
  EffectBrowser browser;
  browser.open({});
  std::optional<std::string> chosen;
  what_ = [&] {
    if (auto name = browser.draw(interface.ui(), library, {0, 0}, {kWidth, 500})) chosen = name;
  };
  frame();
  frame();
  ImGui::GetIO().AddInputCharactersUTF8("VIGN");
  frame();
  frame();
  const std::string text = words();
  EXPECT_THAT(text, HasSubstr("vignette"));
  EXPECT_THAT(text, HasSubstr("smoothness")) << "its settings";
  EXPECT_THAT(text, Not(HasSubstr("pixelate")));
  EXPECT_FALSE(chosen);
  ASSERT_TRUE(find({"Add an effect", "Add"}));
  click();
  EXPECT_EQ(chosen, "vignette");
  EXPECT_FALSE(browser.is_open());
}

TEST_F(PanelTest, SaveAsWritesAnotherFile) {
  Ui& ui = interface.ui();
  std::string opened;
  ui.open = [&](const std::string& path) { opened = path; };
  port->changes.set("bloom", "intensity", {SettingType::number, {0.5}, ""});
  std::ofstream(folder_ / "look_2.lua") << "there";
  EXPECT_EQ(free_name(file), folder_ / "look_3.lua");
  EXPECT_EQ(free_name(folder_ / "look_2.lua"), folder_ / "look_3.lua");
  panel->save_as();
  frame();
  frame();
  ASSERT_TRUE(find_in_dialog());
  click();
  panel->saving().wait();
  frame();
  EXPECT_EQ(*read_file(file), kPreset);
  ASSERT_EQ(opened, (folder_ / "look_3.lua").string()) << panel->saving().message();
  EXPECT_THAT(*read_file(folder_ / "look_3.lua"), HasSubstr("fx.bloom { intensity = 0.5 },  -- glow"));
}

TEST_F(PanelTest, SavesAndListsWhatIsLeftOut) {
  port->changes.set("bloom", "intensity", {SettingType::number, {0.5}, ""});
  port->changes.set("color_adjustments", "contrast", {SettingType::number, {20}, ""});
  ASSERT_TRUE(find({"Settings", "Save"}));
  click();
  panel->saving().wait();
  const std::string text = words();
  EXPECT_THAT(text, HasSubstr("1 setting written to look.lua; 1 left out"));
  EXPECT_THAT(text, HasSubstr("look.lua:6: error: color_adjustments.contrast is computed and stays as it is: 5 + 5"));
  EXPECT_THAT(*read_file(file), HasSubstr("fx.bloom { intensity = 0.5 },  -- glow"));
  // The edit stays until the new file is on screen, then only what could not be written is left.
  EXPECT_EQ(port->changes.edits().size(), 2u);
  port->reload();
  frame();
  EXPECT_FALSE(port->changes.value("bloom", "intensity"));
  EXPECT_TRUE(port->changes.value("color_adjustments", "contrast"));

  ASSERT_TRUE(find({"Settings", "Undo save"}));
  click();
  EXPECT_EQ(*read_file(file), kPreset);
  EXPECT_EQ(edited("bloom", "intensity").number[0], 0.5);  // the picture stays as it was
  EXPECT_TRUE(port->changes.can_undo()) << "saving has kept the history";
  EXPECT_EQ(panel->saving().message(), "look.lua is as it was before");
}

TEST_F(PanelTest, SavesThatFailSayWhy) {
  port->changes.set("bloom", "intensity", {SettingType::number, {0.5}, ""});
  std::ofstream(file) << "return fx.stack {";
  panel->save(*port);
  panel->saving().wait();
  EXPECT_THAT(words(), HasSubstr("look.lua:1: error:"));
  EXPECT_EQ(port->changes.edits().size(), 1u);
}

TEST_F(PanelTest, OpacityBlendAndPartsOfMasks) {
  std::ofstream(file) << "local fx = require \"afterglow\"\n"
                         "return fx.stack { fx.tone_mapping { opacity = 0.25, mask = fx.mask.luma { from = 0.3 } } }\n";
  port->reload();
  EXPECT_THAT(words(), HasSubstr("mask: luma"));
  ASSERT_TRUE(find({"Settings", "tone_mapping", "opacity", "##value"}));
  const ImVec2 at = ImGui::GetIO().MousePos;
  press(true);
  move(5000, at.y);
  frame();
  press(false);
  EXPECT_EQ(edited("tone_mapping", "opacity").number[0], 1);
  ASSERT_TRUE(find({"Settings", "tone_mapping", "blend", "##value"}));
  click();
  ASSERT_TRUE(find({"##Combo_00", "screen"}));
  click();
  EXPECT_EQ(edited("tone_mapping", "blend").choice, "screen");
  port->changes.set("tone_mapping", "mask.luma.from", {SettingType::number, {0.75}, ""});
  ASSERT_TRUE(find({"Settings", "Save"}));
  click();
  panel->saving().wait();
  frame();
  EXPECT_EQ(
      *read_file(file),
      "local fx = require \"afterglow\"\n"
      "return fx.stack { fx.tone_mapping { opacity = 1, mask = fx.mask.luma { from = 0.75 }, blend = \"screen\" } }\n");
}

}  // namespace
}  // namespace afterglow::test
