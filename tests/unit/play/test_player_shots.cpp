// SPDX-License-Identifier: MIT
// Effects that look back, while frames are played: over dropped ones, jumps, clips and cuts.
#include <gtest/gtest.h>

#include "player_test.h"

namespace afterglow {
namespace {

class PlayerShots : public PlayerTest {
 protected:
  void SetUp() override {
    PlayerTest::SetUp();
    fs::create_directories(folder_ / "effects");
    fs::create_directories(folder_ / "shaders");
    // Counts the frames since the first that it saw.
    write(
        "effects/clock.lua",
        "local fx = require \"afterglow\"\nreturn fx.effect { name = \"clock\", doc = \"Counts.\", at = "
        "\"post_process\",\n  build = function(g, s, source)\n    local before = g:history { name = \"before\", size = "
        "{ 1, 1 } }\n    local now = g:pass { shader = \"count\", source = before, frames = g.frame_time * g.fps }\n"
        "    g:keep(before, now)\n    return g:pass { shader = \"show\", source = source, now = now }\n  end }\n");
    write("shaders/count.glsl", "uniform float frames;\nvec4 apply(vec4 color) { return color + frames; }\n");
    write("shaders/show.glsl",
          "uniform sampler2D now;\nvec4 apply(vec4 color) { return vec4(fetch(now, ivec2(0)).rgb, color.a); }\n");
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.clock {} }\n");
  }
  /// A picture that gets brighter from left to right, or from top to bottom.
  void write_ramp(int number, bool down) {
    Picture picture;
    picture.color = Image(kSize.width, kSize.height, 4);
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x)
        for (int c = 0; c < 4; ++c) picture.color.at(x, y)[c] = c == 3 ? 1 : static_cast<float>(1 + (down ? y : x));
    picture.data_window = picture.display_window = {0, 0, kSize.width, kSize.height};
    Diagnostics none;
    ASSERT_TRUE(write_picture(picture, path("s." + std::to_string(number) + ".exr"), {}, none));
  }
  /// What is counted in so many frames, one after the other.
  std::vector<float> played(Player& player, int frames) {
    turn();
    std::vector<float> out{result()};
    player.transport().play(seconds_);
    while (static_cast<int>(out.size()) < frames) {
      seconds_ += 0.1;
      turn();
      out.push_back(result());
    }
    return out;
  }
};

TEST_F(PlayerShots, GoOnOverDroppedFrames) {
  write_sequence(8);
  Player& player = open();
  turn();
  EXPECT_FLOAT_EQ(result(), 1);
  player.transport().play(seconds_);
  seconds_ += 0.1;
  turn();
  EXPECT_FLOAT_EQ(result(), 2);
  seconds_ += 0.3;
  turn();
  EXPECT_EQ(player.shown().number, 5);
  EXPECT_FLOAT_EQ(result(), 5) << "three frames have passed";
  player.transport().go_to(1, seconds_);
  turn();
  EXPECT_FLOAT_EQ(result(), 1) << "a jump begins anew";
}

TEST_F(PlayerShots, BeginAnewWhereTheyAreToldTo) {
  write_sequence(6);
  PlayerOptions options;
  options.footage.cuts = {.by = Cuts::By::frames, .frames = {3, 6}};
  Player& player = open(options);
  EXPECT_EQ(played(player, 6), (std::vector<float>{1, 2, 1, 2, 3, 1}));
  EXPECT_FLOAT_EQ(result(), 1);
  reload();
  EXPECT_FLOAT_EQ(result(), 1) << "the same frame, run again";
  player.transport().go_to(1, seconds_);
  turn();
  player.transport().play(seconds_);
  seconds_ += 0.2;
  turn();
  EXPECT_EQ(player.shown().number, 4);
  EXPECT_FLOAT_EQ(result(), 1) << "the cut was dropped";
}

TEST_F(PlayerShots, BeginAnewAtTheSecondFrame) {
  write_sequence(3);
  PlayerOptions options;
  options.footage.cuts = {.by = Cuts::By::frames, .frames = {2}};
  EXPECT_EQ(played(open(options), 3), (std::vector<float>{1, 1, 2}));
  options.footage.cuts = {.by = Cuts::By::each};
  EXPECT_EQ(played(open(options), 3), (std::vector<float>{1, 1, 1}));
}

/// What is held in the place of a missing frame is of the shot before.
TEST_F(PlayerShots, AMissingFrameBeginsNone) {
  write_sequence(6);
  fs::remove(path("s.3.exr"));
  PlayerOptions options;
  options.footage.cuts = {.by = Cuts::By::frames, .frames = {3}};
  EXPECT_EQ(played(open(options), 6), (std::vector<float>{1, 2, 3, 1, 2, 3}));
}

TEST_F(PlayerShots, AreSeenInThePictures) {
  for (int frame = 1; frame <= 6; ++frame) write_ramp(frame, frame > 3);
  PlayerOptions options;
  options.footage.cuts = {.by = Cuts::By::pictures};
  EXPECT_EQ(played(open(options), 6), (std::vector<float>{1, 2, 3, 1, 2, 3}));
  EXPECT_EQ(played(open(), 6), (std::vector<float>{1, 2, 3, 4, 5, 6})) << "pictures are not looked at unless asked";
}

TEST_F(PlayerShots, EndWithTheirClip) {
  write_sequence(4);
  fs::create_directories(folder_ / "other");
  for (const int frame : {3, 4})
    fs::rename(path("s." + std::to_string(frame) + ".exr"), path("other/s." + std::to_string(frame) + ".exr"));
  PlayerOptions options;
  options.footage.inputs = {path("s.#.exr"), path("other/s.#.exr")};
  EXPECT_EQ(played(open(options), 4), (std::vector<float>{1, 2, 1, 2})) << "though the numbers go on";
}

}  // namespace
}  // namespace afterglow
