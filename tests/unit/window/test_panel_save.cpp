// SPDX-License-Identifier: MIT
// What the panel writes, what it leaves out, and what is still unsaved then.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file.h"
#include "panel_test.h"

namespace afterglow::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class PanelSaveTest : public PanelTest {
 protected:
  static SettingValue number(double value) { return {SettingType::number, {value}, ""}; }
  /// The file with `after` in place of `before`, and the preset that is shown.
  void change_file(const std::string& before, const std::string& after) {
    std::string text = read_file(file).value();
    ASSERT_NE(text.find(before), std::string::npos) << text;
    text.replace(text.find(before), before.size(), after);
    std::ofstream(file) << text;
    port->reload();
  }
  void save() {
    panel->save(*port);
    panel->saving().wait();
    frame();
  }
};

TEST_F(PanelSaveTest, AChangeOfWhatHasGoneHoldsNothingBack) {
  port->changes.set("bloom", "intensity", number(0.5));
  port->changes.set("tone_mapping", "mode", {SettingType::enumeration, {}, "neutral"});
  port->changes.set("bloom", "gone", number(1));
  ASSERT_NO_FATAL_FAILURE(change_file("  fx.tone_mapping { mode = \"aces\" },\n", ""));
  EXPECT_THAT(words(), HasSubstr("Changes of what the preset no longer has"));
  save();
  EXPECT_THAT(read_file(file).value(), HasSubstr("fx.bloom { intensity = 0.5 }"));
  EXPECT_EQ(panel->saving().message(), "1 setting written to look.lua; 2 left out");
  EXPECT_THAT(words(), HasSubstr("the stack has no entry 'tone_mapping'"));
  ASSERT_TRUE(find({"Settings", "lost", "tone_mapping.mode", "x"}));
  click();
  ASSERT_TRUE(find({"Settings", "lost", "bloom.gone", "x"}));
  click();
  EXPECT_FALSE(port->changes.value("tone_mapping", "mode"));
  EXPECT_FALSE(port->changes.value("bloom", "gone"));
  EXPECT_THAT(words(), Not(HasSubstr("no longer has")));
}

/// Until the new file is on screen, what was left out is unsaved, and nothing else is.
TEST_F(PanelSaveTest, WhatWasLeftOutIsUnsavedAtOnce) {
  port->changes.set("bloom", "intensity", number(0.5));
  save();
  EXPECT_TRUE(port->changes.value("bloom", "intensity"));
  EXPECT_EQ(panel->unsaved(*port), "");
  port->changes.set("bloom", "scatter", number(0.5));
  EXPECT_EQ(panel->unsaved(*port), "1 setting of look.lua");
  port->changes.set("color_adjustments", "contrast", number(20));  // computed
  save();
  EXPECT_EQ(panel->saving().message(), "1 setting written to look.lua; 1 left out");
  EXPECT_EQ(panel->unsaved(*port), "1 setting of look.lua");
  port->reload();
  frame();
  EXPECT_EQ(port->changes.edits().size(), 1u);
  EXPECT_TRUE(port->changes.value("color_adjustments", "contrast"));
}

TEST_F(PanelSaveTest, AnotherProgramWritesTheFileBeforeItIsShown) {
  port->changes.set("bloom", "intensity", number(0.5));
  port->changes.set("bloom", "scatter", number(0.5));
  save();
  ASSERT_NO_FATAL_FAILURE(change_file("intensity = 0.5", "intensity = 0.9"));
  frame();
  EXPECT_FALSE(port->changes.value("bloom", "scatter")) << "the file says it";
  EXPECT_EQ(edited("bloom", "intensity").number[0], 0.5);
  EXPECT_THAT(words(), HasSubstr("The file says 0.9 now (it was 0.5)"));
  EXPECT_EQ(panel->unsaved(*port), "1 setting of look.lua");
  port->changes.set("tone_mapping", "opacity", number(0.5));
  EXPECT_EQ(panel->unsaved(*port), "2 settings of look.lua");
}

TEST_F(PanelSaveTest, WhatIsLeftOutIsToldUntilItIsTakenBack) {
  port->changes.set("color_adjustments", "contrast", number(20));
  save();
  EXPECT_EQ(panel->saving().message(), "Nothing was written; 1 left out");
  EXPECT_THAT(words(), HasSubstr("is computed and stays as it is"));
  port->reset_all();
  EXPECT_THAT(words(), Not(HasSubstr("is computed and stays as it is")));
  EXPECT_EQ(panel->saving().message(), "");
}

