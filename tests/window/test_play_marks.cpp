// SPDX-License-Identifier: MIT
// Markers, clips in a row and whole sequences in a real window.
#include "play_window_test.h"

namespace afterglow {
namespace {

const Color kMarkerColor{110, 190, 255};

TEST_F(PlayWindow, MarkersAreSetNamedVisitedAndKept) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.####.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("position 0"));
  EXPECT_TRUE(until_color(kX, kY, kRed));
  EXPECT_EQ(count_color(shot(), kMarkerColor), 0);
  ASSERT_TRUE(user("mousemove 400 300 key shift+m"));
  EXPECT_TRUE(until([&] { return count_color(shot(), kMarkerColor) > 10; }));
  const int one = count_color(shot(), kMarkerColor);
  ASSERT_TRUE(user("key End"));
  ASSERT_TRUE(program_->wait_for("position 2"));
  ASSERT_TRUE(user("key ctrl+m"));
  ASSERT_TRUE(user("type 'the cut'"));
  ASSERT_TRUE(user("key Return"));
  EXPECT_TRUE(until([&] { return count_color(shot(), kMarkerColor) > one * 3 / 2; }));
  ASSERT_TRUE(user("key ctrl+Left"));
  EXPECT_TRUE(program_->wait_for("position 0"));
  ASSERT_TRUE(user("key ctrl+Right"));
  EXPECT_TRUE(program_->wait_for("position 2"));
  ASSERT_TRUE(user("key q"));
  expect_clean_end();

  std::string kept;
  for (const auto& entry : fs::recursive_directory_iterator(folder_))
    if (entry.path().parent_path().filename() == "markers") kept += read_file(entry.path()).value();
  EXPECT_EQ(kept, (fs::canonical(folder_) / "shot.####.exr").string() + "\n1 \n3 the cut\n");

  play({"look.lua", "shot.####.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("position 0"));
  EXPECT_TRUE(until([&] { return count_color(shot(), kMarkerColor) > one * 3 / 2; }));
  ASSERT_TRUE(user("key ctrl+Right"));
  EXPECT_TRUE(program_->wait_for("position 2"));
  const int two = count_color(shot(), kMarkerColor);
  ASSERT_TRUE(user("key shift+m"));  // taken away
  EXPECT_TRUE(until([&] { return count_color(shot(), kMarkerColor) < two - 10; }));
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

TEST_F(PlayWindow, AFrameOpensItsSequenceAndClipsFollowEachOther) {
  write_preset("{ 1, 0, 0 }");
  write_picture_file("still.exr", 0.5f);
  play({"look.lua", "shot.0002.exr"});
  ASSERT_TRUE(program_->wait_for("shown shot.0002.exr: position 1"));
  ASSERT_TRUE(user("mousemove 400 300 key Right"));
  EXPECT_TRUE(program_->wait_for("shown shot.0003.exr: position 2"));
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
  EXPECT_EQ(program_->printed().find("shown shot.0001"), std::string::npos) << "it stands at the frame";

  play({"look.lua", "shot.####.exr", "still.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr: position 0"));
  ASSERT_TRUE(user("mousemove 400 300 key ctrl+shift+Right"));
  EXPECT_TRUE(program_->wait_for("shown still.exr: position 3"));
  ASSERT_TRUE(user("key Left"));
  EXPECT_TRUE(program_->wait_for("shown shot.0003.exr: position 2"));
  ASSERT_TRUE(user("key ctrl+shift+Left"));
  EXPECT_TRUE(program_->wait_for("shown shot.0001.exr: position 0"));
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

/// A French keyboard: its A is where others have Q, which closes the window.
TEST_F(PlayWindow, LettersAreThoseOfTheKeyboard) {
  ASSERT_EQ(run_on(xvfb_.display(), "setxkbmap fr"), 0);
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.####.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  ASSERT_TRUE(user("mousemove 400 300 key a"));
  ASSERT_TRUE(user("key Right"));
  EXPECT_TRUE(program_->wait_for("position 1")) << "it has not closed";
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

}  // namespace
}  // namespace afterglow
