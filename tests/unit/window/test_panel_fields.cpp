// SPDX-License-Identifier: MIT
// Fields of the panel: what takes a text that was typed, and what leaves it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "panel_test.h"

namespace afterglow::test {
namespace {

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

}  // namespace
}  // namespace afterglow::test
