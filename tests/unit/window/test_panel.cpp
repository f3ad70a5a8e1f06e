// SPDX-License-Identifier: MIT
// The panel: settings are set, typed, reset and kept apart from the file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file.h"
#include "panel_test.h"
#include "window/help_sheet.h"
#include "window/shortcuts.h"

namespace afterglow::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(PanelTest, SlidersSetWithinTheirRangeAsOneGesture) {
  ASSERT_TRUE(find({"Settings", "bloom", "scatter", "##value"}));
  const ImVec2 at = ImGui::GetIO().MousePos;
  std::vector<double> dragged;
  press(true);
  for (const float x : {60.0f, 90.0f, 120.0f, 5000.0f}) {
    move(x, at.y);
    frame();
    dragged.push_back(edited("bloom", "scatter").number[0]);
  }
  press(false);
  frame();
  EXPECT_NEAR(edited("bloom", "scatter").number[0], 0.95, 1e-6);  // its largest value
  EXPECT_THAT(dragged, ::testing::SizeIs(::testing::Ge(3u)));
  for (const double value : dragged) EXPECT_EQ(value, std::round(value * 1000) / 1000);  // as it is shown
  EXPECT_GE(port->sets, 3);
  EXPECT_TRUE(port->changes.undo());
  EXPECT_FALSE(port->changes.value("bloom", "scatter"));  // one step
}

TEST_F(PanelTest, ValuesAreTyped) {
  ASSERT_TRUE(find({"Settings", "bloom", "scatter", "##value"}));
  hold_control(true);
  press(true);
  press(false);
  hold_control(false);
  frame();
  ImGui::GetIO().AddInputCharactersUTF8("0.6251234");
  frame();
  frame();
  move(-100, -100);
  press(true);  // elsewhere: done
  press(false);
  frame();
  EXPECT_EQ(edited("bloom", "scatter").number[0], 0.6251234);
}

/// A double click opens a field; Enter and Tab take what was typed, Escape does not, and the click before it is undone.
TEST_F(PanelTest, ADoubleClickTypes) {
  const auto open = [&] {
    ASSERT_TRUE(find({"Settings", "bloom", "scatter", "##value"}));
    for (int i = 0; i < 2; ++i) {
      press(true);
      press(false);
    }
    frame();
    frame();
  };
  const auto key = [&](int code) {
#if IMGUI_VERSION_NUM >= 18700
    ImGui::GetIO().AddKeyEvent(static_cast<ImGuiKey>(code), true);
    frame();
    ImGui::GetIO().AddKeyEvent(static_cast<ImGuiKey>(code), false);
    frame();
#else
    ImGui::GetIO().KeyMap[code] = code;
    ImGui::GetIO().KeysDown[code] = true;
    frame();
    ImGui::GetIO().KeysDown[code] = false;
    frame();
#endif
  };
  open();
  ImGui::GetIO().AddInputCharactersUTF8("0.123456789");
  frame();
  frame();
  EXPECT_FALSE(port->changes.value("bloom", "scatter")) << "not before Enter, and the click has changed nothing";
  key(ImGuiKey_Enter);
  EXPECT_EQ(edited("bloom", "scatter").number[0], 0.123456789);
  EXPECT_TRUE(port->changes.undo());
  EXPECT_FALSE(port->changes.can_undo()) << "one step";
  open();
  ImGui::GetIO().AddInputCharactersUTF8("0.25");
  frame();
  key(ImGuiKey_Escape);
  EXPECT_FALSE(port->changes.value("bloom", "scatter"));
  open();
  ImGui::GetIO().AddInputCharactersUTF8("0.5");
  frame();
  key(ImGuiKey_Tab);
  EXPECT_EQ(edited("bloom", "scatter").number[0], 0.5);
}

/// The file may say another value while the field is open. Nothing was typed: Escape is no edit of the old one.
TEST_F(PanelTest, AFieldThatIsLeftIsNoEditOfWhatTheFileSaidBefore) {
  ASSERT_TRUE(find({"Settings", "bloom", "intensity", "##value"}));
  hold_control(true);
  press(true);
  press(false);
  hold_control(false);
  frame();
  std::string text = kPreset;
  text.replace(text.find("0.2"), 3, "0.9");
  std::ofstream(file) << text;
  port->reload();
  frame();
  press_key(ImGuiKey_Escape);
  EXPECT_FALSE(port->changes.value("bloom", "intensity"));
}

