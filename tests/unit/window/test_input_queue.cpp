// SPDX-License-Identifier: MIT
// What one frame of the interface is given: never a press whose place has moved on, never a press with its release.
#include <gtest/gtest.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "window/flow.h"
#include "window/frame_field.h"
#include "window/help_sheet.h"
#include "window/hover_help.h"
#include "window/input_queue.h"

namespace afterglow {
namespace {

using Kind = InputEvent::Kind;

InputEvent move(double x) { return {.kind = Kind::move, .x = x}; }
InputEvent button(bool down) { return {.kind = Kind::button, .down = down}; }
InputEvent key(int code, bool down, int mods = 0) {
  return {.kind = Kind::key, .code = code, .down = down, .mods = mods};
}
InputEvent text(unsigned c) { return {.kind = Kind::text, .text = c}; }

/// How many events each frame gets.
std::vector<int> frames(const std::vector<InputEvent>& events, bool typing) {
  InputQueue queue;
  for (const InputEvent& event : events) queue.push(event);
  std::vector<int> out;
  while (!queue.empty()) {
    out.push_back(0);
    while (queue.next(typing)) ++out.back();
    if (out.back() == 0) return {-1};
    queue.frame_done();
  }
  return out;
}

TEST(InputQueue, APressIsSeenWhereItHappened) {
  EXPECT_EQ(frames({move(1), button(true), move(2), move(3), button(false), move(4)}, false),
            (std::vector<int>{2, 3, 1}));
  EXPECT_EQ(frames({button(true), button(false), button(true), button(false)}, false), (std::vector<int>{1, 1, 1, 1}));
}

TEST(InputQueue, ShortcutsNeedNoFramesOfTheirOwn) {
  EXPECT_EQ(frames({key(GLFW_KEY_RIGHT, true), key(GLFW_KEY_RIGHT, false), key(GLFW_KEY_RIGHT, true)}, false),
            (std::vector<int>{3}));
}

TEST(InputQueue, AFieldGetsKeysAndTextInTheirOrder) {
  EXPECT_EQ(frames({key(GLFW_KEY_G, true), text('g'), key(GLFW_KEY_G, false), key(GLFW_KEY_Y, true), text('y')}, true),
            (std::vector<int>{5}));
  EXPECT_EQ(frames({text('g'), key(GLFW_KEY_BACKSPACE, true), text('y')}, true), (std::vector<int>{1, 1, 1}));
  EXPECT_EQ(frames({text('g'), key(GLFW_KEY_V, true, GLFW_MOD_CONTROL)}, true), (std::vector<int>{1, 1}));
  EXPECT_EQ(frames({key(GLFW_KEY_ESCAPE, true), key(GLFW_KEY_1, true)}, true), (std::vector<int>{1, 1}));
  EXPECT_EQ(frames({key(GLFW_KEY_ENTER, true), key(GLFW_KEY_ENTER, false)}, true), (std::vector<int>{1, 1}));
  // Let go and pressed again in one frame would be held all along.
  EXPECT_EQ(frames({key(GLFW_KEY_ENTER, true), key(GLFW_KEY_ENTER, false), key(GLFW_KEY_ENTER, true),
                    key(GLFW_KEY_ENTER, false)},
                   true),
            (std::vector<int>{1, 1, 1, 1}));
}

TEST(Flow, WhatFindsNoRoomBeginsTheNextRow) {
  const std::vector<float> widths{100, 50, 50, 200, 10}, gaps{10, 10, 10, 10, 10};
  EXPECT_EQ(rows_of(widths, gaps, 220), (std::vector<int>{0, 0, 0, 1, 1}));
  EXPECT_EQ(rows_of(widths, gaps, 1000), (std::vector<int>{0, 0, 0, 0, 0}));
  EXPECT_EQ(rows_of(widths, gaps, 1), (std::vector<int>{0, 1, 2, 3, 4}));
  const std::vector<float> near{99, 5, 5, 5, 5};
  EXPECT_EQ(rows_of(widths, near, 210), (std::vector<int>{0, 0, 0, 1, 2})) << "200 and 10 are 5 apart";
}

TEST(HelpSheet, ColumnsAreAsShortAsTheyCanBe) {
  const std::vector<HelpGroup> groups{{"a", 10}, {"b", 3}, {"c", 4}, {"d", 5}};
  const HelpLayout two = help_layout(groups, 2);
  EXPECT_EQ(two.column, (std::vector<int>{0, 1, 1, 1}));
  EXPECT_EQ(two.height, 12);
  const HelpLayout three = help_layout(groups, 3);
  EXPECT_EQ(three.height, 10);
  EXPECT_EQ(help_layout(groups, 1).height, 22);
  int lines = 0;
  for (const HelpGroup& group : help_groups()) lines += group.lines;
  EXPECT_GT(lines, 80);
  EXPECT_LE(help_layout(help_groups(), 2).height, lines * 6 / 10);
}

TEST(HoverHelp, ComesWhenThePointerRestsAndNeverWhileItDrags) {
  HoverHelp help;
  const ImVec2 item(10, 10), other(50, 10);
  const auto due = [&](ImVec2 at, float x, bool held, double now) {
    help.begin_frame();
    return help.due(at, {x, 12}, held, now);
  };
  EXPECT_FALSE(due(item, 11, false, 0));
  EXPECT_EQ(help.wake(), HoverHelp::kRest);
  EXPECT_FALSE(due(item, 12, false, 0.4)) << "it moves";
  EXPECT_FALSE(due(item, 12, false, 0.8));
  EXPECT_TRUE(due(item, 12, false, 0.9));
  EXPECT_TRUE(due(item, 13, false, 1.0)) << "it stays";
  EXPECT_FALSE(due(item, 13, true, 1.1));
  EXPECT_FALSE(due(item, 13, true, 9.0));
  EXPECT_FALSE(due(other, 51, false, 9.1));
  EXPECT_TRUE(due(other, 51, false, 9.6));
  help.begin_frame();
  help.begin_frame();
  EXPECT_FALSE(due(other, 51, false, 9.7)) << "it was away";
}

TEST(FrameField, NumbersStepsAndTimecodes) {
  const auto number = [](int at) { return 1001 + at + (at >= 5 ? 10 : 0); };  // a hole of ten
  const auto at = [&](const char* text) {
    return position_named(text, {.position = 4, .frames = 100, .clip_frames = 100, .fps = 23.976, .number = number})
        .value_or(-1);
  };
  EXPECT_EQ(at("1003"), 2);
  EXPECT_EQ(at(" 1005 "), 4);
  EXPECT_EQ(at("1008"), 5) << "the next one that is there";
  EXPECT_EQ(at("1"), 0);
  EXPECT_EQ(at("99999"), 99);
  EXPECT_EQ(at("+12"), 16);
  EXPECT_EQ(at("-12"), 0);
  EXPECT_EQ(at("00:00:01:06"), 30);
  EXPECT_EQ(at("2:3"), 51);
  for (const char* wrong : {"", "x", "12x", "1:x", "1:2:3:4:5", "+", "1:-2"}) EXPECT_EQ(at(wrong), -1) << wrong;
  // Clips count anew: 1001 to 1010, 1 to 10, 1001 to 1010.
  const auto counted = [](int i) { return (i / 10 == 1 ? 1 : 1001) + i % 10; };
  const auto in_clip = [&](int clip, const char* text) {
    return position_named(
        text, {.position = 10 * clip, .frames = 30, .clip_first = 10 * clip, .clip_frames = 10, .number = counted});
  };
  EXPECT_EQ(in_clip(1, "7"), 16);
  EXPECT_EQ(in_clip(0, "7"), 16) << "where another clip has it";
  EXPECT_EQ(in_clip(2, "1003"), 22) << "not that of the first clip";
  EXPECT_EQ(in_clip(1, "1003"), 2);
  EXPECT_EQ(in_clip(1, "500"), 19) << "its last one";
  EXPECT_EQ(timecode_text(51, 23.976), "00:00:02:03");
  EXPECT_EQ(timecode_text(24 * 3661 + 5, 24), "01:01:01:05");
}

}  // namespace
}  // namespace afterglow
