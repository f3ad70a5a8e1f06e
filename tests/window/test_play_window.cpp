// SPDX-License-Identifier: MIT
// `afterglow play` in a real window: Xvfb, lavapipe, validation, and a user made of xdotool.
#include <map>
#include <utility>

#include "play_window_test.h"

namespace afterglow {
namespace {
TEST_F(PlayWindow, EditsOnDiskAreSeenAndErrorsKeepTheLastGoodPicture) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.####.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  EXPECT_NE(window_title(xvfb_.display()).find("test look"), std::string::npos);

  write_preset("{ 0, 1, 0 }");
  EXPECT_TRUE(until_color(kX, kY, kGreen));

  std::ofstream(folder_ / "look.lua")
      << "local fx = require \"afterglow\"\nreturn fx.stack {\n  fx.color_adjustmentz { "
         "saturation = 1 },\n}\n";
  ASSERT_TRUE(program_->wait_for("look.lua:3"));
  EXPECT_TRUE(until([&] { return window_title(xvfb_.display()).find("(error)") != std::string::npos; }));
  const Color mark{255, 107, 97};  // the sheet's edge
  EXPECT_TRUE(until([&] { return count_color(shot(), mark) > 100; }));
  EXPECT_TRUE(has_color(shot(), kX, 0.2, kGreen));  // the last good picture

  write_preset("{ 0, 0, 1 }");
  EXPECT_TRUE(until_color(kX, kY, kBlue));
  EXPECT_TRUE(until([&] { return count_color(shot(), mark) == 0; }));
  EXPECT_EQ(window_title(xvfb_.display()).find("(error)"), std::string::npos);

  ASSERT_TRUE(user("mousemove 400 300 key q"));
  expect_clean_end();
}

TEST_F(PlayWindow, KeysStepPauseZoomAndWipe) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.####.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("position 0"));
  ASSERT_TRUE(user("mousemove 400 300 key Right"));
  EXPECT_TRUE(program_->wait_for("position 1"));
  ASSERT_TRUE(user("key End"));
  EXPECT_TRUE(program_->wait_for("position 2"));
  ASSERT_TRUE(user("key Home"));
  EXPECT_TRUE(program_->wait_for("position 0"));

  EXPECT_TRUE(until_color(kX, kY, kRed));
  ASSERT_TRUE(user("key w"));  // left of the middle lies what went in
  EXPECT_TRUE(until_color(0.1, kY, kGray));
  ASSERT_TRUE(user("key w"));
  EXPECT_TRUE(until_color(0.1, kY, kRed));

  const Screen fitted = shot();
  ASSERT_TRUE(user("key 1"));  // 64×40 pixels in the middle, the surroundings beside it
  EXPECT_TRUE(until_color(0.1, kY, {26, 26, 26}));
  EXPECT_TRUE(until([&] { return count_color(shot(), {188, 0, 0}) == 64 * 40; }));
  ASSERT_TRUE(user("key f"));
  EXPECT_TRUE(until_color(0.1, kY, kRed));

  ASSERT_TRUE(user("key y"));  // luminance of red: 0.2126 · 0.5
  EXPECT_TRUE(until([&] {
    const Screen s = shot();
    return has_color(s, kX, kY, {92, 92, 92});
  }));
  ASSERT_TRUE(user("key c key space"));
  EXPECT_TRUE(program_->wait_for("position 1"));  // it plays
  EXPECT_TRUE(program_->wait_for("position 2"));
  EXPECT_TRUE(program_->wait_for("position 0"));  // and loops
  ASSERT_TRUE(user("key ctrl+q"));
  expect_clean_end();
}

