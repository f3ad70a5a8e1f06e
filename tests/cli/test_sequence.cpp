// SPDX-License-Identifier: MIT
// Sequences: what is read and written under which name, frames that fail, Ctrl-C.
#include <fmt/format.h>

#include <csignal>
#include <cstdlib>

#include "sequence_test.h"
#include "small_disk.h"

namespace afterglow::test {
namespace {

using ::testing::ElementsAre;

TEST_F(Sequence, PatternToPattern) {
  const Outcome outcome = run_all();
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty()) << "no progress bar without a terminal";
  EXPECT_THAT(outputs(), ElementsAre("shot.0001.png", "shot.0002.png", "shot.0003.png", "shot.0004.png"));
}

TEST_F(Sequence, PrintfPatternToFolderWithFormat) {
  const Outcome outcome =
      run({"run", "look.lua", "in/shot.%04d.exr", "-o", "out", "--format", "png", "--frames", "1-4x2"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outputs(), ElementsAre("shot.0001.png", "shot.0003.png"));
}

TEST_F(Sequence, FilesToFolderKeepTheirNames) {
  const Outcome outcome = run({"run", "look.lua", "in/shot.0002.exr", "in/shot.0004.exr", "-o", "out/"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outputs(), ElementsAre("shot.0002.exr", "shot.0004.exr"));
}

TEST_F(Sequence, FramesAsked) {
  EXPECT_EQ(run_all({"--frames", "2-3"}).exit_code, kDone);
  EXPECT_THAT(outputs(), ElementsAre("shot.0002.png", "shot.0003.png"));
}

TEST_F(Sequence, MissingFrameIsReportedAndTheRestGoOn) {
  const Outcome outcome = run_all({"--frames", "3-6"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("shot.0005.exr"));
  EXPECT_THAT(outcome.err, HasSubstr("2 of 4 frames failed"));
  EXPECT_THAT(outputs(), ElementsAre("shot.0003.png", "shot.0004.png"));
}

TEST_F(Sequence, BadFrameInTheMiddle) {
  make_truncated_exr("in/shot.0002.exr");
  const Outcome outcome = run_all({"--report", "report.json"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("shot.0002.exr"));
  EXPECT_THAT(outcome.err, HasSubstr("1 of 4 frames failed"));
  EXPECT_THAT(outputs(), ElementsAre("shot.0001.png", "shot.0003.png", "shot.0004.png"));
  EXPECT_THAT(states("report.json"), ElementsAre("done", "failed", "done", "done"));
}

TEST_F(Sequence, FailFastStops) {
  make_truncated_exr("in/shot.0002.exr");
  const Outcome outcome = run_all({"--fail-fast"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_TRUE(is_one_error_line(outcome.err));
  EXPECT_THAT(outputs(), ElementsAre("shot.0001.png"));
}

TEST_F(Sequence, ScriptErrorStopsAtOnce) {
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.mine {} }\n");
  write("effects/mine.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.effect { name = \"mine\", doc = \"A test.\", at = \"post_process\", order = 1, settings = {},\n"
        "  build = function(g, s, source) error(\"no such luck\") end }\n");
  const Outcome outcome = run_all();
  EXPECT_EQ(outcome.exit_code, kScript);
  EXPECT_THAT(outcome.err, HasSubstr("no such luck"));
  EXPECT_EQ(outcome.err.find("no such luck"), outcome.err.rfind("no such luck")) << "said once";
  EXPECT_THAT(outputs(), IsEmpty());
}

TEST_F(Sequence, AnErrorOfOneFrameNamesIt) {
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.mine {} }\n");
  write("effects/mine.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.effect { name = \"mine\", doc = \"A test.\", at = \"post_process\", order = 1, settings = {},\n"
        "  build = function(g, s, source) if g.frame == 3 then return nil end return source end }\n");
  const Outcome outcome = run_all();
  EXPECT_EQ(outcome.exit_code, kScript);
  EXPECT_THAT(outcome.err, HasSubstr("returned nil, not an image"));
  EXPECT_THAT(outcome.err, HasSubstr("in frame 3\n"));
}

TEST_F(Sequence, WithoutResumeEverythingIsMadeAgain) {
  ASSERT_EQ(run_all().exit_code, kDone);
  ASSERT_EQ(run_all({"--report", "report.json"}).exit_code, kDone);
  EXPECT_THAT(states("report.json"), ElementsAre("done", "done", "done", "done"));
}

TEST_F(Sequence, TooLittleMemoryForOverlapStillRuns) {
  const Outcome outcome = run_all({"--max-memory", "8M"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_EQ(outputs().size(), 4u);
}

TEST_F(Sequence, StatsSayWhereTheTimeGoes) {
  const Outcome outcome = run_all({"--stats", "--report", "report.json"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  for (const char* words :
       {"plan ", "a frame: decode ", "a frame: encode ", "frames a second", "processors used", " is the limit"})
    EXPECT_THAT(outcome.out, HasSubstr(words));
  const auto report = nlohmann::json::parse(read("report.json"));
  for (const auto& frame : report.at("frames")) {
    const auto& times = frame.at("milliseconds");
    EXPECT_GT(times.at("decode"), 0.0);
    EXPECT_GT(times.at("encode"), 0.0);
    EXPECT_GT(times.at("plan"), 0.0);
    EXPECT_LT(times.at("decode"), times.at("read")) << "the file took none";
    EXPECT_LT(times.at("encode"), times.at("write")) << "the file took none";
    EXPECT_GE(times.at("waited_read"), 0.0);
    EXPECT_GE(times.at("waited_write"), 0.0);
  }
  const auto& all = report.at("milliseconds");
  EXPECT_LT(all.at("frames_wall"), all.at("wall"));
  EXPECT_GT(all.at("processors"), 0.0);
}

TEST_F(Sequence, MemoryDoesNotGrowWithTheFrames) {
  // Two pictures in turns: a frame that repeats the one before would not be run.
  make_exr("many/0000.exr", 160, 90);
  ASSERT_EQ(run({"run", "look.lua", "many/0000.exr", "-o", "many/0001.exr"}).exit_code, kDone);
  constexpr int kFew = 100, kMany = 1000;
  for (int i = 2; i < kMany; ++i)
    fs::create_hard_link(path(fmt::format("many/{:04}.exr", i % 2)), path(fmt::format("many/{:04}.exr", i)));
  std::vector<std::string> outputs{"out/####.png", "out/####.exr"};
  if (std::system("command -v ffmpeg >/dev/null") == 0) outputs.emplace_back("out/clip.mkv");
  for (const std::string& output : outputs) {
    const auto peak = [&](int frames) -> std::uint64_t {
      std::vector<std::string> arguments{
          "run",      "look.lua",   "many/####.exr", "-o", output, "--frames", fmt::format("0-{}", frames - 1),
          "--report", "report.json"};
      if (output.ends_with("mkv")) arguments.insert(arguments.end(), {"--codec", "ffv1"});
      const Outcome outcome = run(arguments);
      EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
      return nlohmann::json::parse(read("report.json")).at("memory").at("peak");
    };
    // One picture of floats has 230 kB.
    EXPECT_LT(peak(kMany), peak(kFew) + (24u << 20)) << output;
  }
}

TEST_F(Sequence, DepthFromAPatternOfItsOwn) {
  write("look.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.outline { source = \"depth\", required = true } }\n");
  for (int frame = 1; frame <= 4; ++frame) make_exr("depth/z." + std::to_string(frame) + ".exr");
  EXPECT_EQ(run_all().exit_code, kScript) << "without depth the required effect cannot run";
  const Outcome outcome = run_all({"--depth", "depth/z.#.exr:G"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_EQ(outputs().size(), 4u);
  fs::remove(path("depth/z.2.exr"));
  const Outcome missing = run_all({"--depth", "depth/z.#.exr:G"});
  EXPECT_EQ(missing.exit_code, kFiles);
  EXPECT_THAT(missing.err, HasSubstr("z.2.exr"));
  EXPECT_THAT(missing.err, HasSubstr("1 of 4 frames failed"));
}

TEST_F(Sequence, CtrlCEndsWith130AndNoPartialFile) {
  make_exr("in/shot.0001.exr", 512, 512);  // large enough that sixty of them take a while
  for (int frame = 5; frame <= 60; ++frame)
    fs::copy_file(path("in/shot.0001.exr"),
                  path("in/shot.00" + std::string(frame < 10 ? "0" : "") + std::to_string(frame) + ".exr"));
  RunOptions options;
  options.meanwhile = [&](int process) {
    if (outputs().empty()) return false;
    kill(process, SIGINT);
    return true;
  };
  const Outcome outcome = run_all({}, options);
  EXPECT_EQ(outcome.exit_code, kInterrupted);
  EXPECT_TRUE(is_one_error_line(outcome.err));
  EXPECT_THAT(outcome.err, HasSubstr("interrupted"));
  const auto made = outputs();
  EXPECT_LT(made.size(), 60u);
  for (const auto& name : made) EXPECT_TRUE(name.starts_with("shot.00") && name.ends_with(".png")) << name;
  // What was made is whole: going on makes just the rest.
  const Outcome rest = run_all({"--resume", "--report", "report.json"});
  EXPECT_EQ(rest.exit_code, kDone) << rest.err;
  const auto all = states("report.json");
  EXPECT_EQ(static_cast<std::size_t>(std::count(all.begin(), all.end(), "up to date")), made.size());
}

// Looks are asked in the size of the pictures, not in one that nobody has.
TEST_F(Sequence, LooksAreAskedInTheSizeOfThePictures) {
  write("effects/small.lua",
        "return require(\"afterglow\").effect { name = \"small\", build = function(g, s, source)\n"
        "if source.width ~= 64 and source.width ~= 32 then error(\"asked for \" .. source.width) end\n"
        "return g:filter { source = source, size = source, filter = require(\"afterglow\").filters.tent() } end }");
  write("look.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.small { opacity = function(t) return t.frame / 4 end } "
        "}");
  EXPECT_EQ(run_all().exit_code, kDone) << run_all().err;
  EXPECT_EQ(run_all({"--resume"}).exit_code, kDone);
  EXPECT_EQ(run_all({"--lock", "look.lock"}).exit_code, kDone);
  EXPECT_EQ(run_all({"--size", "50%"}).exit_code, kDone) << run_all({"--size", "50%"}).err;
  write("in/shot.0001.exr", "broken");
  EXPECT_THAT(run_all().err, Not(HasSubstr("asked for")));
}

/// What is left would be computed for nothing.
TEST_F(Sequence, AFullDiskEndsTheRun) {
  for (int frame = 10; frame <= 60; ++frame) make_exr(fmt::format("in/shot.{:04}.exr", frame));
  const SmallDisk disk(path("out"), "64k");
  if (!disk.is_mounted()) GTEST_SKIP() << "no disk can be mounted here";
  const std::vector<std::string> options{"--png-level", "0", "--frames", "10-60", "--report", "report.json"};
  const Outcome outcome = run_all(options);
  EXPECT_EQ(outcome.exit_code, kFiles);
  const auto all = states("report.json");
  const auto made = std::ranges::count(all, "done"), left = std::ranges::count(all, "not run");
  EXPECT_GT(made, 0);
  EXPECT_GT(left, 30) << "the rest is not begun";
  EXPECT_EQ(outputs().size(), static_cast<std::size_t>(made)) << "whole or absent";
  // Where a picture took the last room, a third line says that its note for --resume could not be written.
  const bool unnoted = outcome.err.find("--resume will make such frames again") != std::string::npos;
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), unnoted ? 3 : 2) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(".png: error: cannot be written: No space left on device\n"));
  EXPECT_THAT(outcome.err,
              HasSubstr(fmt::format("\nerror: the disk is full: {} of 51 frames were made; not made: ", made)));
  EXPECT_THAT(outcome.err, HasSubstr("-60; --resume goes on from there\n"));
  ASSERT_TRUE(disk.resize("4m"));
  std::vector<std::string> again = options;
  again.emplace_back("--resume");
  EXPECT_EQ(run_all(again).exit_code, kDone);
  EXPECT_EQ(outputs().size(), 51u);
}

}  // namespace
}  // namespace afterglow::test
