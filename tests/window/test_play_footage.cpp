// SPDX-License-Identifier: MIT
// Footage that changes while it is played, and footage that is read smaller than it is, in a real window.
#include "play_window_test.h"

namespace afterglow {
namespace {

class PlayFootage : public PlayWindow {
 protected:
  /// Whole at once, as renderers should.
  void render(const std::string& name, const Light& light) {
    ASSERT_NO_FATAL_FAILURE(write_picture_file("next.exr", light));
    fs::rename(folder_ / "next.exr", folder_ / name);
  }
  void quit() {
    ASSERT_TRUE(user("key q"));
    expect_clean_end();
  }
};

/// A folder is its sequence. What is rendered once more, for the first time or behind the end comes in by itself.
TEST_F(PlayFootage, FramesThatAreRenderedMeanwhileComeIn) {
  write_preset("{ 1, 1, 1 }");
  fs::create_directories(folder_ / "seq");
  for (const char* name : {"seq/s.0001.exr", "seq/s.0003.exr"})
    ASSERT_NO_FATAL_FAILURE(render(name, {0.5f, 0.5f, 0.5f}));
  play({"look.lua", "seq", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown s.0001.exr: position 0"));
  EXPECT_TRUE(until_color(kX, kY, kGray));
  ASSERT_NO_FATAL_FAILURE(render("seq/s.0001.exr", {0.5f, 0, 0}));
  EXPECT_TRUE(until_color(kX, kY, kRed)) << "rendered once more";
  const Color missing{240, 196, 84};
  ASSERT_TRUE(user("mousemove 400 120 key Right"));
  ASSERT_TRUE(program_->wait_for("in place of frame 2"));
  EXPECT_TRUE(until([&] { return count_color(shot(), missing) > 2000; }));
  ASSERT_NO_FATAL_FAILURE(render("seq/s.0002.exr", {0, 0.5f, 0}));
  EXPECT_TRUE(until_color(kX, kY, kGreen)) << "no longer missing";
  EXPECT_TRUE(until([&] { return count_color(shot(), missing) == 0; }));
  ASSERT_NO_FATAL_FAILURE(render("seq/s.0004.exr", {0, 0, 0.5f}));
  EXPECT_TRUE(until([&] { return user("key End") && has_color(shot(), kX, kY, kBlue); })) << "the sequence is longer";
  ASSERT_TRUE(user("key Home"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  quit();
}

/// Columns of light and of none: a proxy of half the sides has their mean. What is written is whole.
TEST_F(PlayFootage, ProxiesAreShownAndWholePicturesWritten) {
  ASSERT_NO_FATAL_FAILURE(write_picture_file("columns.exr", [](int x, int) {
    const float level = x % 2 == 0 ? 0.5f : 0.0f;
    return Light{level, level, level};
  }));
  write_preset("{ 1, 1, 1 }");
  constexpr Color kMean{137, 137, 137};  // of 0.25
  play({"look.lua", "columns.exr", "--proxy", "1/2", "--export", "out.exr"});
  ASSERT_TRUE(program_->wait_for("shown columns.exr"));
  EXPECT_TRUE(until([&] { return count_color(shot(), kMean) > 300'000; }));
  ASSERT_TRUE(user("mousemove 400 120 key s"));
  ASSERT_TRUE(program_->wait_for("frame written to out.exr"));
  Diagnostics nowhere;
  const auto written = read_picture(folder_ / "out.exr", {}, nowhere);
  ASSERT_TRUE(written) << written.error().text();
  EXPECT_EQ(written->color.size(), (Size{64, 40}));
  EXPECT_NEAR(written->color.at(10, 10)[0], 0.5, 1e-3);
  EXPECT_NEAR(written->color.at(11, 10)[0], 0, 1e-3);
  ASSERT_TRUE(user("key shift+p"));
  EXPECT_TRUE(until([&] {
    const Screen screen = shot();
    return count_color(screen, kMean) < 1000 && count_color(screen, kGray) > 150'000;
  })) << "whole: columns again";
  ASSERT_TRUE(user("key shift+p"));
  EXPECT_TRUE(until([&] { return count_color(shot(), kMean) > 300'000; })) << "and back";
  quit();
}

}  // namespace
}  // namespace afterglow
