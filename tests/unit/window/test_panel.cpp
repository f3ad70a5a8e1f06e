// SPDX-License-Identifier: MIT
// The interface without a window: frames of Dear ImGui with a pointer and keys that are moved by hand, on a real
// preset.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <imgui_internal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/file.h"
#include "window/help_sheet.h"
#include "window/interface.h"
#include "window/name_dialog.h"
#include "window/panel.h"
#include "window/setting_widget.h"
#include "window/shortcuts.h"
#include "window/transport_bar.h"

namespace afterglow::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kPreset =
    "local fx = require \"afterglow\"\n"
    "return fx.stack {\n"
    "  name = \"Test look\",\n"
    "  fx.bloom { intensity = 0.2 },  -- glow\n"
    "  fx.tone_mapping { mode = \"aces\" },\n"
    "  fx.color_adjustments { contrast = 5 + 5, post_exposure = fx.curve { { 1, 0 }, { 9, 1 } } },\n"
    "}\n";

/// A preset and plain data in place of a player.
class Port : public PanelPort {
 public:
  explicit Port(const fs::path& file) : file_(file) { reload(); }
  void reload() {
    build_.reset();
    preset_.reset();
    shaders_ = std::make_unique<ShaderLibrary>(search_path_for(file_, {}));
    PresetOptions options;
    if (changes.stack_text()) options.text = *changes.stack_text();
    auto loaded = Preset::load(file_, options, *shaders_, diagnostics_);
    ASSERT_TRUE(loaded) << loaded.error().text();
    preset_ = std::make_unique<Preset>(std::move(*loaded));
    auto build = preset_->evaluate({.size = {64, 32}}, diagnostics_);
    ASSERT_TRUE(build) << build.error().text();
    build_ = std::move(*build);
  }

  const Preset* preset() override { return preset_.get(); }
  const Build* build() override { return build_ ? &*build_ : nullptr; }
  LiveStatus status() override { return now; }
  const std::vector<Skipped>& skipped() override { return skips; }
  std::vector<KernelTime> times() override { return frame_times.kernels; }
  const SettingEdits& edits() override { return changes; }
  void set(const std::string& entry, const std::string& setting, const SettingValue& value) override {
    ++sets;
    changes.set(entry, setting, value);
  }
  void reset(const std::string& entry, const std::string& setting) override { changes.reset(entry, setting); }
  void reset_all() override { changes.reset_all(); }
  bool undo() override { return changes.undo(); }
  void take_back() override { changes.take_back(); }
  bool redo() override { return changes.redo(); }
  void end_gesture() override { changes.end_gesture(); }
  void rebase(const std::vector<BaseChange>& base) override { changes.rebase(base); }
  void rebase(const std::vector<BaseChange>& base, const TextChange& text) override { changes.rebase(base, text); }
  void set_all(const std::vector<SettingEdit>& values) override { changes.set_all(values); }
  void set_stack(const StackChange& change) override { changes.set_stack(change); }
  void reset_stack() override { changes.reset_stack(); }
  View& view() override { return look; }
  Rect middle_region() override { return {10, 20, 30, 40}; }
  std::vector<std::string> images() override { return {"source", "bloom.down[1]", "bloom.up[1]"}; }
  std::string shown_image() override { return image; }
  void show(const std::string& name) override { image = name; }
  bool has_other() override { return false; }

  SettingEdits changes;
  LiveStatus now;
  std::vector<Skipped> skips;
  FrameTimes frame_times;
  View look;
  std::string image;
  int sets = 0;

 private:
  fs::path file_;
  Diagnostics diagnostics_;
  std::unique_ptr<ShaderLibrary> shaders_;
  std::unique_ptr<Preset> preset_;
  std::optional<Build> build_;
};

