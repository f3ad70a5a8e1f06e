// SPDX-License-Identifier: MIT
// --resume: what is made again, and what is not.
#include "sequence_test.h"

namespace afterglow::test {
namespace {

using ::testing::ElementsAre;

class Resume : public Sequence {
 protected:
  /// States of the frames when the run is gone on with.
  std::vector<std::string> resumed(std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"--resume", "--report", "report.json"});
    const Outcome outcome = run_all(more);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return states("report.json");
  }
  /// A table that multiplies by a number.
  void make_table(const std::string& name, const std::string& factor) const {
    write(name, "LUT_1D_SIZE 2\n0 0 0\n" + factor + " " + factor + " " + factor + "\n");
  }
};

TEST_F(Resume, SkipsWhatIsDone) {
  ASSERT_EQ(run_all({"--frames", "1-2"}).exit_code, kDone);
  const Outcome outcome = run_all({"--resume", "--report", "report.json"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(states("report.json"), ElementsAre("up to date", "up to date", "done", "done"));
}

TEST_F(Resume, SeesOtherArguments) {
  write("look.lua",
        "local fx = require \"afterglow\"\n"
        "local args = fx.args { stops = fx.float { default = 0 } }\n"
        "return fx.stack { fx.color_adjustments { post_exposure = args.stops } }\n");
  ASSERT_EQ(run_all({"--arg", "stops=1", "--frames", "1-2"}).exit_code, kDone);
  ASSERT_EQ(run_all({"--arg", "stops=1", "--frames", "1-2", "--resume", "--report", "report.json"}).exit_code, kDone);
  EXPECT_THAT(states("report.json"), ElementsAre("up to date", "up to date"));
  ASSERT_EQ(run_all({"--arg", "stops=2", "--frames", "1-2", "--resume", "--report", "report.json"}).exit_code, kDone);
  EXPECT_THAT(states("report.json"), ElementsAre("done", "done"));
}

TEST_F(Resume, SeesNewInputsLooksAndOptions) {
  ASSERT_EQ(run_all().exit_code, kDone);
  // A touched input.
  fs::last_write_time(path("in/shot.0003.exr"), fs::file_time_type::clock::now() + std::chrono::hours(1));
  ASSERT_EQ(run_all({"--resume", "--report", "report.json"}).exit_code, kDone);
  EXPECT_THAT(states("report.json"), ElementsAre("up to date", "up to date", "done", "up to date"));
  fs::last_write_time(path("in/shot.0003.exr"), fs::last_write_time(path("in/shot.0002.exr")));
  // An override.
  ASSERT_EQ(run_all({"--resume", "--set", "tone_mapping.mode=neutral", "--report", "report.json"}).exit_code, kDone);
  EXPECT_THAT(states("report.json"), ElementsAre("done", "done", "done", "done"));
  // The preset itself.
  write("look.lua", read("look.lua") + "-- a change\n");
  ASSERT_EQ(run_all({"--resume", "--set", "tone_mapping.mode=neutral", "--report", "report.json"}).exit_code, kDone);
  EXPECT_THAT(states("report.json"), ElementsAre("done", "done", "done", "done"));
  // An output that is gone.
  fs::remove(path("out/shot.0001.png"));
  ASSERT_EQ(run_all({"--resume", "--set", "tone_mapping.mode=neutral", "--report", "report.json"}).exit_code, kDone);
  EXPECT_THAT(states("report.json"), ElementsAre("done", "up to date", "up to date", "up to date"));
}

TEST_F(Resume, SeesThatAnOutputWasMadeOtherwiseSince) {
  ASSERT_EQ(run_all().exit_code, kDone);
  const std::string note = read("out/.afterglow/shot.0003.png.made");
  // A run of one frame leaves no note.
  ASSERT_EQ(run_all({"--frames", "2", "--set", "tone_mapping.mode=neutral"}).exit_code, kDone);
  EXPECT_THAT(resumed(), ElementsAre("up to date", "done", "up to date", "up to date"));
  // As if the run had been killed between an output and its note.
  ASSERT_EQ(run_all({"--frames", "3-4", "--set", "tone_mapping.mode=neutral"}).exit_code, kDone);
  write("out/.afterglow/shot.0003.png.made", note);
  EXPECT_THAT(resumed(), ElementsAre("up to date", "up to date", "done", "done"));
  // By hand.
  write("out/shot.0001.png", "");
  EXPECT_THAT(resumed(), ElementsAre("done", "up to date", "up to date", "up to date"));
  EXPECT_FALSE(read("out/shot.0001.png").empty());
  for (const char* broken : {"", "\n", "output", "0123456789abcdef0123456789abcdef\n"}) {
    write("out/.afterglow/shot.0003.png.made", broken);
    EXPECT_THAT(resumed(), ElementsAre("up to date", "up to date", "done", "up to date")) << broken;
  }
}

TEST_F(Resume, SeesInputsThatAreOlder) {
  ASSERT_EQ(run_all().exit_code, kDone);
  make_exr("in/shot.0002.exr", 32, 18);
  fs::last_write_time(path("in/shot.0002.exr"), fs::file_time_type::clock::now() - std::chrono::hours(1));
  EXPECT_THAT(resumed(), ElementsAre("up to date", "done", "up to date", "up to date"));
}

TEST_F(Resume, KnowsTheTableOfEachFrame) {
  make_table("odd.cube", "1");
  make_table("even.cube", "0.5");
  write("look.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.stack { fx.lut { file = function(t) return t.frame % 2 == 0 and \"even.cube\" or \"odd.cube\" end } "
        "}\n");
  ASSERT_EQ(run_all({"--frames", "1-3x2"}).exit_code, kDone);
  ASSERT_EQ(run_all({"--frames", "2,4"}).exit_code, kDone);
  EXPECT_THAT(resumed(), ElementsAre("up to date", "up to date", "up to date", "up to date"));
  make_table("even.cube", "0.25");
  EXPECT_THAT(resumed(), ElementsAre("up to date", "done", "up to date", "done"));
  // One that is found before the other.
  make_table("first/odd.cube", "0.75");
  write("first/look.lua", read("look.lua"));
  fs::rename(path("look.lua"), path("look.old"));
  const auto from = [&](const std::string& look) {
    std::vector<std::string> words{"run", look, "in/shot.####.exr", "-o", "out/shot.####.png"};
    for (const char* more : {"--path", ".", "--resume", "--report", "report.json"}) words.emplace_back(more);
    EXPECT_EQ(run(words).exit_code, kDone);
    return states("report.json");
  };
  from("first/look.lua");
  make_table("first/even.cube", "0.75");
  EXPECT_THAT(from("first/look.lua"), ElementsAre("up to date", "done", "up to date", "done"));
}

// What comes behind a frame that failed has another history than it would have: it is made again when the frame is
// there.
TEST_F(Resume, MakesAgainWhatFollowsAGapInTheHistory) {
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.auto_exposure {} }\n");
  const std::string name = "in/shot.0002.exr", good = read(name);
  const auto time = fs::last_write_time(path(name));
  const auto put = [&](const std::string& bytes) {
    write(name, bytes);
    fs::last_write_time(path(name), time);  // as of a server that was away for a moment
  };
  for (const std::string& broken :
       {std::string(good.size(), 'x'), good.substr(0, 400) + std::string(good.size() - 400, 'x')}) {
    put(broken);
    fs::remove(path("out/shot.0002.png"));
    EXPECT_EQ(run_all().exit_code, kFiles);
    put(good);
    EXPECT_THAT(resumed(), ElementsAre("up to date", "done", "done", "done"));
    EXPECT_THAT(resumed(), ElementsAre("up to date", "up to date", "up to date", "up to date"));
  }
}

TEST_F(Resume, ReadsFilesOfAnySize) {
  make_exr("dirt.exr");
  fs::resize_file(path("dirt.exr"), (64u << 20) + 1);  // what lies behind a picture does not matter to it
  write(
      "look.lua",
      "local fx = require \"afterglow\"\n"
      "return fx.stack { fx.color_adjustments { post_exposure = 1, mask = fx.mask.file { file = \"dirt.exr\" } } }\n");
  ASSERT_EQ(run_all({"--lock", "look.lock"}).exit_code, kDone);
  EXPECT_EQ(run_all({"--locked", "look.lock"}).exit_code, kDone);
  EXPECT_THAT(resumed(), ElementsAre("up to date", "up to date", "up to date", "up to date"));
}

}  // namespace
}  // namespace afterglow::test
