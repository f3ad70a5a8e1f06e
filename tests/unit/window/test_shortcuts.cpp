// SPDX-License-Identifier: MIT
// Keys: each action has one, no key has two, and the sheet's words are those of the list.
#include <gtest/gtest.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <map>
#include <set>
#include <string>

#include "window/desktop_window.h"
#include "window/shortcuts.h"

namespace afterglow {
namespace {

TEST(Shortcuts, EveryActionHasAKeyAndNoKeyTwo) {
  std::set<Action> actions;
  std::map<std::pair<int, int>, Action> keys;
  for (const Shortcut& shortcut : shortcuts()) {
    actions.insert(shortcut.action);
    EXPECT_TRUE(keys.emplace(std::pair{shortcut.key, shortcut.mods}, shortcut.action).second) << shortcut.keys;
    EXPECT_FALSE(std::string(shortcut.doc).empty());
  }
  for (int i = 0; i <= static_cast<int>(Action::quit); ++i)
    EXPECT_TRUE(actions.contains(static_cast<Action>(i))) << "action " << i;
}

TEST(Shortcuts, WordsNameTheKey) {
  for (const Shortcut& shortcut : shortcuts()) {
    const std::string words = shortcut.keys;
    EXPECT_EQ(words.find("Ctrl") != std::string::npos, (shortcut.mods & GLFW_MOD_CONTROL) != 0) << words;
    if (shortcut.key >= GLFW_KEY_A && shortcut.key <= GLFW_KEY_Z) {
      EXPECT_EQ(words.back(), static_cast<char>(shortcut.key)) << words;
      EXPECT_EQ(words.find("Shift") != std::string::npos, (shortcut.mods & GLFW_MOD_SHIFT) != 0) << words;
    }
  }
}

TEST(Shortcuts, HeldKeysRepeatWhereThatIsMeant) {
  EXPECT_EQ(action_of({GLFW_KEY_RIGHT, 0, true}), Action::step_forward);
  EXPECT_EQ(action_of({GLFW_KEY_SPACE, 0, true}), std::nullopt);
  EXPECT_EQ(action_of({GLFW_KEY_F, GLFW_MOD_CONTROL, false}), Action::search);
  EXPECT_EQ(action_of({GLFW_KEY_F, 0, false}), Action::fit);
  EXPECT_EQ(action_of({GLFW_KEY_F, GLFW_MOD_ALT, false}), std::nullopt);
}

/// French keyboards have A where those of the USA have Q, German ones Z where they have Y.
TEST(Shortcuts, LettersAreThoseOfTheLayout) {
  EXPECT_EQ(key_of_letter(GLFW_KEY_Q, "a"), GLFW_KEY_A);
  EXPECT_EQ(key_of_letter(GLFW_KEY_Y, "z"), GLFW_KEY_Z);
  EXPECT_EQ(key_of_letter(GLFW_KEY_SEMICOLON, "m"), GLFW_KEY_M);
  EXPECT_EQ(key_of_letter(GLFW_KEY_S, "s"), GLFW_KEY_S);
  EXPECT_EQ(key_of_letter(GLFW_KEY_1, "&"), GLFW_KEY_1) << "digits stay where they are";
  EXPECT_EQ(key_of_letter(GLFW_KEY_LEFT_BRACKET, "\xc3\xbc"), GLFW_KEY_LEFT_BRACKET);
  EXPECT_EQ(key_of_letter(GLFW_KEY_Q, "\xd0\xb9"), GLFW_KEY_Q) << "no letter of ASCII";
  EXPECT_EQ(key_of_letter(GLFW_KEY_F1, nullptr), GLFW_KEY_F1);
  EXPECT_EQ(key_of_letter(GLFW_KEY_RIGHT_BRACKET, "+"), GLFW_KEY_EQUAL) << "zoom, on German keyboards too";
  EXPECT_EQ(key_of_letter(GLFW_KEY_SLASH, "-"), GLFW_KEY_MINUS);
  EXPECT_EQ(key_of_letter(GLFW_KEY_GRAVE_ACCENT, "@"), GLFW_KEY_GRAVE_ACCENT);
}

}  // namespace
}  // namespace afterglow