/// Dear ImGui is told of modifiers by events from version 1.89 on.
#if IMGUI_VERSION_NUM >= 18900
void hold_shift(bool down) { ImGui::GetIO().AddKeyEvent(ImGuiMod_Shift, down); }
void hold_control(bool down) { ImGui::GetIO().AddKeyEvent(ImGuiMod_Ctrl, down); }
#else
void hold_shift(bool down) {
  ImGui::GetIO().KeyShift = down;
  ImGui::GetIO().KeyMods = down ? ImGuiKeyModFlags_Shift : 0;
}
void hold_control(bool down) {
  ImGui::GetIO().KeyCtrl = down;
  ImGui::GetIO().KeyMods = down ? ImGuiKeyModFlags_Ctrl : 0;
}
#endif

class PanelTest : public ::testing::Test {
 protected:
  PanelTest()
      : folder_(fs::temp_directory_path() / ("afterglow_panel_" + std::to_string(getpid()))),
        file(folder_ / "look.lua"),
        interface(nullptr) {
    fs::create_directories(folder_);
    std::ofstream(file) << kPreset;
    port = std::make_unique<Port>(file);
    panel = std::make_unique<Panel>(file, PresetOptions{});
    what_ = [this] { panel->draw(interface.ui(), *port, {0, 0}, {kWidth, kHeight}); };
    move(-100, -100);
    frame();
  }
  ~PanelTest() override {
    std::error_code ec;
    fs::remove_all(folder_, ec);
  }

  void frame() {
    interface.begin({static_cast<int>(2 * kWidth), static_cast<int>(kHeight)});
    what_();
    interface.end();
  }
  /// What the first window of a frame says in words.
  std::string words() {
    move(-100, -100);  // tooltips are windows too
    frame();
    ImGui::SetClipboardText("");
    interface.begin({static_cast<int>(2 * kWidth), static_cast<int>(kHeight)});
    ImGui::LogToClipboard();
    what_();
    interface.end();
    const char* text = ImGui::GetClipboardText();
    return text ? text : "";
  }

  void move(float x, float y) { ImGui::GetIO().MousePos = {x, y}; }
  /// The panel makes bloom's intensity 0.5, and then the file 0.9; returns what the file holds.
  std::string change_both() {
    port->changes.set("bloom", "intensity", {SettingType::number, {0.5}, ""});
    frame();
    std::string text = kPreset;
    text.replace(text.find("0.2"), 3, "0.9");
    std::ofstream(file) << text;
    port->reload();
    return text;
  }
  void press(bool down, int button = 0) {
    ImGui::GetIO().MouseDown[button] = down;
    frame();
  }
  void click(int button = 0) {
    frame();
    press(true, button);
    press(false, button);
    frame();
  }
  static ImGuiID id_of(const std::vector<std::string>& path) {
    ImGuiID id = 0;
    for (const auto& part : path) id = ImHashStr(part.c_str(), 0, id);
    return id;
  }
  /// Moves the pointer until it is over the item; false when it is nowhere.
  bool find(const std::vector<std::string>& path) {
    const ImGuiID id = id_of(path);
    std::vector<float> columns{20, 45, 80, 100, 130, 170, 250};
    for (float x = 8; x < kWidth; x += 8) columns.push_back(x);
    for (const float x : columns)
      for (float y = 4; y < kHeight; y += 6) {
        move(x, y);
        frame();
        if (ImGui::GetCurrentContext()->HoveredId == id) return true;
      }
    return false;
  }
  /// The button of the Save as dialog, which stands in the middle.
  bool find_in_dialog() {
    const ImGuiID id = id_of({"Save preset as###name", "###do"});
    for (float y = kHeight / 2 - 120; y < kHeight / 2 + 120; y += 6)
      for (float x = kWidth - 260; x < kWidth + 260; x += 12) {
        move(x, y);
        frame();
        if (ImGui::GetCurrentContext()->HoveredId == id) return true;
      }
    return false;
  }
  SettingValue edited(const std::string& entry, const std::string& setting) {
    return port->changes.value(entry, setting).value_or(SettingValue{SettingType::vec3, {-99, -99, -99}, ""});
  }

  static constexpr float kWidth = 440, kHeight = 1900;
  fs::path folder_;
  fs::path file;
  Interface interface;
  std::unique_ptr<Port> port;
  std::unique_ptr<Panel> panel;
  std::function<void()> what_;
};

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