TEST_F(PanelTest, WhileTheFileHasAnErrorSettingsRest) {
  port->now.error = Error{ErrorKind::script, "broken"};
  EXPECT_THAT(words(), HasSubstr("Settings rest until it is mended"));
  const auto drag = [&] {
    ASSERT_TRUE(find({"Settings", "bloom", "scatter", "##value"}));
    const ImVec2 at = ImGui::GetIO().MousePos;
    press(true);
    move(5000, at.y);
    frame();
    press(false);
  };
  drag();
  EXPECT_TRUE(port->changes.edits().empty());
  port->now.error.reset();
  drag();
  EXPECT_FALSE(port->changes.edits().empty());
}

/// The file changes what the panel has changed: both values are told, and Save writes neither over the other.
TEST_F(PanelTest, ConflictsAreToldAndDecided) {
  const std::string text = change_both();
  EXPECT_THAT(words(), HasSubstr("The file says 0.9 now (it was 0.2)"));
  panel->save(*port);
  EXPECT_THAT(words(), HasSubstr("bloom.intensity was changed in the file too: it says 0.9 now, the panel 0.5"));
  EXPECT_EQ(*read_file(file), text);
  ASSERT_TRUE(find({"Settings", "Dismiss"}) || find({"Settings", "bloom", "intensity", "Keep mine"}));
  ASSERT_TRUE(find({"Settings", "bloom", "intensity", "Keep mine"}));
  click();
  EXPECT_THAT(words(), Not(HasSubstr("The file says 0.9 now")));
  panel->save(*port);
  panel->saving().wait();
  frame();
  EXPECT_THAT(*read_file(file), HasSubstr("fx.bloom { intensity = 0.5 },  -- glow"));
}

TEST_F(PanelTest, TheFilesValueIsTaken) {
  change_both();
  ASSERT_TRUE(find({"Settings", "bloom", "intensity", "Take the file's"}));
  click();
  EXPECT_FALSE(port->changes.value("bloom", "intensity"));
}

TEST_F(PanelTest, SwitchesAndChoices) {
  ASSERT_TRUE(find({"Settings", "bloom", "fade_fireflies", "##value"}));
  click();
  EXPECT_EQ(edited("bloom", "fade_fireflies").number[0], 1);
  ASSERT_TRUE(find({"Settings", "bloom", "##enabled"}));
  click();
  EXPECT_EQ(edited("bloom", "enabled").number[0], 0);
  EXPECT_EQ(edited("bloom", "enabled").type, SettingType::boolean);
  ASSERT_TRUE(find({"Settings", "tone_mapping", "mode", "##value"}));
  click();
  ASSERT_TRUE(find({"##Combo_00", "neutral"}));
  click();
  EXPECT_EQ(edited("tone_mapping", "mode").choice, "neutral");
}

TEST_F(PanelTest, ResetsOneSettingAnEffectAndAll) {
  const SettingValue half{SettingType::number, {0.5}, ""};
  port->changes.set("bloom", "intensity", half);
  port->changes.set("bloom", "scatter", half);
  port->changes.set("color_adjustments", "contrast", half);
  ASSERT_TRUE(find({"Settings", "bloom", "intensity", "x"}));
  click();
  EXPECT_FALSE(port->changes.value("bloom", "intensity"));
  EXPECT_TRUE(port->changes.value("bloom", "scatter"));
  ASSERT_TRUE(find({"Settings", "bloom", "Reset"}));
  click();
  EXPECT_FALSE(port->changes.value("bloom", "scatter"));
  ASSERT_TRUE(find({"Settings", "Reset all"}));
  click();
  EXPECT_TRUE(port->changes.edits().empty());
  ASSERT_TRUE(find({"Settings", "Undo"}));
  click();
  EXPECT_EQ(port->changes.edits().size(), 1u);
}

TEST_F(PanelTest, TellsWhatRunsWhatItCostsAndWhatIsComputed) {
  port->skips = {{"tone_mapping", "mode is none"}};
  port->frame_times.kernels = {
      {"bloom.prefilter", 0.5}, {"bloom.down[1]", 0.25}, {"color_adjustments.grade+tone_mapping.aces", 1}};
  const std::string text = words();
  EXPECT_THAT(text, HasSubstr("Test look"));
  EXPECT_THAT(text, HasSubstr("skipped: mode is none"));
  EXPECT_THAT(text, HasSubstr("0.75 ms"));
  EXPECT_THAT(text, HasSubstr("0.50 ms"));  // half of the kernel that it shares
  EXPECT_THAT(text, HasSubstr("curve"));
  EXPECT_THAT(text, Not(HasSubstr("over curve")));
  port->changes.set("color_adjustments", "post_exposure", {SettingType::number, {1}, ""});
  EXPECT_THAT(words(), HasSubstr("over curve"));
}