/// What a curve says at another frame is no change of the file.
TEST_F(PanelSaveTest, CurvesMoveWithoutAConflict) {
  port->changes.set("color_adjustments", "post_exposure", number(0.5));
  frame();
  ASSERT_NO_FATAL_FAILURE(change_file("{ 1, 0 }, { 9, 1 }", "{ 1, 0.25 }, { 9, 1 }"));  // as a later frame would
  EXPECT_THAT(words(), Not(HasSubstr("The file says")));
  save();
  EXPECT_THAT(words(), HasSubstr("color_adjustments.post_exposure is computed and stays as it is: fx.curve"));
}

TEST_F(PanelSaveTest, ACopyIsAPresetWhateverItsName) {
  std::string opened;
  interface.ui().open = [&](const std::string& path) { opened = path; };
  std::ofstream(folder_ / "hero.v2.lua") << "there";
  panel->save_as();
  frame();
  frame();
  ImGui::GetIO().AddInputCharactersUTF8("hero.v2");
  frame();
  ASSERT_TRUE(find_in_dialog());
  click();
  EXPECT_THAT(read_file(folder_ / "hero.v2.lua").value(), "there") << "asked about first";
  ASSERT_TRUE(find_in_dialog());
  click();
  frame();
  panel->saving().wait();
  frame();
  EXPECT_EQ(opened, (folder_ / "hero.v2.lua").string()) << panel->saving().message();
  EXPECT_EQ(read_file(folder_ / "hero.v2.lua").value(), kPreset);
}

TEST_F(PanelSaveTest, ACopyIsNotOpenedOverNewerChanges) {
  std::string opened;
  interface.ui().open = [&](const std::string& path) { opened = path; };
  panel->save_as();
  frame();
  frame();
  ImGui::GetIO().AddInputCharactersUTF8("other");
  frame();
  ASSERT_TRUE(find_in_dialog());
  click();
  for (int i = 0; i < 10 && !panel->saving().busy(); ++i) frame();
  ASSERT_TRUE(panel->saving().busy());
  port->changes.set("color_adjustments", "post_exposure", number(0.5));
  panel->saving().wait();
  frame();
  EXPECT_EQ(opened, "");
  EXPECT_THAT(panel->saving().message(), HasSubstr("other.lua; what was changed since is not in it"));
  EXPECT_EQ(read_file(folder_ / "other.lua").value(), kPreset);
}

/// For the rest of a test.
class Environment {
 public:
  Environment(const char* name, const fs::path& value)
      : name_(name), before_(std::getenv(name) ? std::getenv(name) : "") {
    setenv(name, value.c_str(), 1);
  }
  ~Environment() { before_.empty() ? unsetenv(name_) : setenv(name_, before_.c_str(), 1); }

 private:
  const char* name_;
  std::string before_;
};

TEST_F(PanelSaveTest, PresetsOfPacksAreCopied) {
  const Environment cache("AFTERGLOW_CACHE", folder_);
  const fs::path packed = folder_ / "packs" / "0123" / "kit.zip" / "look.lua", here = fs::current_path();
  fs::create_directories(packed.parent_path());
  fs::copy_file(file, packed);
  fs::current_path(folder_);
  std::string opened;
  interface.ui().open = [&](const std::string& path) { opened = path; };
  panel = std::make_unique<Panel>(packed, PresetOptions{});
  EXPECT_FALSE(panel->save(*port)) << "nothing was changed";
  port->changes.set("bloom", "intensity", number(0.5));
  EXPECT_TRUE(panel->save(*port));
  frame();
  frame();
  ASSERT_TRUE(find_in_dialog());
  click();
  panel->saving().wait();
  frame();
  fs::current_path(here);
  EXPECT_EQ(read_file(packed).value(), kPreset);
  EXPECT_EQ(fs::path(opened).filename(), "look_2.lua") << panel->saving().message();
  EXPECT_THAT(read_file(folder_ / "look_2.lua").value(), HasSubstr("fx.bloom { intensity = 0.5 }"));
}

TEST_F(PanelSaveTest, PresetsOfTheInstallationAreCopied) {
  const Environment home("AFTERGLOW_HOME", folder_);
  const fs::path installed = folder_ / "presets" / "look.lua";
  fs::create_directories(installed.parent_path());
  fs::copy_file(file, installed);
  port->changes.set("bloom", "intensity", number(0.5));
  panel = std::make_unique<Panel>(installed, PresetOptions{});
  EXPECT_TRUE(panel->save(*port));
  EXPECT_TRUE(panel->asks_for_name());
  panel = std::make_unique<Panel>(file, PresetOptions{});
  EXPECT_FALSE(panel->save(*port)) << "it lies in the installation's folder, and is none of its presets";
  panel->saving().wait();
  EXPECT_EQ(read_file(installed).value(), kPreset);
}

}  // namespace
}  // namespace afterglow::test
