// SPDX-License-Identifier: MIT
// Presets are chosen from a list that shows the present frame through each.
#include "play_window_test.h"

namespace afterglow {
namespace {

class PlayPresets : public PlayWindow {
 protected:
  void open() {
    write_preset("{ 1, 1, 1 }");
    write_preset("{ 1, 0, 0 }", "zz_red.lua");
    write_preset("{ 0, 1, 0 }", "zz_green.lua");
    std::ofstream(folder_ / "zz_wrong.lua") << "return 1 +\n";
    play({"look.lua", "shot.0001.exr", "--paused"});
    ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
    ASSERT_TRUE(user("mousemove 400 300"));
    ASSERT_TRUE(until_color(kX, kY, kGray));
  }
  /// Pixels of the screen in that colour: a thumbnail has 64×40 of them.
  int pixels_of(const Color& color) { return count_color(shot(), color); }
  void quit() {
    ASSERT_TRUE(user("key q"));
    expect_clean_end();
  }
};

TEST_F(PlayPresets, AreShownWithThisFrameAndOpened) {
  ASSERT_NO_FATAL_FAILURE(open());
  EXPECT_EQ(pixels_of(kRed), 0);
  ASSERT_TRUE(user("key ctrl+o type zz_"));
  EXPECT_TRUE(until([&] { return pixels_of(kRed) > 2000 && pixels_of(kGreen) > 2000; })) << "both, small";
  ASSERT_TRUE(user("key Escape"));
  EXPECT_TRUE(until([&] { return pixels_of(kRed) == 0 && pixels_of(kGreen) == 0; })) << "Escape closes the list";
  EXPECT_TRUE(until_color(kX, kY, kGray)) << "and opens nothing";
  // By keys alone: the second of those that are called so (green, red, wrong).
  ASSERT_TRUE(user("key ctrl+o type zz_"));
  ASSERT_TRUE(user("key Down key Return"));
  ASSERT_TRUE(program_->wait_for("zz_red.lua"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  quit();
}

TEST_F(PlayPresets, ShiftOpensOneAsB) {
  ASSERT_NO_FATAL_FAILURE(open());
  ASSERT_TRUE(user("key ctrl+o type zz_gre"));
  ASSERT_TRUE(user("key shift+Return"));
  ASSERT_TRUE(program_->wait_for("zz_green.lua as B"));
  EXPECT_TRUE(until([&] {
    const Screen screen = shot();
    return count_color(screen, kGreen) > 10000 && count_color(screen, kGray) > 10000;
  })) << "one beside the other";
  quit();
}

TEST_F(PlayPresets, WhatIsNotSavedIsAskedAboutFirst) {
  ASSERT_NO_FATAL_FAILURE(open());
  ASSERT_TRUE(user("key Page_Down key ctrl+d"));
  ASSERT_TRUE(program_->wait_for("reload"));
  ASSERT_TRUE(user("key ctrl+o type zz_red"));
  ASSERT_TRUE(user("key Return"));
  EXPECT_TRUE(until([&] { return pixels_of(kRed) > 2000; }));
  EXPECT_FALSE(has_color(shot(), kX, kY, kRed)) << "not before it was confirmed";
  ASSERT_TRUE(user("key Escape"));
  ASSERT_TRUE(user("key Return key Return"));
  ASSERT_TRUE(program_->wait_for("zz_red.lua"));
  EXPECT_TRUE(until([&] { return pixels_of(kRed) > 100000; }));
  quit();
}

}  // namespace
}  // namespace afterglow