TEST(TypedValue, TakesAsManyNumbersAsTheTypeHas) {
  SettingSchema schema;
  schema.type = SettingType::vec3;
  EXPECT_EQ(parse_typed(schema, "1, 2.5 -3e-2")->number, (std::array<double, 3>{1, 2.5, -0.03}));
  EXPECT_EQ(parse_typed(schema, "0.5")->number, (std::array<double, 3>{0.5, 0.5, 0.5}));
  EXPECT_FALSE(parse_typed(schema, "1 2"));
  EXPECT_FALSE(parse_typed(schema, "1 2 x"));
  EXPECT_FALSE(parse_typed(schema, "1 2 nan"));
  schema.type = SettingType::integer;
  schema.max = 7;
  EXPECT_EQ(parse_typed(schema, "99")->number[0], 7);
  EXPECT_EQ(parse_typed(schema, "2.6")->number[0], 3);
  EXPECT_FALSE(parse_typed(schema, ""));
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
  panel->undo_save(*port);
  frame();
  EXPECT_EQ(*read_file(file), kPreset);
  EXPECT_EQ(panel->unsaved(*port), "the stack of look.lua") << "what was saved is still on screen";
}

TEST_F(PanelTest, StackAndFileDisagree) {
  Ui& ui = interface.ui();
  panel->choose_next(ui, *port, 1);
  panel->act(ui, *port, Panel::EntryAction::remove);
  frame();
  panel->stack().wait();
  frame();
  std::string text = kPreset;
  text.replace(text.find("aces"), 4, "none");
  std::ofstream(file) << text;
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(2));
  port->reload();
  EXPECT_THAT(words(), HasSubstr("look.lua was changed since its stack was changed here."));
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

class TransportBar : public PanelTest {
 protected:
  TransportBar() : transport(100) {
    markers.follow(footage);
    what_ = [this] {
      TransportBarState state{
          .timeline = {transport, now, transport.position(), [](int at) { return at + 1001; },
                       [](int at) { return at < 50 ? FrameState::cached : FrameState::unread; }, *footage, markers},
          .view = look,
          .picture = {640, 360},
          .window = {640, 180}};
      draw_transport_bar(interface.ui(), state, {0, 0}, {wide, transport_bar_shape(interface.ui(), wide).height});
    };
    frame();
  }
  /// x of the middle of a position.
  static float x_of(int position) {
    const float padding = ImGui::GetStyle().WindowPadding.x;
    return padding + (static_cast<float>(position) + 0.5f) * (kWidth * 2 - 2 * padding) / 100;
  }
  /// Frames 1001 to 1100, by their names alone.
  static std::shared_ptr<const Footage> hundred_frames() {
    const auto folder = fs::temp_directory_path() / ("afterglow-bar-" + std::to_string(getpid()));
    fs::create_directories(folder);
    for (int number = 1001; number <= 1100; ++number) std::ofstream(folder / fmt::format("shot.{}.exr", number)) << "x";
    Diagnostics nowhere;
    auto opened = Footage::open({.inputs = {(folder / "shot.####.exr").string()}, .frames = {}, .read = {}}, nowhere);
    fs::remove_all(folder);
    return std::move(opened).value();
  }
  std::shared_ptr<const Footage> footage = hundred_frames();
  Markers markers{fs::path()};
  Transport transport;
  View look;
  float wide = kWidth * 2;
  double now = 0;
};

TEST_F(TransportBar, PlaysAndSteps) {
  ASSERT_TRUE(find({"Transport", "##play"}));
  click();
  EXPECT_TRUE(transport.playing());
  ASSERT_TRUE(find({"Transport", "##play"}));
  click();
  EXPECT_FALSE(transport.playing());
  ASSERT_TRUE(find({"Transport", "##on"}));
  click();
  EXPECT_EQ(transport.position(), 1);
  ASSERT_TRUE(find({"Transport", "##last"}));
  click();
  EXPECT_EQ(transport.position(), 99);
  EXPECT_THAT(words(), HasSubstr("1100  100/100"));
}

