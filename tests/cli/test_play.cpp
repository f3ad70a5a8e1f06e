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

TEST_F(Play, BackwardsEveryFrameOnce) {
  const Outcome outcome = play({"in/shot.####.exr", "--headless", "--fast", "--speed", "-1", "--report", "play.json"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_EQ(report().at("frames").at("shown"), 4);
  EXPECT_EQ(report().at("frames").at("last"), 1);
}

TEST_F(Play, APassThatMakesNanIsNamed) {
  write("effects/root.lua",
        "local fx = require \"afterglow\"\nreturn fx.effect { name = \"root\", doc = \"Roots.\", at = "
        "\"post_process\", build = function(g, s, source)\n  return g:pass { shader = \"root\", source = source }\n"
        "end }\n");
  write("shaders/root.glsl", "vec4 apply(vec4 color) { return vec4(sqrt(color.rgb - 1e6), color.a); }\n");
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.root {} }\n");
  const Outcome outcome = play({"in/shot.####.exr", "--headless", "--fast", "--report", "play.json"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("effects/root.lua:3: pass 'root.root' made "));
  EXPECT_THAT(outcome.err, HasSubstr("shown as 0, in shot.0004.exr"));
  const auto found = report().at("non_finite");
  EXPECT_EQ(found.at("frame"), 4);
  EXPECT_EQ(found.at("picture"), "shot.0004.exr");
  EXPECT_EQ(found.at("passes").at(0).at("pass"), "root.root");
  EXPECT_EQ(found.at("passes").at(0).at("line"), 3);
  make_preset("look.lua");
  ASSERT_EQ(play({"in/shot.####.exr", "--headless", "--fast", "--report", "play.json"}).exit_code, kDone);
  EXPECT_FALSE(report().contains("non_finite"));
}

/// What Ctrl+R takes: a video, and a folder that is not there yet. Before any window is opened.
TEST_F(Play, ExportsGoToVideosAndNewFolders) {
  const auto of_export = [&](const std::string& to) {
    return play({"in/shot.0001.exr", "--export", to}, {.environment = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}}});
  };
  for (const char* to : {"out.mp4", "graded/", "out.####.png"})
    EXPECT_THAT(of_export(to).err, HasSubstr("cannot open a window")) << to;
  EXPECT_FALSE(fs::exists(path("graded"))) << "nothing was exported";
  const Outcome wrong = of_export("out.xyz");
  EXPECT_EQ(wrong.exit_code, kUsage);
  EXPECT_THAT(wrong.err, HasSubstr("'.xyz' is not a format that is written"));
}

TEST_F(Play, WhatIsOfTheWindowIsRefusedWithoutOne) {
  const auto refused = [&](const std::string& option, const std::vector<std::string>& value) {
    std::vector<std::string> arguments{"in/shot.0001.exr", "--headless", "--fast", option};
    arguments.insert(arguments.end(), value.begin(), value.end());
    const Outcome outcome = play(arguments);
    EXPECT_EQ(outcome.exit_code, kUsage) << option;
    EXPECT_THAT(outcome.err, HasSubstr(option + ": error: is of the window")) << option;
  };
  refused("--export", {"out.mp4"});
  refused("--geometry", {"640x480"});
  refused("--ui-scale", {"2"});
  for (const char* flag : {"--paused", "--full-screen"}) refused(flag, {});
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
  EXPECT_THAT(outcome.err, HasSubstr("1 of 4 frames could not be read: 2; shot.0002.exr: "));
  EXPECT_EQ(report().at("frames").at("unreadable_frames"), (std::vector<int>{2}));
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

/// Pictures wait in the memory that they take in their files; what is shown of them is as exact as what is written.
TEST_F(Play, PicturesThatWaitAreTheSame) {
  ASSERT_EQ(run({"run", "look.lua", "in/shot.0001.exr", "-o", "codes.png"}).exit_code, kDone);
  const struct {
    const char* file;
    double bytes;
  } kFiles[] = {{"in/shot.0001.exr", 8}, {"codes.png", 3}};
  for (const auto& [file, bytes] : kFiles) {
    const Outcome outcome = run({"play", "look.lua", file, "--headless", "--fast", "--stats", "--report", "play.json",
                                 "--screenshot", "played.exr"});
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_EQ(report().at("cache").at("bytes_per_pixel"), bytes) << file;
    EXPECT_THAT(outcome.out, HasSubstr(std::to_string(static_cast<int>(bytes)) + " bytes a pixel"));
    ASSERT_EQ(run({"run", "look.lua", file, "-o", "run.exr"}).exit_code, kDone);
    EXPECT_EQ(pixels_of("played.exr"), pixels_of("run.exr")) << file;
  }
}

/// Before any window is opened.
TEST_F(Play, DisplaysThatCannotBeHadSayWhy) {
  const auto refused = [&](std::vector<std::string> more, int code, const std::string& text) {
    more.insert(more.begin(), "in/shot.0001.exr");
    const Outcome outcome = play(more, {.environment = {{"OCIO", ""}}});
    EXPECT_EQ(outcome.exit_code, code) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(text));
  };
  refused({"--view-ocio", "ocio/acess.ocio"}, kUsage, "did you mean 'ocio/aces.ocio'?");
  const std::vector<std::string> aces{"--view-ocio", "ocio/aces.ocio"};
  const auto of_aces = [&](const std::string& option, const std::string& name) {
    return std::vector<std::string>{aces[0], aces[1], option, name};
  };
  refused(of_aces("--view-display", "sRGB - Displai"), kUsage,
          "--view-display: error: the configuration has no display of that name (aces.ocio); allowed: ");
  refused(of_aces("--view-display", "sRGB - Displai"), kUsage, "did you mean 'sRGB - Display'?");
  refused(of_aces("--view-name", "Un-tone-maped"), kUsage, "did you mean 'Un-tone-mapped'?");
  refused(of_aces("--view-icc", "monitor.icc"), kUsage, "it goes without a profile");
  refused(of_aces("--headless", "--fast"), kUsage, "--view-ocio and --view-icc are of the window");
  refused({"--view-icc", "monitor.icc"}, kFiles, "monitor.icc: ");
  write("monitor.icc", "no profile");
  refused({"--view-icc", "monitor.icc"}, kFiles, "monitor.icc: error: is no ICC profile, or a damaged one");
  refused({"--view-name", "Film"}, kUsage, "--view-ocio is not given");
  write("studio.ocio", "ocio_profile_version: 2\n  odd");
  refused({"--view-ocio", "studio.ocio"}, kScript, "studio.ocio:");
  write("studio.ocio",
        "ocio_profile_version: 2\nroles: {default: lin_rec709}\n"
        "file_rules: [!<Rule> {name: Default, colorspace: lin_rec709}]\n"
        "displays:\n  Wall:\n    - !<View> {name: Film, colorspace: film}\n"
        "colorspaces:\n  - !<ColorSpace> {name: lin_rec709}\n"
        "  - !<ColorSpace> {name: film, from_scene_reference: !<FileTransform> {src: film.cube}}\n");
  refused({"--view-ocio", "studio.ocio"}, kScript, "'film.cube': there is no such file");
  write("film.cube", "LUT_3D_SIZE 2\n0 0 0\n");
  refused({"--view-ocio", "studio.ocio"}, kScript, "film.cube:");
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
  write("glow.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.bloom {} }\n");
  const Outcome outcome =
      run({"play", "glow.lua", "a.exr", "--headless", "--show", "bloom.prefilter", "--screenshot", "a.png"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_EQ(pixels_of("a.png").size(), 32u * 24 * 4);
}

}  // namespace
}  // namespace afterglow::test
