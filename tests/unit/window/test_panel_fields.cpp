// SPDX-License-Identifier: MIT
// Fields of the panel: what takes a text that was typed, and what leaves it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "panel_test.h"

namespace afterglow::test {
namespace {

using ::testing::HasSubstr;

class PanelFields : public PanelTest {
 protected:
  PanelFields() {
    std::ofstream(file) << "local fx = require \"afterglow\"\n"
                           "fx.args { hero = fx.text {} }\nreturn fx.stack { fx.tone_mapping {} }\n";
    port->reload();
  }
  /// In the field of the argument, in place of what is there.
  void type(const std::string& text) {
    EXPECT_TRUE(find({"Settings", "arguments", "hero", "##value"}));
    click();
    ImGui::GetIO().AddInputCharactersUTF8(text.c_str());
    frame();
    frame();
  }
};

TEST_F(PanelFields, EnterTabAndAClickElsewhereTakeAText) {
  type("a");
  EXPECT_FALSE(port->changes.value("", "hero")) << "not before it is entered";
  press_key(ImGuiKey_Enter);
  EXPECT_EQ(edited("", "hero").choice, "a");
  type("b");
  press_key(ImGuiKey_Tab);
  EXPECT_EQ(edited("", "hero").choice, "ba");
  type("c");
  move(-100, -100);
  press(true);
  press(false);
  EXPECT_EQ(edited("", "hero").choice, "cba");
  type("d");
  press_key(ImGuiKey_Escape);
  frame();
  EXPECT_EQ(edited("", "hero").choice, "cba");
}

TEST_F(PanelFields, TextsMayBeLong) {
  type(std::string(900, 'x'));
  press_key(ImGuiKey_Enter);
  EXPECT_EQ(edited("", "hero").choice, std::string(900, 'x'));
  type(std::string(900, 'y'));
  press_key(ImGuiKey_Enter);
  EXPECT_EQ(edited("", "hero").choice.size(), 1000u) << "no longer than scripts take them";
}

/// With the keyboard at the picture ImGui itself closes none.
TEST_F(PanelFields, EscapeClosesWhatTheMouseHasOpened) {
  EXPECT_FALSE(interface.close_popups());
  ASSERT_TRUE(find({"Settings", "tone_mapping", "opacity", "##value"}));
  click(1);
  frame();
  const auto& open = ImGui::GetCurrentContext()->OpenPopupStack;
  ASSERT_FALSE(open.empty());
  EXPECT_TRUE(interface.close_popups());
  frame();
  EXPECT_TRUE(open.empty());
  EXPECT_FALSE(interface.close_popups());
}

/// A change that the preset cannot be run with is mended where it was made.
TEST_F(PanelFields, AChangeThatIsWrongIsNamedAndCanBeMended) {
  std::ofstream(file) << "local fx = require \"afterglow\"\nreturn fx.stack { fx.lut {} }\n";
  port->reload();
  const SettingValue wrong{SettingType::file, {}, "no.cube"};
  port->changes.set("lut", "file", wrong);
  port->now.error = Error{ErrorKind::script, "file = \"no.cube\": there is no such file", file.string(), 2};
  EXPECT_THAT(words(), HasSubstr("The error is in your change of lut.file."));
  ASSERT_TRUE(find({"Settings", "lut", "file", "##value"}));
  click();
  ImGui::GetIO().AddInputCharactersUTF8("x");
  frame();
  press_key(ImGuiKey_Enter);
  EXPECT_EQ(edited("lut", "file").choice, "xno.cube");
  port->changes.set("lut", "file", wrong);
  port->now.error = Error{ErrorKind::script, "unknown word 'x'", (folder_ / "no.cube").string(), 1};
  EXPECT_THAT(words(), HasSubstr("The error is in your change of lut.file."));
  port->now.error = Error{ErrorKind::script, "broken", file.string(), 2};
  EXPECT_THAT(words(), HasSubstr("The preset has an error: in the file, or by a change made here."));
}

}  // namespace
}  // namespace afterglow::test
