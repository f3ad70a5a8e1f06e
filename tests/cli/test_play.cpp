// SPDX-License-Identifier: MIT
// `afterglow play --headless`: figures, pictures, what is refused, Ctrl-C.
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class Play : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    make_preset("look.lua");
    for (int frame = 1; frame <= 4; ++frame) make_exr("in/shot.000" + std::to_string(frame) + ".exr");
  }
  Outcome play(const std::vector<std::string>& more, RunOptions options = {}) const {
    std::vector<std::string> arguments{"play", "look.lua"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, options);
  }
  nlohmann::json report() const { return nlohmann::json::parse(read("play.json")); }
};

/// Has the process a handler for Ctrl-C yet?
bool handles_interrupts(int pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("SigCgt:")) return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1) & 1) != 0;
  return false;
}

TEST_F(Play, EveryFrameOnceWithFigures) {
  const Outcome outcome = play({"in/shot.####.exr", "--headless", "--fast", "--stats", "--report", "play.json"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("frames: 4 shown"));
  const auto json = report();
  EXPECT_EQ(json.at("frames").at("shown"), 4);
  EXPECT_EQ(json.at("frames").at("dropped"), 0);
  EXPECT_EQ(json.at("frames").at("last"), 4);
  EXPECT_EQ(json.at("footage").at("frames"), 4);
  EXPECT_EQ(json.at("playing").at("mode"), "fast");
  for (const char* row : {"interval", "work"})
    for (const char* figure : {"median", "p95", "p99", "max"})
      EXPECT_GE(json.at("milliseconds").at(row).at(figure).get<double>(), 0) << row << " " << figure;
  EXPECT_EQ(json.at("milliseconds").at("interval").at("count"), 2)
      << "from the second frame on: the first starts the clock";
}

TEST_F(Play, ByTheClockUntilSoManyWereShown) {
  const Outcome outcome = play({"in/shot.####.exr", "--headless", "--count", "6", "--fps", "50", "--loop", "ping-pong",
                                "--report", "play.json"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  const auto json = report();
  EXPECT_EQ(json.at("frames").at("shown"), 6);
  EXPECT_EQ(json.at("playing").at("mode"), "real time");
  EXPECT_EQ(json.at("playing").at("fps"), 50);
  EXPECT_EQ(json.at("playing").at("loop"), "ping-pong");
}

TEST_F(Play, OnePictureStandsStillHoweverLongItIsPlayed) {
  const Outcome outcome = play({"in/shot.0001.exr", "--headless", "--fast", "--count", "5", "--report", "play.json"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_EQ(report().at("frames").at("shown"), 1);
}

TEST_F(Play, TheScreenshotIsWhatRunWrites) {
  const std::vector<std::string> set{"--set", "tone_mapping.mode=reinhard"};
  ASSERT_EQ(run({"run", "look.lua", "in/shot.0003.exr", "-o", "run.exr", set[0], set[1]}).exit_code, kDone);
  const Outcome outcome =
      play({"in/shot.####.exr", "--frames", "2-3", "--headless", "--fast", "--screenshot", "play.exr", set[0], set[1]});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_EQ(read("play.exr"), read("run.exr"));
}

TEST_F(Play, VideosAndMissingFrames) {
  const std::string clip = std::string(AFTERGLOW_TEST_FOLDER) + "/images/video/clip";
  ASSERT_EQ(play({clip + ".mp4", "--headless", "--fast", "--report", "play.json"}).exit_code, kDone);
  EXPECT_EQ(report().at("frames").at("shown"), 24);
  EXPECT_EQ(report().at("playing").at("fps"), 24);
  ASSERT_EQ(play({clip + ".mkv", "--headless", "--fast", "--report", "play.json"}).exit_code, kDone);
  EXPECT_EQ(report().at("frames").at("shown"), 24);
  write("cut.mkv", read(clip + ".mkv").substr(0, 300));
  const Outcome refused = play({"cut.mkv", "--headless"});
  EXPECT_EQ(refused.exit_code, kFiles);
  EXPECT_TRUE(is_one_error_line(refused.err)) << refused.err;
  fs::remove(path("in/shot.0002.exr"));
  const Outcome holes = play({"in/shot.####.exr", "--headless", "--fast", "--report", "play.json"});
  EXPECT_EQ(holes.exit_code, kDone);
  EXPECT_THAT(holes.err, HasSubstr("1 frame is missing, the picture before is held: 2"));
  EXPECT_EQ(report().at("footage").at("missing").at(0), 2);
  EXPECT_EQ(report().at("frames").at("shown"), 4);
}

TEST_F(Play, FramesThatCannotBeReadAreCountedAndTheRestGoesOn) {
  make_truncated_exr("in/shot.0002.exr");
  const Outcome outcome = play({"in/shot.####.exr", "--headless", "--fast", "--report", "play.json"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("1 of 4 frames could not be read"));
  EXPECT_EQ(report().at("frames").at("shown"), 3);
  EXPECT_EQ(report().at("frames").at("unreadable"), 1);
}

TEST_F(Play, WrongRequestsSayWhatIsWrong) {
  write("broken.lua", "return 1");
  const struct {
    std::vector<std::string> arguments;
    int exit_code;
    const char* says;
  } kCases[] = {
      {{"look.lua", "none.exr", "--headless"}, kFiles, "none.exr: error: no such file"},
      {{"look.lua", "in/shot.####.exr", "--headless", "--loop", "pong"}, kUsage, "allowed: once, loop, ping-pong"},
      {{"look.lua", "in/shot.####.exr", "--headless", "--loop", "loop"}, kUsage, "--count N"},
      {{"look.lua", "in/shot.####.exr", "--headless", "--cache", "much"}, kUsage, "--cache: error: 'much'"},
      {{"look.lua", "in/shot.####.exr", "--headless", "--speed", "9"}, kUsage, "0.1 to 8"},
      {{"look.lua", "in/shot.####.exr", "--headless", "--fast", "--real-time"}, kUsage, "excludes"},
      {{"look.lua", "in/shot.####.exr", "--headless", "--frames", "4-1"}, kUsage, "bad frame list"},
      {{"look.lua", "in/shot.####.exr", "--headless", "--show", "tone_maping"},
       kUsage,
       "did you mean 'tone_mapping.aces'?"},
      {{"look.lua", "in/shot.####.exr", "--headless", "--b", "none.lua"}, kScript, "none.lua: error: no such file"},
      {{"look.lua", "in/shot.####.exr", "--headless", "--b", "broken.lua"}, kScript, "broken.lua"},
      {{"look.lua", "in/shot.####.exr", "--headless", "--screenshot", "a.xyz"}, kUsage, ".xyz"},
      {{"look.lua", "in/shot.####.exr", "--count", "3"}, kUsage, "go with --headless"},
      {{"broken.lua", "in/shot.####.exr", "--headless"}, kScript, "broken.lua"}};
  for (const auto& test : kCases) {
    std::vector<std::string> arguments{"play"};
    arguments.insert(arguments.end(), test.arguments.begin(), test.arguments.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, test.exit_code) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(test.says));
  }
}

TEST_F(Play, CtrlCEndsCleanly) {
  RunOptions options;
  bool sent = false;
  options.meanwhile = [&](int pid) {
    if (!handles_interrupts(pid)) return false;
    kill(pid, SIGINT);
    return sent = true;
  };
  const Outcome outcome =
      play({"in/shot.####.exr", "--headless", "--count", "100000000", "--report", "play.json"}, options);
  EXPECT_TRUE(sent);
  EXPECT_EQ(outcome.exit_code, kInterrupted);
  EXPECT_THAT(outcome.err, HasSubstr("interrupted"));
  EXPECT_TRUE(report().contains("error"));
}

/// Scripts find the reason in the report, whenever it comes.
TEST_F(Play, TheReportSaysWhatCameBeforeThePlaying) {
  const Outcome outcome = play({"nowhere.exr", "--headless", "--report", "play.json"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(report()["error"].get<std::string>(), HasSubstr("nowhere.exr"));
}

/// Passes that work at a part of the picture's size are shown like others.
TEST_F(Play, ShowsImagesOfAnySize) {
  make_exr("a.exr", 64, 48);
  const Outcome outcome = run({"play", preset("neon_night.lua").string(), "a.exr", "--headless", "--show",
                               "bloom.prefilter", "--screenshot", "a.png"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_EQ(pixels_of("a.png").size(), 32u * 24 * 4);
}

}  // namespace
}  // namespace afterglow::test