/// B is blue: by a border, in place of A, beside it, and how far they are apart.
TEST_F(PlayWindow, TwoPresetsAreComparedInFourWays) {
  write_preset("{ 0, 0, 1 }", "other.lua");
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.0001.exr", "--b", "other.lua"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  ASSERT_TRUE(user("mousemove 400 300 key w key w"));
  EXPECT_TRUE(until_color(0.1, kY, kBlue)) << "left of the border";
  EXPECT_TRUE(until_color(0.6, kY, kRed));
  ASSERT_TRUE(user("key e"));
  EXPECT_TRUE(until_color(0.6, kY, kBlue)) << "in its place";
  ASSERT_TRUE(user("key e"));
  EXPECT_TRUE(until_color(0.1, kY, kRed)) << "and back";
  ASSERT_TRUE(user("key v"));
  EXPECT_TRUE(until_color(0.1, kY, kBlue)) << "at the left";
  EXPECT_TRUE(until_color(0.6, kY, kRed)) << "at the right";
  ASSERT_TRUE(user("key d"));
  EXPECT_TRUE(until_color(0.1, kY, {188, 0, 188})) << "0.5 red against 0.5 blue";
  ASSERT_TRUE(user("key d"));
  EXPECT_TRUE(until_color(0.1, kY, kRed));
  std::ofstream(folder_ / "other.lua") << "return 1";
  EXPECT_TRUE(until([&] { return count_color(shot(), {255, 107, 97}) > 100; })) << "the edge of the error's sheet";
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

/// Over 64×40 pixels: a form leaves those whose middle lies in it, lines stand where the picture's parts end, and the
/// frame that is written has neither.
TEST_F(PlayWindow, LinesAndFormsLieOverThePicture) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.0001.exr", "--export", "out.exr"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  ASSERT_TRUE(user("mousemove 400 300 key 1 key shift+a"));
  const auto whole = [&](int pixels) { return until([&] { return count_color(shot(), kRed) == pixels; }); };
  EXPECT_TRUE(whole(64 * 26)) << "2.39:1: 26.8 rows";
  ASSERT_TRUE(user("key shift+a key shift+a"));
  EXPECT_TRUE(whole(64 * 36)) << "16:9";
  ASSERT_TRUE(user("key shift+a"));
  EXPECT_TRUE(whole(54 * 40)) << "4:3: 53.3 columns";
  ASSERT_TRUE(user("key shift+a"));
  EXPECT_TRUE(whole(40 * 40)) << "1:1";
  ASSERT_TRUE(user("key v"));
  EXPECT_TRUE(until([&] {
    const Screen both = shot();
    return count_color(both, kGray) == 40 * 40 && count_color(both, kRed) == 40 * 40;
  })) << "what went in at the left, the result at the right, each with the form";
  ASSERT_TRUE(user("key v key shift+g"));
  // Lines two pixels wide, light and dark: two columns and two rows that cross four times; in the middle a cross of
  // 16 × 16, which each of them crosses.
  constexpr int kLines = 4 * 2 * 40 - 4 * 2 * 2, kCross = 2 * 2 * 16 - 2 * 2 - 4 * 2 * 2;
  EXPECT_TRUE(whole(40 * 40 - kLines - kCross)) << "thirds";
  ASSERT_TRUE(user("key s"));
  ASSERT_TRUE(program_->wait_for("out.exr"));
  ASSERT_TRUE(until([&] { return fs::exists(folder_ / "out.exr"); }));
  Diagnostics nowhere;
  const auto written = read_picture(folder_ / "out.exr", {}, nowhere);
  ASSERT_TRUE(written) << written.error().text();
  for (std::size_t i = 0; i < written->color.pixels.size(); i += 4) {
    ASSERT_NEAR(written->color.pixels[i], 0.5f, 1e-3f) << i;
  }
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

TEST_F(PlayWindow, FollowsItsSizeAndTheDesktopsWishToClose) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.0001.exr"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  for (const char* size : {"600 400", "1100 700", "480 320", "1280 800"}) {
    ASSERT_TRUE(user(std::string("search --class afterglow windowsize ") + size));
  }
  EXPECT_TRUE(until_color(kX, kY, kRed));
  ASSERT_TRUE(ask_to_close(xvfb_.display()));
  expect_clean_end();
}

