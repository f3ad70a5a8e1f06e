// SPDX-License-Identifier: MIT
// What AFTERGLOW_EDITOR says, as a call.
#include <gtest/gtest.h>

#include <cstdlib>

#include "window/editor.h"

namespace afterglow {
namespace {

using Words = std::vector<std::string>;

TEST(Editor, CallsAreWordsWithFileAndLine) {
  const auto call = [](const char* command, int line = 12) {
    return editor_call(command, "/looks/my {line} look.lua", line).value();
  };
  const std::string file = "/looks/my {line} look.lua";
  EXPECT_EQ(call("code -g {file}:{line}"), (Words{"code", "-g", file + ":12"}));
  EXPECT_EQ(call("gvim"), (Words{"gvim", "+12", file}));
  EXPECT_EQ(call("  emacs \t -nw"), (Words{"emacs", "-nw", "+12", file}));
  EXPECT_EQ(call("'/opt/my editor' \"--at={line}\" {file}"), (Words{"/opt/my editor", "--at=12", file}));
  EXPECT_EQ(call("edit {file}", 0), (Words{"edit", file}));
  EXPECT_EQ(call("edit", 0), (Words{"edit", "+1", file})) << "no line is known: the first";
}

TEST(Editor, WhatIsNoCallIsRefused) {
  for (const char* command : {"", "   ", "''"}) {
    const auto call = editor_call(command, "look.lua", 1);
    ASSERT_FALSE(call) << command;
    EXPECT_EQ(call.error().file, "AFTERGLOW_EDITOR");
    EXPECT_EQ(call.error().kind, ErrorKind::usage);
  }
  EXPECT_NE(editor_call("code '{file}", "look.lua", 1).error().message.find("quote"), std::string::npos);
  unsetenv("AFTERGLOW_EDITOR");
  EXPECT_NE(open_in_editor("look.lua", 1).error().allowed.find("{file}"), std::string::npos);
  setenv("AFTERGLOW_EDITOR", "/nowhere/editor", 1);
  const auto missing = open_in_editor("look.lua", 1);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().kind, ErrorKind::io);
  EXPECT_NE(missing.error().message.find("'/nowhere/editor' cannot be started: No such file"), std::string::npos);
}

}  // namespace
}  // namespace afterglow
