// SPDX-License-Identifier: MIT
// What a user changes in the window: values, their history, and what becomes of them when the file changes or the
// window is closed.
#include <nlohmann/json.hpp>

#include "play_window_test.h"

namespace afterglow {
namespace {

constexpr Color kColored{203, 89, 89}, kDull{126, 126, 126};  // sRGB codes of 0.6, 0.1 and of their luminance, 0.206

/// The panel shows one setting alone, that of the file, which takes the picture's colour away at -100.
class PlayEditing : public PlayWindow {
 protected:
  void write_look(const std::string& saturation) {
    std::ofstream(folder_ / "look.lua") << "local fx = require \"afterglow\"\n"
                                        << "return fx.stack {\n  name = \"test look\",\n"
                                        << "  fx.color_adjustments { hue_shift = 0.01, saturation = " << saturation
                                        << " },  -- mine\n}\n";
  }
  std::string text_of(const std::string& name) {
    const auto text = read_file(folder_ / name);
    return text ? *text : "";
  }
  std::string preset() { return text_of("look.lua"); }

  /// What follows Ctrl+F goes to the field, from the first letter on: some are shortcuts elsewhere.
  void open(const std::vector<std::string>& more = {}) {
    ASSERT_NO_FATAL_FAILURE(write_picture_file("colored.exr", Light{0.6f, 0.1f, 0.1f}));
    write_look("0");
    std::vector<std::string> arguments{"look.lua", "colored.exr"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    play(arguments);
    ASSERT_TRUE(program_->wait_for("shown colored.exr"));
    ASSERT_TRUE(until_color(kX, kY, kColored));
    ASSERT_TRUE(user("mousemove 400 300 key ctrl+f type saturation"));
    ASSERT_TRUE(user("key Return"));
    // The slider's handle, in the middle of the only row.
    ASSERT_TRUE(until([&] { return shows_handle(1004); })) << "the search has not found the setting alone";
  }
  /// Opens the field by a double click, and leaves it by a key.
  void type(const std::string& value, const std::string& key) {
    ASSERT_TRUE(user("mousemove 950 171 click --repeat 2 1"));
    ASSERT_TRUE(user("type -- " + value));
    ASSERT_TRUE(user("key " + key));
    ASSERT_TRUE(user("mousemove 400 300"));
  }
  void expect_color(const Color& color, const char* why) { EXPECT_TRUE(until_color(kX, kY, color)) << why; }
};

TEST_F(PlayEditing, ValuesAreTypedUndoneAndDoneAgain) {
  ASSERT_NO_FATAL_FAILURE(open());
  type("-100", "Escape");
  expect_color(kColored, "Escape takes nothing");
  type("-100", "Return");
  expect_color(kDull, "Enter takes what was typed");
  ASSERT_TRUE(user("key ctrl+z"));
  expect_color(kColored, "one step: the clicks are none");
  ASSERT_TRUE(user("key ctrl+shift+z"));
  expect_color(kDull, "redo");
  ASSERT_TRUE(user("key ctrl+z"));
  expect_color(kColored, "undo");
  type("-100", "Tab");
  expect_color(kDull, "Tab takes it too");
  ASSERT_TRUE(user("key q"));
  ASSERT_TRUE(program_->wait_for("asked whether to save"));
  ASSERT_TRUE(user("key d"));
  expect_clean_end();
  EXPECT_NE(preset().find("saturation = 0 }"), std::string::npos);
}

TEST_F(PlayEditing, SavingKeepsTheHistoryAndQuittingAsks) {
  ASSERT_NO_FATAL_FAILURE(open({"--report", "play.json"}));
  type("-100", "Return");
  expect_color(kDull, "typed");
  ASSERT_TRUE(user("key ctrl+s"));
  EXPECT_TRUE(until([&] { return preset().find("saturation = -100 },  -- mine") != std::string::npos; }));
  expect_color(kDull, "as the file has it now");
  // Nothing is unsaved once the new file is on screen; from then on undo goes back over the save.
  ASSERT_TRUE(program_->wait_for("reload"));
  EXPECT_TRUE(until([&] { return user("key ctrl+z") && has_color(shot(), kX, kY, kColored); })) << "over the save";
  ASSERT_TRUE(ask_to_close(xvfb_.display()));
  ASSERT_TRUE(program_->wait_for("asked whether to save"));
  ASSERT_TRUE(user("key Escape"));
  ASSERT_TRUE(user("key ctrl+shift+z"));
  expect_color(kDull, "it has not closed, and redo works");
  ASSERT_TRUE(user("key ctrl+z"));
  expect_color(kColored, "undo");
  ASSERT_TRUE(user("key q"));
  ASSERT_TRUE(program_->wait_for("asked whether to save"));
  ASSERT_TRUE(user("key s"));
  expect_clean_end();
  EXPECT_NE(preset().find("saturation = 0 },  -- mine"), std::string::npos) << preset();
  const auto report = nlohmann::json::parse(text_of("play.json"));
  EXPECT_GT(report.at("milliseconds").at("startup"), 0);
  EXPECT_GT(report.at("milliseconds").at("wall"), 0);
}

TEST_F(PlayEditing, WhatComesBehindASaveIsAskedAbout) {
  ASSERT_NO_FATAL_FAILURE(open());
  type("-100", "Return");
  expect_color(kDull, "typed");
  ASSERT_TRUE(user("key --delay 0 ctrl+s ctrl+z q"));
  ASSERT_TRUE(program_->wait_for("asked whether to save")) << "the undo is not in the file";
  ASSERT_TRUE(user("key s"));
  expect_clean_end();
  EXPECT_NE(preset().find("saturation = 0 },  -- mine"), std::string::npos) << preset();
}

TEST_F(PlayEditing, TheFileAndThePanelDisagree) {
  ASSERT_NO_FATAL_FAILURE(open());
  type("-100", "Return");
  expect_color(kDull, "typed");
  write_look("100");
  // Thin letters have few pixels of the very colour: those near it count.
  const auto amber = [&] {
    const Screen screen = shot();
    int count = 0;
    for (std::size_t i = 0; i + 2 < screen.rgb.size(); i += 3)
      count += screen.rgb[i] > 200 && screen.rgb[i + 1] > 160 && screen.rgb[i + 1] < 210 && screen.rgb[i + 2] < 100;
    return count;
  };
  int told = 0;
  EXPECT_TRUE(until([&] { return (told = amber()) > 60; })) << "both values are told";
  expect_color(kDull, "the panel's stays");
  ASSERT_TRUE(user("key ctrl+s"));
  EXPECT_TRUE(until([&] { return amber() > told + 60; })) << "why nothing was written";
  EXPECT_NE(preset().find("saturation = 100 }"), std::string::npos);
  ASSERT_TRUE(user("mousemove 960 217 click 1"));  // keep mine
  EXPECT_TRUE(until([&] {
    return user("mousemove 400 300 key ctrl+s") && preset().find("saturation = -100 }") != std::string::npos;
  }));
  ASSERT_TRUE(user("key ctrl+q"));
  expect_clean_end();
}

TEST_F(PlayEditing, WhileTheFileHasAnErrorSettingsRest) {
  ASSERT_NO_FATAL_FAILURE(open());
  std::ofstream(folder_ / "look.lua") << "return {";
  ASSERT_TRUE(program_->wait_for("reload: failed"));
  EXPECT_TRUE(until([&] { return count_color(shot(), {255, 107, 97}) > 100; }));
  ASSERT_TRUE(user("mousemove 1004 191 mousedown 1 mousemove 920 191 mouseup 1"));
  ASSERT_TRUE(user("mousemove 1004 171 mousedown 1 mousemove 920 171 mouseup 1"));
  ASSERT_TRUE(user("mousemove 400 300"));
  // Keys act in their turn: once this one has, the drags are over.
  ASSERT_TRUE(user("key ctrl+c"));
  std::string copied;
  EXPECT_TRUE(until([&] {
    copied.clear();
    return run_on(xvfb_.display(), "timeout 5 xclip -selection clipboard -o", &copied) == 0 && !copied.empty();
  }));
  expect_color(kColored, "the last good picture");
  write_look("-100");
  expect_color(kDull, "mended");
  ASSERT_TRUE(user("key q"));
  expect_clean_end();  // and nothing was asked: there is no change
}

TEST_F(PlayEditing, MissingAndUnreadableFramesAreMarked) {
  write_preset("{ 1, 0, 0 }");
  fs::remove(folder_ / "shot.0002.exr");
  fs::resize_file(folder_ / "shot.0003.exr", fs::file_size(folder_ / "shot.0003.exr") / 2);
  play({"look.lua", "shot.####.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  const Color missing{240, 196, 84}, unreadable{255, 107, 97};
  EXPECT_TRUE(until([&] { return count_color(shot(), unreadable) > 10; })) << "on the timeline, before it is shown";
  ASSERT_TRUE(user("mousemove 400 300 key Right"));
  EXPECT_TRUE(program_->wait_for("shown shot.0001.exr: position 1"));
  EXPECT_TRUE(program_->wait_for("in place of frame 2"));
  EXPECT_TRUE(until([&] { return count_color(shot(), missing) > 2000; })) << "around the picture";
  ASSERT_TRUE(user("key End"));
  EXPECT_TRUE(program_->wait_for("unreadable shot.0003.exr: position 2"));
  EXPECT_TRUE(until([&] { return count_color(shot(), unreadable) > 2000; })) << "around the picture";
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

TEST_F(PlayEditing, AnInputThatIsNotThereIsNoWindow) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "none.exr"});
  EXPECT_EQ(program_->finish(), 4);
  EXPECT_NE(program_->printed().find("none.exr: error: no such file"), std::string::npos);
}

TEST_F(PlayEditing, FramesAreGoneToShuttledAndWritten) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.####.exr", "--paused", "--export", "out.####.exr"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  ASSERT_TRUE(user("mousemove 400 300 key ctrl+g type 3"));
  ASSERT_TRUE(user("key Return"));
  EXPECT_TRUE(program_->wait_for("position 2"));
  ASSERT_TRUE(user("key ctrl+g type -- -1"));
  ASSERT_TRUE(user("key Return"));
  EXPECT_TRUE(program_->wait_for("position 1"));
  ASSERT_TRUE(user("key s"));
  EXPECT_TRUE(program_->wait_for("frame written to out.0002.exr"));
  Diagnostics nowhere;
  const auto written = read_picture(folder_ / "out.0002.exr", {}, nowhere);
  ASSERT_TRUE(written) << written.error().text();
  EXPECT_EQ(written->color.size(), (Size{64, 40})) << "the picture, not the window";
  EXPECT_NEAR(written->color.at(10, 10)[0], 0.5, 1e-3);
  EXPECT_NEAR(written->color.at(10, 10)[1], 0, 1e-3);
  ASSERT_TRUE(user("key j"));  // backwards, over the loop
  EXPECT_TRUE(program_->wait_for("position 0"));
  EXPECT_TRUE(program_->wait_for("position 2"));
  EXPECT_TRUE(program_->wait_for("position 1"));
  ASSERT_TRUE(user("key l"));
  EXPECT_TRUE(program_->wait_for("position 1"));
  EXPECT_TRUE(program_->wait_for("position 2"));
  ASSERT_TRUE(user("key k key Home"));
  EXPECT_TRUE(program_->wait_for("position 0"));
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

}  // namespace
}  // namespace afterglow