/// The stack is changed by keys: text that is saved by Save, undone by Undo, with the settings that were changed.
TEST_F(PanelTest, Search) {
  panel->search();
  frame();
  frame();
  ImGui::GetIO().AddInputCharactersUTF8("scatter");
  frame();
  frame();
  const std::string text = words();
  EXPECT_THAT(text, HasSubstr("scatter"));
  EXPECT_THAT(text, Not(HasSubstr("tone_mapping")));
  EXPECT_THAT(text, Not(HasSubstr("max_iterations")));
  EXPECT_TRUE(find({"Settings", "bloom", "scatter", "##value"}));
  EXPECT_FALSE(find({"Settings", "bloom", "knee", "##value"}));
}

TEST_F(PanelTest, ArgumentsAreChangedAndAreNotThePresets) {
  const std::string text =
      "local fx = require \"afterglow\"\n"
      "local args = fx.args { strength = fx.float { min = 0, max = 1, default = 0.25, doc = \"How much.\" },\n"
      "  hero = fx.text {} }\n"
      "return fx.stack { fx.tone_mapping { opacity = args.strength } }\n";
  std::ofstream(file) << text;
  port->reload();
  EXPECT_THAT(words(), HasSubstr("Arguments"));
  ASSERT_TRUE(find({"Settings", "arguments", "strength", "##value"}));
  const ImVec2 at = ImGui::GetIO().MousePos;
  press(true);
  move(5000, at.y);
  frame();
  press(false);
  EXPECT_EQ(edited("", "strength").number[0], 1);
  port->changes.set("", "hero", {SettingType::text, {}, "Ann's \"lamp\""});
  EXPECT_EQ(argument_words(port->changes), "--arg strength=1 --arg 'hero=Ann'\\''s \"lamp\"'");
  std::string copied;
  interface.ui().copy = [&](const std::string& text) { copied = text; };
  ASSERT_TRUE(find({"Settings", "arguments", "Copy --arg"}));
  click();
  EXPECT_EQ(copied, argument_words(port->changes));
  ASSERT_TRUE(find({"Settings", "Save"}));
  click();
  EXPECT_THAT(words(), HasSubstr("Arguments are not part of the preset: they are given by --arg strength=1"));
  EXPECT_EQ(*read_file(file), text);
  EXPECT_EQ(port->changes.edits().size(), 2u) << "they stay";
  ASSERT_TRUE(find({"Settings", "arguments", "strength", "x"}));
  click();
  EXPECT_FALSE(port->changes.value("", "strength"));
}

TEST_F(PanelTest, ViewControls) {
  ASSERT_TRUE(find({"Settings", "View"}));
  click();
  ASSERT_TRUE(find({"Settings", "image"}));
  click();
  ASSERT_TRUE(find({"##Combo_00", "bloom.up[1]"}));
  click();
  EXPECT_EQ(port->image, "bloom.up[1]");
  ASSERT_TRUE(find({"Settings", "marks"}));
  click();
  ASSERT_TRUE(find({"##Combo_00", "stops"}));
  click();
  EXPECT_EQ(port->look.marks, Marks::stops);
  ASSERT_TRUE(find({"Settings", "channel"}));
  click();
  ASSERT_TRUE(find({"##Combo_00", "luminance"}));
  click();
  EXPECT_EQ(port->look.channel, ViewChannel::luminance);
  ASSERT_TRUE(find({"Settings", "scope"}));
  click();
  ASSERT_TRUE(find({"##Combo_00", "vectorscope"}));
  click();
  EXPECT_EQ(port->look.scope, ScopeKind::vectorscope);
  ASSERT_TRUE(find({"Settings", "levels"}));
  click();
  ASSERT_TRUE(find({"##Combo_00", "stops"}));
  click();
  EXPECT_EQ(port->look.scope_scale, ScopeScale::stops);
  ASSERT_TRUE(find({"Settings", "region"}));
  click();
  EXPECT_EQ(port->look.region, (Rect{10, 20, 30, 40}));
}

TEST_F(PanelTest, WithoutAPreset) {
  what_ = [this] {
    class Empty : public Port {
     public:
      using Port::Port;
      const Preset* preset() override { return nullptr; }
      const Build* build() override { return nullptr; }
    } empty(file);
    panel->draw(interface.ui(), empty, {0, 0}, {kWidth, kHeight});
  };
  EXPECT_THAT(words(), HasSubstr("No preset yet"));
}

TEST_F(PanelTest, HelpTellsEveryKey) {
  interface.ui().show_help = true;
  what_ = [this] { draw_help_sheet(interface.ui(), {1600, kHeight}); };
  frame();
  const std::string text = words();
  for (const Shortcut& shortcut : shortcuts()) EXPECT_THAT(text, HasSubstr(keys_of(shortcut.action))) << shortcut.doc;
  interface.ui().show_help = false;
  EXPECT_THAT(words(), Not(HasSubstr("Space")));
}

}  // namespace
}  // namespace afterglow::test