TEST_F(PlayWindow, ItsPictureIsWrittenOrItIsToldWhyNot) {
  write_preset("{ 1, 0, 0 }");
  const fs::path gone = folder_ / "gone";
  fs::create_directory(gone);
  program_ = std::make_unique<PlayedWindow>(
      xvfb_.display(), gone,
      std::vector<std::string>{(folder_ / "look.lua").string(), (folder_ / "shot.0001.exr").string()});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  ASSERT_TRUE(user("mousemove 400 300 key F12"));
  ASSERT_TRUE(program_->wait_for("window written to ./afterglow-"));
  EXPECT_FALSE(fs::is_empty(gone));
  fs::create_hard_link(gone / "printed.txt", folder_ / "said.txt");  // what the program says goes on there
  fs::remove_all(gone);
  ASSERT_TRUE(user("key F12"));
  EXPECT_TRUE(until([&] {
    const auto said = read_file(folder_ / "said.txt");
    return said && said->find("cannot be written") != std::string::npos;
  }));
  write_preset("{ 0, 1, 0 }");
  EXPECT_TRUE(until_color(kX, kY, kGreen)) << "and the window is still there";
  ASSERT_TRUE(ask_to_close(xvfb_.display()));
  expect_clean_end();
}

TEST_F(PlayWindow, TakesWhatIsDroppedOnIt) {
  write_preset("{ 1, 0, 0 }");
  write_preset("{ 0, 1, 0 }", "second.lua");
  write_picture_file("dark.exr", 0.0f);
  play({"look.lua", "shot.0001.exr"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  ASSERT_TRUE(drop_file(xvfb_.display(), folder_ / "second.lua"));
  EXPECT_TRUE(program_->wait_for("opened " + (folder_ / "second.lua").string()));
  EXPECT_TRUE(until_color(kX, kY, kGreen));
  ASSERT_TRUE(drop_file(xvfb_.display(), folder_ / "dark.exr"));
  EXPECT_TRUE(program_->wait_for("shown dark.exr"));
  EXPECT_TRUE(until_color(kX, kY, {0, 0, 0}));
  ASSERT_TRUE(ask_to_close(xvfb_.display()));
  expect_clean_end();
}

TEST_F(PlayWindow, APresetThatAppearsLater) {
  play({"./look.lua", "shot.0001.exr"});
  ASSERT_TRUE(program_->wait_for("look.lua"));
  write_preset("{ 0, 0, 1 }");
  EXPECT_TRUE(until_color(kX, kY, kBlue));
  ASSERT_TRUE(ask_to_close(xvfb_.display()));
  expect_clean_end();
}

TEST_F(PlayWindow, LosingTheDisplayEndsWithACleanErrorAndTheReport) {
  write_preset("{ 1, 0, 0 }");
  for (const bool playing : {false, true}) {
    std::vector<std::string> arguments{"look.lua", "shot.####.exr", "--stats", "--report", "play.json"};
    if (!playing) arguments.emplace_back("--paused");
    Xvfb display;
    ASSERT_TRUE(display.runs());
    program_ = std::make_unique<PlayedWindow>(display.display(), folder_, std::move(arguments));
    ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
    if (playing) {
      ASSERT_TRUE(program_->wait_for("shown shot.0003.exr"));
    }
    display.kill();
    EXPECT_EQ(program_->finish(), 5);
    EXPECT_NE(program_->printed().find("error: the connection to the display was lost"), std::string::npos);
    EXPECT_NE(program_->printed().find("frames: "), std::string::npos);
    const auto report = read_file(folder_ / "play.json");
    ASSERT_TRUE(report) << report.error().text();
    EXPECT_NE(report->find("the connection to the display was lost"), std::string::npos);
    fs::remove(folder_ / "play.json");
  }
}

/// Sets variables while it lives.
class Environment {
 public:
  explicit Environment(std::map<std::string, std::string> variables) : variables_(std::move(variables)) {
    for (const auto& [name, value] : variables_) setenv(name.c_str(), value.c_str(), 1);
  }
  ~Environment() {
    for (const auto& [name, value] : variables_) unsetenv(name.c_str());
  }

 private:
  std::map<std::string, std::string> variables_;
};

TEST_F(PlayWindow, ASurfaceThatIsLostIsMadeAnew) {
  for (const char* code : {"surface", "date"}) {
    for (int call = 1; call <= 8; ++call) {
      SCOPED_TRACE(std::string(code) + ", call " + std::to_string(call));
      write_preset("{ 1, 0, 0 }");
      {
        const Environment fault({{"VK_ADD_LAYER_PATH", AFTERGLOW_FAULT_LAYER_FOLDER},
                                 {"VK_INSTANCE_LAYERS", "VK_LAYER_AFTERGLOW_fault"},
                                 {"AFTERGLOW_FAULT_CODE", code},
                                 {"AFTERGLOW_FAULT_CALL", std::to_string(call)},
                                 {"AFTERGLOW_FAULT_LOG", (folder_ / "calls.log").string()}});
        play({"look.lua", "shot.####.exr", "--paused"});
      }
      ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
      EXPECT_TRUE(until_color(kX, kY, kRed));
      write_preset("{ 0, 1, 0 }");
      EXPECT_TRUE(until_color(kX, kY, kGreen));
      write_preset("{ 0, 0, 1 }");
      EXPECT_TRUE(until_color(kX, kY, kBlue));
      ASSERT_TRUE(user("mousemove 400 300 key q"));
      expect_clean_end();
      const auto calls = read_file(folder_ / "calls.log");
      ASSERT_TRUE(calls) << "the layer is not there";
      EXPECT_NE(calls->find("\n" + std::to_string(call + 1) + " "), std::string::npos) << "it never struck";
      fs::remove(folder_ / "calls.log");
    }
  }
}

TEST_F(PlayWindow, FillsTheScreenAndGoesBack) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.0001.exr"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  const auto has_size = [&](const std::string& size) {
    return until([&] {
      std::string geometry;
      run_on(xvfb_.display(), "xdotool search --class afterglow getwindowgeometry", &geometry);
      return geometry.find("Geometry: " + size) != std::string::npos;
    });
  };
  ASSERT_TRUE(user("search --class afterglow windowsize 600 400"));
  EXPECT_TRUE(has_size("600x400"));
  ASSERT_TRUE(user("mousemove 100 100 key F11"));
  EXPECT_TRUE(has_size("1280x800"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  ASSERT_TRUE(user("key Escape"));
  EXPECT_TRUE(has_size("600x400"));
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

TEST_F(PlayWindow, MinimisedItRestsAndComesBackWithTheLastEdit) {
  ASSERT_EQ(run_on(xvfb_.display(), "openbox --sm-disable >/dev/null &"), 0);  // ends with the display
  ASSERT_TRUE(until([&] { return user("get_num_desktops"); })) << "no window manager";
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.####.exr"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  EXPECT_TRUE(
      until([&] { return user("search --class afterglow windowminimize") && !has_color(shot(), kX, kY, kRed); }));
  write_preset("{ 0, 1, 0 }");
  ASSERT_TRUE(user("search --class afterglow windowactivate"));
  EXPECT_TRUE(until_color(kX, kY, kGreen));
  ASSERT_TRUE(user("mousemove 400 300 key q"));
  expect_clean_end();
}

TEST_F(PlayWindow, TheMessageCanBeCopied) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.0001.exr"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  std::ofstream(folder_ / "look.lua") << "local fx = require \"afterglow\"\nreturn fx.stack {\n  fx.blom { },\n}\n";
  ASSERT_TRUE(program_->wait_for("reload: failed"));
  ASSERT_TRUE(user("mousemove 400 300 key ctrl+c"));
  std::string copied;
  EXPECT_TRUE(until([&] {
    copied.clear();
    return run_on(xvfb_.display(), "timeout 5 xclip -selection clipboard -o", &copied) == 0 && !copied.empty();
  }));
  EXPECT_NE(copied.find("look.lua:3: error"), std::string::npos) << copied;
  EXPECT_NE(copied.find("fx.blom"), std::string::npos) << copied;
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

TEST_F(PlayWindow, TheWipeFollowsTheHand) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.0001.exr"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  ASSERT_TRUE(user("mousemove 400 300 key w"));
  EXPECT_TRUE(until_color(0.3, kY, kGray));
  const int middle = (1280 - 376) / 2;  // of the picture, which is as wide as the window without the panel
  ASSERT_TRUE(user("mousemove " + std::to_string(middle) + " 300"));
  ASSERT_TRUE(user("mousedown 1"));
  ASSERT_TRUE(user("mousemove 300 300"));
  ASSERT_TRUE(user("mousemove 200 300"));
  EXPECT_TRUE(until_color(0.3, kY, kRed));
  EXPECT_TRUE(has_color(shot(), 0.1, kY, kGray));
  ASSERT_TRUE(user("mouseup 1"));
  ASSERT_TRUE(user("mousemove 400 300 key q"));
  expect_clean_end();
}

TEST_F(PlayWindow, WhatIsTypedIntoTheSearchIsNoShortcut) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.0001.exr"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  Screen before = shot();
  ASSERT_TRUE(user("mousemove 400 300"));
  EXPECT_TRUE(until([&] { return shot().rgb != before.rgb; }));  // the pixel's values are shown
  EXPECT_TRUE(until([&] { return std::exchange(before, shot()).rgb == before.rgb; }));
  ASSERT_TRUE(user("key ctrl+f"));
  EXPECT_TRUE(until([&] { return shot().rgb != before.rgb; }));  // the cursor stands in the field
  ASSERT_TRUE(user("type gyq"));                                 // channels, and the end, if they were shortcuts
  ASSERT_TRUE(user("key Escape"));
  // Keys are shortcuts again, as soon as the field has seen it: 64×40 pixels in the middle.
  EXPECT_TRUE(until([&] { return user("key 1") && has_color(shot(), 0.1, kY, {26, 26, 26}); }));
  EXPECT_TRUE(until_color(0.353, 0.451, kRed)) << "all channels are shown";
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

/// A key that does something is not a word to the interface too: Tab does not choose a field, which would take what
/// follows.
TEST_F(PlayWindow, TabHidesThePanelAndTheNextKeyTheBar) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.0001.exr"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  ASSERT_TRUE(until_color(kX, kY, kRed));
  ASSERT_TRUE(user("key Tab t"));
  EXPECT_TRUE(until_color(0.5, 0.985, kRed)) << "the picture has the window's whole height";
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

TEST_F(PlayWindow, ArgumentsAreDraggedInThePanel) {
  std::ofstream(folder_ / "look.lua")
      << "local fx = require \"afterglow\"\n"
      << "local args = fx.args { level = fx.float { min = 0, max = 1, default = 0 } }\n"
      << "return fx.stack { fx.color_adjustments { color_filter = { 1 - args.level, args.level, 0 } } }\n";
  play({"look.lua", "shot.0001.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  EXPECT_TRUE(until([&] { return shows_handle(923); }));
  const int before = shot().at(950, 171)[0];
  ASSERT_TRUE(user("mousemove 923 171"));  // the slider is lit
  EXPECT_TRUE(until([&] { return shot().at(950, 171)[0] != before; }));
  // All in one go: the press is taken where it was made, however many frames later.
  ASSERT_TRUE(user("mousemove 923 171 mousedown 1 mousemove 1060 171 mousemove 1200 171"));
  EXPECT_TRUE(until_color(kX, kY, kGreen));
  ASSERT_TRUE(user("mouseup 1"));
  ASSERT_TRUE(user("mousemove 400 300 key ctrl+z"));
  EXPECT_TRUE(until_color(kX, kY, kRed)) << "one step of undo";
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

TEST_F(PlayWindow, DrawsNothingWhileNothingChanges) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.0001.exr"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  for (int i = 0; i < 8; ++i) shot();  // each takes many frames' time
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
  const std::string printed = program_->printed();
  const auto at = printed.find("window closed: ");
  ASSERT_NE(at, std::string::npos);
  EXPECT_LT(std::stoi(printed.substr(at + 15)), 60);
}

TEST_F(PlayWindow, WithoutADisplayItNamesHeadless) {
  write_preset("{ 1, 0, 0 }");
  program_ = std::make_unique<PlayedWindow>(":65000", folder_, std::vector<std::string>{"look.lua", "shot.0001.exr"});
  EXPECT_EQ(program_->finish(), 5);
  EXPECT_NE(program_->printed().find("--headless"), std::string::npos);
}

}  // namespace
}  // namespace afterglow
