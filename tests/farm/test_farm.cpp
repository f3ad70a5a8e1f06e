// SPDX-License-Identifier: MIT
// Jobs on a cluster that is well.
#include <set>

#include "farm_test.h"

namespace afterglow::test {
namespace {

class Farm : public FarmTest {};

TEST_F(Farm, FramesOverFourNodesAreThoseOfOneRunByteForByte) {
  AFTERGLOW_NEEDS_CLUSTER();
  const std::string out = "the \"best\"\n'shots' $x";  // no shell may read it
  make_frames("in", 1, 240);
  make_look_back();
  fs::create_directories(path(out));
  fs::create_directory(path("one"));
  ASSERT_EQ(run({"run", "look.lua", "in/shot.####.exr", "-o", "one/"}).exit_code, kDone);

  const Outcome submitted = farm({"look.lua", "in/shot.####.exr", "-o", out + "/", "--chunk", "12", "--", "--hold"});
  ASSERT_EQ(submitted.exit_code, kDone) << submitted.err;
  EXPECT_THAT(submitted.out, HasSubstr(": 20 chunks")) << "more than an array may have: two arrays";
  EXPECT_THAT(farm({"status", out}).out, HasSubstr("0 of 240 frames, 20 chunks: 20 waiting"));

  // What is edited while the frames wait changes nothing.
  write("look.lua", "this is no look");
  write("shaders/back/show.glsl", "nor is this a shader");
  fs::remove_all(path("effects"));
  ASSERT_EQ(slurm("scontrol", {"release", "jobname=afterglow-" + job_of(out).filename().string()}).exit_code, 0);
  const Outcome waited = farm({"status", out, "--wait"});
  ASSERT_EQ(waited.exit_code, kDone) << waited.err
                                     << read(out + "/.afterglow-farm/" + job_of(out).filename().string() +
                                             "/logs/0.log");
  expect_as_one_run(out, "one");
  expect_nothing_half_written(out);
  EXPECT_THAT(farm({"status", out}).out, HasSubstr("240 of 240 frames, 20 chunks: 20 done"));

  const auto report = report_of(out);
  EXPECT_EQ(report["frames"].size(), 240u);
  EXPECT_EQ(report["frames_done"], 240);
  std::set<std::string> nodes;
  std::size_t frames = 0;
  for (const auto& node : report["nodes"]) {
    nodes.insert(node["name"]);
    frames += node["frames"].get<std::size_t>();
  }
  EXPECT_EQ(nodes, (std::set<std::string>{"n1", "n2", "n3", "n4"}));
  EXPECT_EQ(frames, 240u);
  EXPECT_EQ(report["devices"].size(), 1u);
  EXPECT_GT(report["milliseconds"]["execute"], 0.0);
}

TEST_F(Farm, WhatIsThereAlreadyIsNotMadeAgain) {
  AFTERGLOW_NEEDS_CLUSTER();
  make_frames("in", 1, 12);
  make_look_back();
  fs::create_directory(path("out"));
  ASSERT_EQ(farm({"look.lua", "in/shot.####.exr", "-o", "out/", "--frames", "1-6", "--chunk", "3", "--wait"}).exit_code,
            kDone);
  const auto time = fs::last_write_time(path("out/shot.0006.exr"));
  const Outcome again =
      farm({"look.lua", "in/shot.####.exr", "-o", "out/", "--chunk", "4", "--wait", "--report", "all.json"});
  ASSERT_EQ(again.exit_code, kDone) << again.err;
  EXPECT_EQ(fs::last_write_time(path("out/shot.0006.exr")), time);
  EXPECT_EQ(pictures("out").size(), 12u);
  const auto report = nlohmann::json::parse(read("all.json"));
  std::map<std::string, int> states;
  for (const auto& frame : report["frames"]) ++states[frame["state"]];
  EXPECT_EQ(states, (std::map<std::string, int>{{"done", 6}, {"up to date", 6}}));
  // A run on this machine knows the look too.
  const Outcome here = run({"run", "look.lua", "in/shot.####.exr", "-o", "out/", "--resume", "--stats"});
  EXPECT_THAT(here.out, HasSubstr("frames: 0 done, 12 up to date"));
}

TEST_F(Farm, WordsBehindTheDashesGoToSbatch) {
  AFTERGLOW_NEEDS_CLUSTER();
  make_frames("in", 1, 2);
  make_look_back();
  fs::create_directory(path("out"));
  const Outcome wrong = farm({"look.lua", "in/shot.####.exr", "-o", "out/", "--", "--no-such-option"});
  EXPECT_EQ(wrong.exit_code, kFiles);
  EXPECT_THAT(wrong.err, HasSubstr("sbatch ended with code"));
  EXPECT_FALSE(fs::exists(path("out/.afterglow-farm"))) << "nothing was submitted, nothing is left";
  const Outcome right = farm({"look.lua", "in/shot.####.exr", "-o", "out/", "--wait", "--", "--nodelist=n3"});
  EXPECT_EQ(right.exit_code, kDone) << right.err;
  EXPECT_EQ(report_of("out")["nodes"][0]["name"], "n3");
  EXPECT_THAT(farm({"look.lua", "in/shot.####.exr", "-o", "out/", "--partition", "none"}).err,
              HasSubstr("Invalid partition name specified"));
}

TEST_F(Farm, ANodeWithAnotherInstallationRefusesTheLook) {
  AFTERGLOW_NEEDS_CLUSTER();
  make_frames("in", 1, 2);
  make_look_back();
  fs::create_directory(path("out"));
  // As if a node had been updated: the effect that the look takes from the installation has another text there.
  fs::create_directory(path("home"));
  for (const char* folder : {"scripts", "shaders", "presets", "calibration", "assets"})
    fs::copy(fs::path(AFTERGLOW_PROJECT_FOLDER) / folder, path("home") / folder, fs::copy_options::recursive);
  RunOptions options;
  options.environment["AFTERGLOW_HOME"] = text("home");
  ASSERT_EQ(farm({"look.lua", "in/shot.####.exr", "-o", "out/", "--", "--hold"}, options).exit_code, kDone);
  write("home/scripts/effects/tone_mapping.lua", read("home/scripts/effects/tone_mapping.lua") + "-- changed\n");
  ASSERT_EQ(slurm("scontrol", {"release", "jobname=afterglow-" + job_of("out").filename().string()}).exit_code, 0);
  const Outcome waited = farm({"status", "out", "--wait"});
  EXPECT_EQ(waited.exit_code, kScript) << waited.err;
  EXPECT_THAT(waited.err, HasSubstr("the look is not the locked one"));
  EXPECT_TRUE(pictures("out").empty());
  EXPECT_EQ(attempts("out", "exit-3").size(), 1u) << "no other try mends that";
}

}  // namespace
}  // namespace afterglow::test
