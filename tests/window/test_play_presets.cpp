// SPDX-License-Identifier: MIT
// Presets are chosen from a list that shows the present frame through each, effects from one that shows it with them.
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
  /// The same once the screen no longer changes: what is told of the pointer's place comes a frame behind it.
  int settled_pixels_of(const Color& color) {
    int count = -1, same = 0;
    until([&] {
      const int now = pixels_of(color);
      same = now == count ? same + 1 : 0;
      count = now;
      return same == 3;
    });
    return count;
  }
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

/// Dropped, saved or thrown away: what is not in the file is asked about first here too.
TEST_F(PlayPresets, OneThatIsDroppedAsksFirst) {
  ASSERT_NO_FATAL_FAILURE(open());
  const std::string before = text_of("look.lua");
  ASSERT_TRUE(user("key Page_Down key ctrl+d"));
  ASSERT_TRUE(program_->wait_for("reload 3: taken"));
  ASSERT_TRUE(drop_file(xvfb_.display(), folder_ / "zz_red.lua"));
  ASSERT_TRUE(program_->wait_for("asked whether to save"));
  ASSERT_TRUE(user("key Escape key ctrl+z key ctrl+shift+z"));  // it is still the same preset
  ASSERT_TRUE(drop_file(xvfb_.display(), folder_ / "zz_red.lua"));
  ASSERT_TRUE(program_->wait_for("asked whether to save"));
  EXPECT_FALSE(has_color(shot(), kX, kY, kRed));
  ASSERT_TRUE(user("key d"));
  ASSERT_TRUE(program_->wait_for("zz_red.lua"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  EXPECT_EQ(text_of("look.lua"), before);

  const std::string red = text_of("zz_red.lua");
  ASSERT_TRUE(user("key Page_Down key ctrl+d"));
  ASSERT_TRUE(program_->wait_for(": taken"));
  ASSERT_TRUE(drop_file(xvfb_.display(), folder_ / "zz_green.lua"));
  ASSERT_TRUE(program_->wait_for("asked whether to save"));
  ASSERT_TRUE(user("key s"));
  ASSERT_TRUE(program_->wait_for("zz_green.lua"));
  EXPECT_TRUE(until_color(kX, kY, kGreen));
  EXPECT_GT(text_of("zz_red.lua").size(), red.size()) << "saved before it was left";
  quit();
}

/// The present frame as it is, and with the effect that is chosen: small, before anything is added.
TEST_F(PlayPresets, EffectsAreShownWithThisFrame) {
  fs::create_directories(folder_ / "effects");
  fs::create_directories(folder_ / "shaders" / "zz_blue");
  std::ofstream(folder_ / "effects" / "zz_blue.lua")
      << "local fx = require \"afterglow\"\nreturn fx.effect { name = \"zz_blue\", settings = {},\n"
      << "  build = function(g, s, source) return g:pass { shader = \"zz_blue/blue\", source = source } end }\n";
  std::ofstream(folder_ / "shaders" / "zz_blue" / "blue.glsl")
      << "vec4 apply(vec4 c) {\n  return vec4(0.0, 0.0, c.b, c.a);\n}\n";
  ASSERT_NO_FATAL_FAILURE(open());
  const int plain = settled_pixels_of(kGray);
  ASSERT_TRUE(user("key ctrl+a type zz_bl"));
  EXPECT_TRUE(until([&] { return pixels_of(kBlue) > 2000; })) << "64×40 pixels with it";
  EXPECT_LT(pixels_of(kBlue), 10'000) << "the picture is as it was";
  EXPECT_GT(pixels_of(kGray), 2000) << "and beside it without";
  EXPECT_TRUE(text_of("look.lua").find("zz_blue") == std::string::npos);
  ASSERT_TRUE(user("key Escape"));
  EXPECT_TRUE(until([&] { return pixels_of(kBlue) == 0 && pixels_of(kGray) == plain; }));
  ASSERT_TRUE(user("key ctrl+a type zz_bl"));
  ASSERT_TRUE(user("key Return"));
  EXPECT_TRUE(until_color(kX, kY, kBlue)) << "added";
  ASSERT_TRUE(user("key q"));
  ASSERT_TRUE(program_->wait_for("asked whether to save"));
  ASSERT_TRUE(user("key d"));
  expect_clean_end();
}

}  // namespace
}  // namespace afterglow
