// SPDX-License-Identifier: MIT
// Jobs that something befalls: nodes, processes, disks, pictures, other jobs, people.
#include <signal.h>

#include "farm_test.h"
#include "small_disk.h"

namespace afterglow::test {
namespace {

/// So that a frame takes some 20 ms, and a chunk of many is caught at its work.
constexpr int kWork = 30'000;

class FarmFaults : public FarmTest {
 protected:
  void SetUp() override {
    FarmTest::SetUp();
    make_look_back(kWork);
    fs::create_directory(path("one"));
    fs::create_directory(path("out"));
  }
  void make_truth(int frames, int width = 16, int height = 9) const {
    make_frames("in", 1, frames, width, height);
    ASSERT_EQ(run({"run", "look.lua", "in/shot.####.exr", "-o", "one/", "--compression", "none"}).exit_code, kDone);
  }
  Outcome submit(const std::vector<std::string>& more, const RunOptions& options = {}) const {
    std::vector<std::string> words{"look.lua", "in/shot.####.exr", "-o", "out/", "--compression", "none"};
    words.insert(words.end(), more.begin(), more.end());
    return farm(words, options);
  }
  /// Waits until a chunk is being made and some of its frames, not all, are there; what its attempt says of itself.
  nlohmann::json catch_a_chunk(int frames) const {
    nlohmann::json caught;
    EXPECT_TRUE(wait_until([&] {
      const auto there = static_cast<int>(pictures("out").size());
      for (const auto& begun : attempts("out", ".begun"))
        if (there > 3 && there < frames)  // the first ones are noted by then
          caught = nlohmann::json::parse(read(fs::relative(begun, path("")).string()), nullptr, false);
      return caught.is_object();
    }));
    return caught;
  }
  /// Of outputs that are done: whole, and noted as such. Who is killed between the two does that one again.
  std::map<std::string, fs::file_time_type> times() const {
    std::map<std::string, fs::file_time_type> out;
    for (const auto& entry : fs::directory_iterator(path("out")))
      if (fs::exists(path("out/.afterglow/" + entry.path().filename().string() + ".made")))
        out[entry.path().filename().string()] = entry.last_write_time();
    return out;
  }
  /// Whole outputs were left alone.
  void expect_untouched(const std::map<std::string, fs::file_time_type>& before) const {
    EXPECT_FALSE(before.empty());
    for (const auto& [name, time] : before) EXPECT_EQ(fs::last_write_time(path("out/" + name)), time) << name;
  }
};

TEST_F(FarmFaults, ANodeThatDiesLosesNothing) {
  AFTERGLOW_NEEDS_CLUSTER();
  make_truth(160);
  ASSERT_EQ(submit({"--chunk", "160"}).exit_code, kDone);
  const std::string node = catch_a_chunk(160)["node"];
  cluster_->kill_node(node);
  // What slurmctld does itself when it has not heard of a node for SlurmdTimeout.
  ASSERT_EQ(slurm("scontrol", {"update", "nodename=" + node, "state=down", "reason=dead"}).exit_code, 0);
  const auto there = times();
  const Outcome waited = farm({"status", "out", "--wait"});
  EXPECT_EQ(waited.exit_code, kDone) << waited.err;
  expect_as_one_run("out", "one");
  expect_untouched(there);
  expect_nothing_half_written("out");
  const auto report = report_of("out");
  EXPECT_EQ(report["nodes"].size(), 2u) << "another one went on: " << report["nodes"].dump();
  EXPECT_EQ(attempts("out", ".begun").size(), 1u) << "the try that the node took with it";
}

/// Somebody makes it again by hand, while Slurm still knows that it went well.
TEST_F(FarmFaults, AChunkThatWasDoneAndFailsLaterHasFailed) {
  AFTERGLOW_NEEDS_CLUSTER();
  make_frames("in", 1, 4);
  ASSERT_EQ(submit({"--chunk", "2"}).exit_code, kDone);
  ASSERT_EQ(farm({"status", "out", "--wait"}).exit_code, kDone);
  fs::remove(path("out/shot.0001.exr"));
  fs::rename(path("in/shot.0001.exr"), path("away.exr"));
  EXPECT_EQ(farm({"chunk", "out", "0"}).exit_code, kFiles);
  const Outcome failed = farm({"status", "out"});
  EXPECT_THAT(failed.out, HasSubstr("1 done, 1 failed"));
  EXPECT_THAT(failed.out, HasSubstr("shot.0001.exr"));
  fs::rename(path("away.exr"), path("in/shot.0001.exr"));
  ASSERT_EQ(farm({"retry", "out"}).exit_code, kDone);
  EXPECT_EQ(farm({"status", "out", "--wait"}).exit_code, kDone);
  EXPECT_TRUE(fs::exists(path("out/shot.0001.exr")));
}

TEST_F(FarmFaults, AProcessThatIsKilledBeginsAgainWhereItWas) {
  AFTERGLOW_NEEDS_CLUSTER();
  make_truth(160);
  ASSERT_EQ(submit({"--chunk", "160"}).exit_code, kDone);
  const auto caught = catch_a_chunk(160);
  ASSERT_EQ(kill(caught["process"].get<int>(), SIGKILL), 0);
  const auto there = times();
  const Outcome waited = farm({"status", "out", "--wait"});
  EXPECT_EQ(waited.exit_code, kDone) << waited.err;
  expect_as_one_run("out", "one");
  expect_untouched(there);
  expect_nothing_half_written("out");
  const auto report = report_of("out");
  EXPECT_EQ(report["frames_done"], 160);
  EXPECT_THAT(read(fs::relative(job_of("out") / "logs" / "0.log", path("")).string()), HasSubstr("exit code 137 on n"));
}

TEST_F(FarmFaults, AnUrgentJobTakesTheNodesAndGivesThemBack) {
  AFTERGLOW_NEEDS_CLUSTER();
  make_truth(160);
  ASSERT_EQ(submit({"--chunk", "160", "--retries", "0"}).exit_code, kDone);
  catch_a_chunk(160);
  ASSERT_EQ(slurm("sbatch", {"--partition=urgent", "--nodes=4", "--exclusive", "--output=/dev/null", "--wrap=true"})
                .exit_code,
            0);
  ASSERT_TRUE(wait_until([&] {
    return !slurm("squeue", {"--noheader", "--states=PENDING", "--partition=farm"}).out.empty();
  }));
  const auto there = times();
  EXPECT_LT(there.size(), 160u);
  const Outcome waited = farm({"status", "out", "--wait"});
  EXPECT_EQ(waited.exit_code, kDone) << waited.err;
  expect_as_one_run("out", "one");
  expect_untouched(there);
  expect_nothing_half_written("out");
}

/// A task that hangs: Slurm's own clock ends it. Its limit is a minute at least; the end of that is brought nearer.
TEST_F(FarmFaults, AChunkBeyondItsTimeIsEndedSaidSoAndRetried) {
  AFTERGLOW_NEEDS_CLUSTER();
  make_truth(160);
  ASSERT_EQ(submit({"--chunk", "160", "--time", "1"}).exit_code, kDone);
  const auto caught = catch_a_chunk(160);
  const int process = caught["process"].get<int>();
  ASSERT_EQ(kill(process, SIGSTOP), 0);
  const std::string task = caught["task"];
  EXPECT_THAT(slurm("scontrol", {"show", "job", task}).out, HasSubstr("TimeLimit=00:01:00"));
  const Outcome nearer = slurm("scontrol", {"update", "jobid=" + task, "EndTime=now+1"});
  ASSERT_EQ(nearer.exit_code, 0) << nearer.err;
  const auto there = times();
  const Outcome waited = farm({"status", "out", "--wait"});
  EXPECT_EQ(waited.exit_code, kOther) << waited.err;
  EXPECT_THAT(waited.err, HasSubstr("1 of 1 chunks are not done (1 lost)"));
  EXPECT_THAT(waited.err, HasSubstr("its time limit was over; `farm retry` with a longer --time goes on"));
  expect_nothing_half_written("out");
  EXPECT_LT(times().size(), 160u);
  const Outcome said = farm({"status", "out"});
  EXPECT_THAT(said.out, HasSubstr("its time limit was over"));
  EXPECT_EQ(attempts("out", "").size(), 1u) << "no other try before somebody gives it more time";
  const Outcome retried = farm({"retry", "out", "--time", "10", "--wait"});
  EXPECT_EQ(retried.exit_code, kDone) << retried.err;
  expect_as_one_run("out", "one");
  expect_untouched(there);
}

TEST_F(FarmFaults, CancelEndsAndRetryGoesOn) {
  AFTERGLOW_NEEDS_CLUSTER();
  make_truth(120);
  ASSERT_EQ(submit({"--chunk", "40"}).exit_code, kDone);
  catch_a_chunk(120);
  EXPECT_EQ(farm({"cancel", "out"}).exit_code, kDone);
  const Outcome waited = farm({"status", "out", "--wait"});
  EXPECT_EQ(waited.exit_code, kInterrupted) << waited.err;
  EXPECT_THAT(waited.err, HasSubstr("cancelled"));
  EXPECT_THAT(slurm("squeue", {"--noheader"}).out, IsEmpty());
  expect_nothing_half_written("out");
  const auto there = times();
  EXPECT_LT(there.size(), 120u);
  const Outcome retried = farm({"retry", "out", "--wait"});
  EXPECT_EQ(retried.exit_code, kDone) << retried.err;
  expect_as_one_run("out", "one");
  expect_untouched(there);
  EXPECT_THAT(farm({"retry", "out"}).out, HasSubstr("nothing to retry"));
}

TEST_F(FarmFaults, ABadFrameIsNamedAndTheRestIsMade) {
  AFTERGLOW_NEEDS_CLUSTER();
  make_look_back();
  make_truth(24);
  const std::string good = read("in/shot.0009.exr");
  write("in/shot.0009.exr", good.substr(0, good.size() / 2));
  const Outcome waited = submit({"--chunk", "6", "--retries", "1", "--wait"});
  EXPECT_EQ(waited.exit_code, kFiles) << waited.err;
  EXPECT_THAT(waited.err, HasSubstr("1 of 4 chunks are not done (3 done, 1 failed)"));
  EXPECT_THAT(waited.err, HasSubstr("in/shot.0009.exr: error: "));
  EXPECT_EQ(pictures("out").size(), 23u);
  EXPECT_EQ(attempts("out", ".exit-4").size(), 2u) << "a second try, and no third one";
  EXPECT_THAT(farm({"report", "out"}).out, HasSubstr("failed: in/shot.0009.exr: error: "));
  const auto there = times();
  write("in/shot.0009.exr", good);
  const Outcome retried = farm({"retry", "out", "--wait"});
  EXPECT_EQ(retried.exit_code, kDone) << retried.err;
  EXPECT_EQ(pictures("out").size(), 24u);
  for (int frame = 1; frame <= 8; ++frame)  // of the frames behind it three looked back at it
    EXPECT_EQ(there.at("shot.000" + std::to_string(frame) + ".exr"),
              fs::last_write_time(path("out/shot.000" + std::to_string(frame) + ".exr")));
  expect_as_one_run("out", "one");
}

TEST_F(FarmFaults, AFullDiskFailsAndRetryGoesOnWhenThereIsRoom) {
  make_look_back();
  const SmallDisk disk(path("out"), "400k");  // before the daemons begin, so that they see it
  AFTERGLOW_NEEDS_CLUSTER();
  make_truth(24, 64, 36);
  RunOptions limited;
  limited.largest_file = disk.is_mounted() ? 0 : 12'000;  // Slurm hands limits on
  const Outcome waited = submit({"--chunk", "6", "--retries", "0", "--wait"}, limited);
  EXPECT_EQ(waited.exit_code, kFiles) << waited.err;
  EXPECT_THAT(waited.err, HasSubstr("chunks are not done"));
  expect_nothing_half_written("out");
  const auto there = pictures("out");
  EXPECT_LT(there.size(), 24u);
  for (const auto& [name, content] : there) EXPECT_TRUE(content == read("one/" + name)) << name << " is whole";
  if (disk.is_mounted()) {
    ASSERT_TRUE(disk.resize("8m"));
  }
  const Outcome retried = farm({"retry", "out", "--wait"});
  EXPECT_EQ(retried.exit_code, kDone) << retried.err;
  expect_as_one_run("out", "one");
}

}  // namespace
}  // namespace afterglow::test
