// SPDX-License-Identifier: MIT
// Ranges that a user exports from the window: what is written, with which look, and what is left of one that is
// cancelled.
#include "image/input_space.h"
#include "image/movie.h"
#include "play_window_test.h"

namespace afterglow {
namespace {

class PlayExport : public PlayWindow {
 protected:
  std::array<float, 4> pixel(const std::string& name) {
    Diagnostics nowhere;
    const auto picture = read_picture(folder_ / name, {}, nowhere);
    if (!picture) {
      ADD_FAILURE() << picture.error().text();
      return {};
    }
    std::array<float, 4> out{};
    std::copy_n(picture->color.at(10, 10), 4, out.begin());
    return out;
  }
  /// Files whose names begin so.
  int files(const std::string& begin) {
    int count = 0;
    for (const auto& file : fs::directory_iterator(folder_))
      count += file.path().filename().string().starts_with(begin);
    return count;
  }
  void open_many(int frames) {
    write_preset("{ 1, 0, 0 }");
    for (int frame = 4; frame <= frames; ++frame)
      fs::create_hard_link(folder_ / "shot.0001.exr", folder_ / fmt_name(frame));
    play({"look.lua", "shot.####.exr", "--paused"});
    ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  }
  static std::string fmt_name(int frame) {
    std::string number = std::to_string(frame);
    return "shot." + std::string(4 - number.size(), '0') + number + ".exr";
  }
  void begin_export(const std::string& name) {
    ASSERT_TRUE(user("mousemove 400 300 key ctrl+r type " + name));
    ASSERT_TRUE(user("key Return"));
    ASSERT_TRUE(program_->wait_for("export: begun"));
  }
};

TEST_F(PlayExport, TheRangeIsWrittenWithTheLookOfItsBeginning) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.####.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  ASSERT_TRUE(user("mousemove 400 300 key Right"));
  ASSERT_TRUE(program_->wait_for("position 1"));
  ASSERT_TRUE(user("key i"));
  // The file is broken meanwhile: what was on screen is what is exported.
  std::ofstream(folder_ / "look.lua") << "return {";
  ASSERT_TRUE(program_->wait_for("reload: failed"));
  ASSERT_NO_FATAL_FAILURE(begin_export("out.####.exr"));
  write_preset("{ 0, 1, 0 }");
  EXPECT_TRUE(program_->wait_for("export: 2 frames written to out.####.exr"));
  EXPECT_EQ(files("out."), 2);
  for (const char* name : {"out.0002.exr", "out.0003.exr"}) {
    EXPECT_NEAR(pixel(name)[0], 0.5, 1e-3) << name;
    EXPECT_NEAR(pixel(name)[1], 0, 1e-3) << name;
  }
  EXPECT_TRUE(until_color(kX, kY, kGreen)) << "and playing has gone on";
  // A second one over it is asked about; Escape writes nothing.
  ASSERT_TRUE(user("key ctrl+r type out.####.exr"));
  ASSERT_TRUE(user("key Return"));
  ASSERT_TRUE(user("key Escape"));
  ASSERT_TRUE(user("key p"));
  ASSERT_NO_FATAL_FAILURE(begin_export("all.####.exr"));
  EXPECT_TRUE(program_->wait_for("export: 3 frames written to all.####.exr"));
  EXPECT_NEAR(pixel("out.0002.exr")[0], 0.5, 1e-3) << "as it was";
  EXPECT_NEAR(pixel("all.0001.exr")[1], 0.5, 1e-3);
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

/// Two clips whose frames have the same numbers: the range of one is exported, of both it is told why not; a folder has
/// place for both.
TEST_F(PlayExport, OfSeveralClipsTheOneThatTheRangeIsIn) {
  write_preset("{ 1, 0, 0 }");
  for (const char* name : {"more.0001.exr", "more.0002.exr", "more.0003.exr"})
    ASSERT_NO_FATAL_FAILURE(write_picture_file(name, 0.25f));
  play({"look.lua", "shot.####.exr", "more.####.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  ASSERT_NO_FATAL_FAILURE(begin_export("out.####.exr"));
  ASSERT_TRUE(program_->wait_for("export: error: shot.0001.exr and more.0001.exr would both be written to "));
  ASSERT_NO_FATAL_FAILURE(begin_export("both/"));
  EXPECT_TRUE(program_->wait_for("export: 6 frames written to both/"));
  EXPECT_NEAR(pixel("both/more.0003.exr")[0], 0.25, 1e-3);
  // What lies in a folder is asked about, too.
  ASSERT_TRUE(user("key ctrl+r type both/"));
  ASSERT_TRUE(user("key Return"));
  ASSERT_TRUE(user("key Escape"));
  ASSERT_TRUE(user("key ctrl+shift+Right"));
  ASSERT_TRUE(program_->wait_for("shown more.0001.exr: position 3"));
  ASSERT_TRUE(user("key Right"));
  ASSERT_TRUE(program_->wait_for("shown more.0002.exr: position 4"));
  ASSERT_TRUE(user("key i"));
  ASSERT_NO_FATAL_FAILURE(begin_export("out.####.exr"));
  EXPECT_TRUE(program_->wait_for("export: 2 frames written to out.####.exr"));
  EXPECT_EQ(files("out."), 2);
  EXPECT_NEAR(pixel("out.0002.exr")[0], 0.25, 1e-3) << "of the second clip";
  EXPECT_NEAR(pixel("out.0003.exr")[0], 0.25, 1e-3);
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

TEST_F(PlayExport, OfASequenceTheFramesThatArePlayed) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.####.exr", "--frames", "2", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown shot.0002.exr"));
  ASSERT_NO_FATAL_FAILURE(begin_export("out.####.exr"));
  EXPECT_TRUE(program_->wait_for("export: 1 frames written to out.####.exr"));
  EXPECT_EQ(files("out."), 1) << "the others are there, but nobody asked for them";
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

/// In a video the frame before stands for one that is not there, as it does on screen.
TEST_F(PlayExport, MissingFramesAreHeldInAVideo) {
  write_preset("{ 1, 0, 0 }");
  for (const char* name : {"hole.0001.exr", "hole.0004.exr"}) ASSERT_NO_FATAL_FAILURE(write_picture_file(name, 0.25f));
  play({"look.lua", "hole.####.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown hole.0001.exr"));
  ASSERT_NO_FATAL_FAILURE(begin_export("out.mkv"));
  EXPECT_TRUE(program_->wait_for("export: 2 frames written to out.mkv"));
  Diagnostics nowhere;
  const auto movie = Movie::open(folder_ / "out.mkv", {}, nowhere);
  ASSERT_TRUE(movie) << movie.error().text();
  const auto& facts = (*movie)->facts();
  ASSERT_EQ(facts.pts.size(), 2u);
  const double unit = static_cast<double>(facts.time_base.numerator) / facts.time_base.denominator;
  EXPECT_NEAR(static_cast<double>(facts.pts[1] - facts.pts[0]) * unit, 3 / 24.0, 2e-3);
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

/// Of clips with other numbers each gives its own; single pictures are clips of one frame.
TEST_F(PlayExport, EachClipGivesItsOwnFrames) {
  write_preset("{ 1, 0, 0 }");
  for (const char* name : {"more.0004.exr", "more.0006.exr", "still.exr"})
    ASSERT_NO_FATAL_FAILURE(write_picture_file(name, 0.25f));
  play({"look.lua", "shot.####.exr", "more.####.exr", "still.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  ASSERT_NO_FATAL_FAILURE(begin_export("out/"));
  EXPECT_TRUE(program_->wait_for("export: 6 frames written to out/"));
  EXPECT_NEAR(pixel("out/shot.0003.exr")[0], 0.5, 1e-3);
  EXPECT_NEAR(pixel("out/more.0006.exr")[0], 0.25, 1e-3);
  EXPECT_NEAR(pixel("out/still.exr")[0], 0.25, 1e-3);
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

TEST_F(PlayExport, ChangesOfThePanelArePartOfIt) {
  write_preset("{ 1, 0, 0 }");
  play({"look.lua", "shot.####.exr", "--paused"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  ASSERT_TRUE(user("mousemove 400 300 key Page_Down key Delete"));
  ASSERT_TRUE(until_color(kX, kY, kGray));
  ASSERT_NO_FATAL_FAILURE(begin_export("out.####.exr"));
  EXPECT_TRUE(program_->wait_for("export: 3 frames written"));
  EXPECT_NEAR(pixel("out.0001.exr")[1], 0.5, 1e-3);
  ASSERT_TRUE(user("key q"));
  ASSERT_TRUE(program_->wait_for("asked whether to save"));
  ASSERT_TRUE(user("key d"));
  expect_clean_end();
}

TEST_F(PlayExport, PicturesAreReadAsTheyAreShown) {
  write_preset("{ 1, 1, 1 }");
  play({"look.lua", "shot.####.exr", "--paused", "--input-space", "logc3"});
  ASSERT_TRUE(program_->wait_for("shown shot.0001.exr"));
  ASSERT_NO_FATAL_FAILURE(begin_export("out.####.exr"));
  EXPECT_TRUE(program_->wait_for("export: 3 frames written"));
  EXPECT_NEAR(pixel("out.0002.exr")[1], find_input_space("logc3").value()->to_linear(0.5), 1e-3);
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

TEST_F(PlayExport, ClosingAsksAndLeavesNothingHalfWritten) {
  ASSERT_NO_FATAL_FAILURE(open_many(3000));
  ASSERT_NO_FATAL_FAILURE(begin_export("out.mp4"));
  ASSERT_TRUE(program_->wait_for("frames done"));
  ASSERT_TRUE(user("key q"));
  ASSERT_TRUE(program_->wait_for("asked whether to save"));
  ASSERT_TRUE(user("key d"));
  expect_clean_end();
  EXPECT_EQ(files("out"), 0) << "no video, and no part of one";
  EXPECT_EQ(files(".out"), 0);
}

/// To save is to wait for what is being written, with the window as it is.
TEST_F(PlayExport, ClosingCanWaitForTheEnd) {
  ASSERT_NO_FATAL_FAILURE(open_many(600));
  ASSERT_TRUE(user("mousemove 400 300 key Page_Down key Delete"));  // and a change that is not in the file
  ASSERT_TRUE(until_color(kX, kY, kGray));
  ASSERT_NO_FATAL_FAILURE(begin_export("out.mp4"));
  ASSERT_TRUE(program_->wait_for("frames done"));
  ASSERT_TRUE(user("key q"));
  ASSERT_TRUE(program_->wait_for("asked whether to save"));
  ASSERT_TRUE(user("key s"));
  expect_clean_end();
  EXPECT_NE(program_->printed().find("export: 600 frames written to out.mp4"), std::string::npos);
  Diagnostics nowhere;
  const auto movie = Movie::open(folder_ / "out.mp4", {}, nowhere);
  ASSERT_TRUE(movie) << movie.error().text();
  EXPECT_EQ((*movie)->facts().pts.size(), 600u);
  EXPECT_EQ(text_of("look.lua").find("color_adjustments"), std::string::npos);
}

/// Why it failed stays in the window, and the name that was typed is proposed again. Such a window stays open.
TEST_F(PlayExport, AFailureIsToldUntilItIsDismissed) {
  ASSERT_NO_FATAL_FAILURE(open_many(400));
  ASSERT_TRUE(user("mousemove 400 300 key ctrl+r type missing/out.####.exr"));
  ASSERT_TRUE(user("key Return"));
  ASSERT_TRUE(program_->wait_for("does not exist"));
  // Letters are thin: few of their pixels have all of the colour.
  const auto tells = [&] { return until([&] { return count_color(shot(), {255, 107, 97}) > 2; }); };
  EXPECT_TRUE(tells());
  fs::create_directory(folder_ / "missing");
  ASSERT_TRUE(user("key ctrl+r key Return"));
  ASSERT_TRUE(program_->wait_for("frames done"));
  fs::remove_all(folder_ / "missing");
  ASSERT_TRUE(user("key q"));
  ASSERT_TRUE(program_->wait_for("asked whether to save"));
  ASSERT_TRUE(user("key s"));
  ASSERT_TRUE(program_->wait_for("frames failed"));
  EXPECT_TRUE(tells());
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

TEST_F(PlayExport, TheButtonCancels) {
  ASSERT_NO_FATAL_FAILURE(open_many(3000));
  ASSERT_NO_FATAL_FAILURE(begin_export("out.####.exr"));
  ASSERT_TRUE(until([&] { return files("out.") > 0; }));
  EXPECT_TRUE(until([&] {
    return user("mousemove 860 661 click 1") && program_->printed().find("export cancelled") != std::string::npos;
  }));
  const int written = files("out.");
  EXPECT_GT(written, 0);
  EXPECT_LT(written, 3000);
  for (const auto& file : fs::directory_iterator(folder_))
    if (const std::string name = file.path().filename().string(); name.starts_with("out.")) {
      Diagnostics nowhere;
      EXPECT_TRUE(read_picture(file.path(), {}, nowhere)) << name << " is whole";
    }
  EXPECT_EQ(files(".out"), 0);
  ASSERT_TRUE(user("key q"));
  expect_clean_end();
}

}  // namespace
}  // namespace afterglow