/// At any width nothing is drawn over anything else, and all of it within the bar.
TEST_F(TransportBar, PiecesNeverLieOnEachOther) {
  for (const float scale : {1.0f, 2.0f}) {
    interface.set_scale(scale);
    for (const float width : {500.0f, 524.0f, 724.0f, 880.0f}) {
      wide = width;
      frame();
      std::vector<ImGuiID> ids;
      const float height = 6 * 48;  // more than it ever has
      for (float y = 2; y < height; y += 3)
        for (float x = 2; x < width; x += 3) {
          move(x, y);
          frame();
          const ImGuiID id = ImGui::GetCurrentContext()->HoveredId;
          if (id != 0 && std::ranges::find(ids, id) == ids.end()) ids.push_back(id);
        }
      EXPECT_EQ(ids.size(), 12u) << "timeline, five buttons, six others; width " << width << ", scale " << scale;
    }
  }
}

TEST_F(TransportBar, ZoomAndFilter) {
  wide = kWidth;  // `find` looks no farther
  EXPECT_THAT(words(), HasSubstr("fit 50%"));
  ASSERT_TRUE(find({"Transport", "###zoom"}));
  click();
  EXPECT_FALSE(look.fit);
  EXPECT_EQ(look.zoom, 1);
  EXPECT_THAT(words(), HasSubstr("100%"));
  ASSERT_TRUE(find({"Transport", "###filter"}));
  click();
  EXPECT_TRUE(look.smooth);
  EXPECT_THAT(words(), HasSubstr("linear"));
}

TEST_F(TransportBar, Scrubs) {
  ASSERT_TRUE(find({"Transport", "scrub"}));
  move(x_of(40), ImGui::GetIO().MousePos.y);
  press(true);
  EXPECT_EQ(transport.position(), 40);
  move(x_of(71), ImGui::GetIO().MousePos.y);
  frame();
  EXPECT_EQ(transport.position(), 71);
  move(5000, 5000);
  frame();
  EXPECT_EQ(transport.position(), 99);
  press(false);
  move(x_of(3), 10);
  frame();
  EXPECT_EQ(transport.position(), 99);
}

TEST_F(TransportBar, RangesWithShift) {
  ASSERT_TRUE(find({"Transport", "scrub"}));
  const float y = ImGui::GetIO().MousePos.y;
  hold_shift(true);
  move(x_of(20), y);
  frame();
  press(true);
  press(false);
  move(x_of(60), y);
  frame();
  press(true);
  press(false);
  EXPECT_EQ(transport.first(), 20);
  EXPECT_EQ(transport.last(), 60);
  hold_shift(false);
  click(1);
  EXPECT_EQ(transport.first(), 0);
  EXPECT_EQ(transport.last(), 99);
}

TEST(PositionInBar, CoversEveryFrameEvenly) {
  EXPECT_EQ(position_in_bar(10, 10, 100, 10), 0);
  EXPECT_EQ(position_in_bar(19.9f, 10, 100, 10), 0);
  EXPECT_EQ(position_in_bar(20.1f, 10, 100, 10), 1);
  EXPECT_EQ(position_in_bar(109.9f, 10, 100, 10), 9);
  EXPECT_EQ(position_in_bar(-50, 10, 100, 10), 0);
  EXPECT_EQ(position_in_bar(500, 10, 100, 10), 9);
  EXPECT_EQ(position_in_bar(5, 0, 0, 10), 0);
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

TEST(SettingWidget, SlidersByFactorsWhereTheRangeIsWide) {
  SettingSchema schema;
  EXPECT_FALSE(is_logarithmic(schema));
  schema.min = 0;
  schema.max = 1;
  EXPECT_FALSE(is_logarithmic(schema));
  schema.max = 1000;
  EXPECT_TRUE(is_logarithmic(schema));
  schema.min = -1000;
  EXPECT_FALSE(is_logarithmic(schema));
}

TEST(SettingWidget, ColourCodesAreThoseOfSrgb) {
  EXPECT_NEAR(encode_color(0.21586050011389926), 128 / 255.0, 1e-9);
  for (const double value : {0.0, 0.001, 0.18, 1.0, 4.0}) EXPECT_NEAR(decode_color(encode_color(value)), value, 1e-6);
}

}  // namespace
}  // namespace afterglow::test
