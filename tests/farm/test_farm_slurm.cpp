// SPDX-License-Identifier: MIT
// What Slurm is told and what it says, without a cluster: programs in its place, and their lines.
#include <algorithm>
#include <future>

#include "core/file.h"
#include "farm/slurm.h"
#include "farm/status.h"
#include "farm_test.h"

namespace afterglow::test {
namespace {

/// Programs of Slurm's that a test writes, in the place of real ones.
class FakeSlurm : public FarmTest {
 protected:
  void SetUp() override {
    FarmTest::SetUp();
    make_frames("in", 1, 4);
    make_look_back();
    fs::create_directory(path("out"));
    program("scontrol", "echo 'MaxArraySize = 1001'");
    program("scancel", "echo \"$@\" >>\"$(dirname \"$0\")/cancelled\"");
    program("squeue", "");
  }
  void program(const std::string& name, const std::string& text) const {
    write("slurm/" + name, "#!/bin/sh\n" + text + "\n");
    fs::permissions(path("slurm/" + name), fs::perms::owner_all);
  }
  RunOptions with_fakes() const {
    RunOptions options;
    options.environment["PATH"] = text("slurm") + ":/usr/bin:/bin";
    return options;
  }
};

/// A controller that is busy does not answer now and then.
TEST_F(FakeSlurm, OneQuestionWithoutAnswerDoesNotEndTheWait) {
  program("sbatch", "echo 7");
  program("squeue", R"sh(count=$(dirname "$0")/count
n=$(cat "$count" 2>/dev/null || echo 0)
echo $((n + 1)) >"$count"
[ "$n" = 1 ] && { echo "slurm_load_jobs error: Socket timed out on send/recv operation" >&2; exit 1; }
[ "$n" -lt 3 ] && echo "7|0|RUNNING|n1|None" || echo "7|0|TIMEOUT|n1|None")sh");
  const Outcome outcome = run({"farm", "look.lua", "in/shot.####.exr", "-o", "out/", "--wait"}, with_fakes());
  EXPECT_THAT(outcome.err, HasSubstr("Socket timed out on send/recv operation; it is asked again"));
  EXPECT_THAT(outcome.err, HasSubstr("its time limit was over"));
  EXPECT_EQ(read("slurm/count"), "4\n");
}

TEST_F(FakeSlurm, OneArrayThatCannotBeCancelledLeavesNoOther) {
  program("sbatch", "echo $$");
  ASSERT_EQ(run({"farm", "look.lua", "in/shot.####.exr", "-o", "out/"}, with_fakes()).exit_code, kDone);
  const std::string job = job_of("out").string();
  ASSERT_EQ(run({"farm", "retry", job}, with_fakes()).exit_code, kDone);
  program("scancel", R"sh(echo "$@" >>"$(dirname "$0")/cancelled"
[ "$(wc -l <"$(dirname "$0")/cancelled")" = 1 ] && { echo "Socket timed out" >&2; exit 1; }
exit 0)sh");
  const Outcome outcome = run({"farm", "cancel", job}, with_fakes());
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("Socket timed out; cancel again"));
  EXPECT_EQ(std::ranges::count(read("slurm/cancelled"), '\n'), 2);
}

TEST_F(FakeSlurm, SubmissionsAtOnceLoseNoArray) {
  program("sbatch", "sleep 0.2; echo $$");
  ASSERT_EQ(run({"farm", "look.lua", "in/shot.####.exr", "-o", "out/"}, with_fakes()).exit_code, kDone);
  const std::string job = job_of("out").string();
  auto other = std::async(std::launch::async, [&] { return run({"farm", "retry", job}, with_fakes()); });
  const Outcome mine = run({"farm", "retry", job}, with_fakes());
  EXPECT_EQ(other.get().exit_code, kDone);
  EXPECT_EQ(mine.exit_code, kDone) << mine.err;
  EXPECT_EQ(nlohmann::json::parse(*read_file(job + "/slurm.json")).at("arrays").size(), 3u);
  ASSERT_EQ(run({"farm", "cancel", job}, with_fakes()).exit_code, kDone);
  const std::string cancelled = read("slurm/cancelled");
  EXPECT_EQ(std::ranges::count(cancelled, '\n'), 3) << cancelled;
}

/// A job that runs is left alone by those that would make the same outputs.
TEST_F(FakeSlurm, TwoJobsDoNotMakeTheSameOutputsAtOnce) {
  const auto submit = [&](const std::string& frames, const std::string& output = "out/") {
    return run({"farm", "look.lua", "in/shot.####.exr", "--frames", frames, "-o", output}, with_fakes());
  };
  program("sbatch", "sleep 0.2; echo 7");
  program("squeue", "echo '7|0|RUNNING|n1|None'");
  auto other = std::async(std::launch::async, [&] { return submit("1-2"); });
  const Outcome one = submit("1-2"), two = other.get();
  EXPECT_EQ(std::min(one.exit_code, two.exit_code), kDone) << one.err;
  EXPECT_EQ(std::max(one.exit_code, two.exit_code), kFiles) << "one of two at once";
  const std::string job = job_of("out").string();
  for (const char* frames : {"1-2", "2-3"}) {
    const Outcome outcome = submit(frames);
    EXPECT_EQ(outcome.exit_code, kFiles);
    EXPECT_THAT(outcome.err, HasSubstr(job + ": error: this job is not done (1 running) and makes "));
    EXPECT_THAT(outcome.err, HasSubstr("allowed: `afterglow farm status --wait " + job + "`"));
  }
  EXPECT_EQ(submit("1-2", "out/s.####.exr").exit_code, kDone) << "other names";
  EXPECT_EQ(submit("3-4").exit_code, kDone) << "other frames";
  program("squeue", "");
  EXPECT_EQ(submit("1-2").exit_code, kDone) << "it has ended";
}

TEST_F(FakeSlurm, AccountingIsAskedOnTheJobsCluster) {
  program("sbatch", "echo '123;alpha'");
  program("sacct", "case \"$*\" in *--clusters=alpha*) ;; *) echo '123_0|TIMEOUT|stranger' ;; esac");
  ASSERT_EQ(run({"farm", "look.lua", "in/shot.####.exr", "-o", "out/"}, with_fakes()).exit_code, kDone);
  const Outcome status = run({"farm", "status", job_of("out").string()}, with_fakes());
  EXPECT_THAT(status.out + status.err, Not(HasSubstr("stranger")));
}

/// Wrappers and plug-ins of a site say things of their own.
TEST_F(FakeSlurm, TheNumberOfAJobIsTheLastLineOfSbatch) {
  const auto submit = [&] { return run({"farm", "look.lua", "in/shot.####.exr", "-o", "out/"}, with_fakes()); };
  program("sbatch", "echo 'NOTE: down on Monday'; echo 24");
  ASSERT_EQ(submit().exit_code, kDone);
  EXPECT_EQ(nlohmann::json::parse(*read_file(job_of("out") / "slurm.json")).at("arrays")[0].at("id"), "24");
  for (const char* text : {"echo 24; echo 'NOTE: down on Monday'", "true"}) {
    program("sbatch", text);
    const Outcome outcome = submit();
    EXPECT_EQ(outcome.exit_code, kFiles);
    EXPECT_THAT(outcome.err, HasSubstr("sbatch told no number of a job: '"));
  }
}

TEST_F(FakeSlurm, RetriesAreThoseOfTheLastRetry) {
  program("sbatch", "echo 24");
  ASSERT_EQ(run({"farm", "look.lua", "in/shot.####.exr", "-o", "out/"}, with_fakes()).exit_code, kDone);
  const std::string script = (job_of("out") / "task.sh").string();
  EXPECT_THAT(*read_file(script), HasSubstr("-lt 3 ]; then"));
  ASSERT_EQ(run({"farm", "retry", "out", "--retries", "9"}, with_fakes()).exit_code, kDone);
  EXPECT_THAT(*read_file(script), HasSubstr("-lt 9 ]; then"));
}

TEST(FarmText, ArraysStayBelowTheLargest) {
  const auto plans = farm::array_plans({0, 1, 2, 3, 4, 5, 6, 7, 9, 14}, 4);
  ASSERT_EQ(plans.size(), 4u);
  EXPECT_EQ(plans[0].tasks, "0-3");
  EXPECT_EQ(plans[2].base, 8u);
  EXPECT_EQ(plans[2].tasks, "1");
  EXPECT_EQ(plans[3].base, 12u);
  EXPECT_EQ(plans[3].tasks, "2");
  EXPECT_EQ(farm::array_plans({0, 2, 4}, 100)[0].tasks, "0-4:2") << "as sbatch writes steps";
}

TEST(FarmText, AJoinWaitsForTheChunksThatAreTriedAgain) {
  using farm::ChunkStatus;
  farm::Job job;
  job.folder = "/shots/job";
  job.chunks.resize(3);
  job.video = "/shots/a.mov";
  EXPECT_EQ(farm::every_task(job).size(), 4u);
  const auto retried = [&](std::vector<ChunkStatus::State> states) {
    farm::JobStatus status;
    for (const auto state : states) status.chunks.push_back({.state = state, .exit_code = {}, .node = {}, .why = {}});
    return farm::tasks_to_retry(job, status);
  };
  using enum ChunkStatus::State;
  EXPECT_EQ(retried({done, failed, done, waiting}), (std::vector<std::size_t>{1, 3}));
  EXPECT_EQ(retried({done, running, done, waiting}), (std::vector<std::size_t>{}));
  EXPECT_EQ(retried({done, done, done, failed}), (std::vector<std::size_t>{3}));
  EXPECT_EQ(retried({lost, done, done, failed}), (std::vector<std::size_t>{0, 3}));
  EXPECT_EQ(retried({done, done, done, done}), (std::vector<std::size_t>{}));
  job.needs.more = {"--dependency=afterok:7"};
  const auto words = farm::sbatch_words(job, {.base = 0, .tasks = "3", .after = {"12", "14"}});
  const auto own = std::ranges::find(words, "--dependency=afterany:12:14");
  EXPECT_NE(own, words.end());
  EXPECT_GT(own, std::ranges::find(words, "--dependency=afterok:7")) << "of two options the last one counts";
}

TEST(FarmText, OfAChunkTheLastArrayCounts) {
  const farm::Submissions submissions{{{"12", "", 0}, {"13", "", 16}, {"20", "", 0}}, false};
  const auto queue = farm::states_of_queue(
      "12|0|COMPLETED|n1|None\n12|3|FAILED|n2|NonZeroExitCode\n13|1|PENDING||Priority\n20|3|RUNNING|n4|None\n99|3|"
      "FAILED|n1|None\n",
      submissions);
  EXPECT_EQ(queue.size(), 3u);
  EXPECT_TRUE(queue.at(0).ended());
  EXPECT_EQ(queue.at(3).state, "RUNNING");
  EXPECT_EQ(queue.at(3).node, "n4");
  EXPECT_EQ(queue.at(17).reason, "Priority");
  const auto accounting = farm::states_of_accounting(
      "12_0|COMPLETED|n1\n12_3|CANCELLED by 1000|n2\n20_[3-5]|PENDING|None assigned\n", submissions);
  EXPECT_EQ(accounting.size(), 2u);
  EXPECT_EQ(accounting.at(3).state, "CANCELLED");
  EXPECT_TRUE(accounting.at(3).ended());
}

/// A chunk that failed on one cluster and was submitted to another one; both have arrays of the same number.
TEST(FarmText, OfSeveralClustersTheLastArrayCounts) {
  const farm::Submissions submissions{{{"12", "b", 0}, {"12", "a", 0}}, false};
  farm::TaskStates states;
  for (const auto& [cluster, squeue] : {std::pair<std::string, std::string>{"a", "12|0|RUNNING|m1|None\n"},
                                        {"b", "12|0|FAILED|n1|None\n12|1|COMPLETED|n2|None\n"}})
    farm::add_later(states, farm::states_of_queue(squeue, submissions, cluster));
  ASSERT_EQ(states.size(), 2u);
  EXPECT_EQ(states.at(0).state, "RUNNING");
  EXPECT_EQ(states.at(0).place, 1u);
  EXPECT_EQ(states.at(1).node, "n2");
  // Accounting is behind the queue: of the same array it says nothing new.
  farm::add_later(states, farm::states_of_accounting("12_0|PENDING|None assigned\n", submissions, "a"));
  EXPECT_EQ(states.at(0).state, "RUNNING");
}

TEST(FarmText, ArraysAreAsLargeAsTheClusterTakesThem) {
  EXPECT_EQ(farm::largest_array("MaxArraySize            = 1001\nSchedulerParameters     = (null)\n"), 1001u);
  EXPECT_EQ(farm::largest_array("MaxArraySize = 100001\nSchedulerParameters = bf_interval=1,max_array_tasks=1000,x\n"),
            1000u);
  EXPECT_EQ(farm::largest_array("MaxArraySize = 10\nSchedulerParameters = max_array_tasks=1000\n"), 10u);
  EXPECT_EQ(farm::largest_array("ClusterName = test\n"), std::nullopt);
}

TEST(FarmText, TellsOfTasksThatWillNotStart) {
  farm::Job job;
  job.id = "j";
  job.chunks.resize(3);
  farm::JobStatus status;
  const auto waits = [&](const char* why) {
    status.chunks.push_back(
        {.state = farm::ChunkStatus::State::waiting, .tries = 0, .exit_code = {}, .node = {}, .why = why});
  };
  waits("priority");
  waits("launch failed requeued held");
  waits("badconstraints");
  EXPECT_EQ(farm::waiting_line(job, status),
            "frames; of 3 chunks 3 waiting; Slurm says: badconstraints, launch failed requeued held");
  const std::string text = farm::status_text(job, status, false);
  EXPECT_THAT(text, HasSubstr("requeued held"));
  EXPECT_THAT(text, HasSubstr("badconstraints"));
  EXPECT_THAT(text, Not(HasSubstr("priority")));
}

TEST(FarmText, WhileOneWaitsFramesAreCountedAndChunksNamed) {
  using State = farm::ChunkStatus::State;
  farm::Job job;
  job.chunks.resize(4);
  farm::JobStatus status;
  const auto add = [&](State state, const char* node) {
    status.chunks.push_back({.state = state, .tries = 0, .exit_code = {}, .node = node, .why = {}});
  };
  add(State::done, "n4");
  add(State::running, "n2");
  add(State::running, "n1");
  add(State::waiting, "");
  EXPECT_EQ(farm::waiting_line(job, status), "frames; of 4 chunks 1 done, 2 running, 1 waiting (n1 n2)");
  job.video = "/a.mov";
  add(State::waiting, "");
  EXPECT_EQ(farm::waiting_line(job, status),
            "frames; of 4 chunks 1 done, 2 running, 1 waiting (n1 n2); the join is waiting");
  job.chunks.resize(6);
  status.chunks.clear();
  for (const char* node : {"n1", "n2", "n3", "n4", "n5", "n1"}) add(State::running, node);
  add(State::waiting, "");
  EXPECT_EQ(farm::waiting_line(job, status), "frames; of 6 chunks 6 running (5 nodes); the join is waiting");
}

TEST(FarmText, TellsWhyATaskEnded) {
  EXPECT_EQ(farm::why_it_ended("TIMEOUT"), "its time limit was over; `farm retry` with a longer --time goes on");
  EXPECT_EQ(farm::why_it_ended("OUT_OF_MEMORY"),
            "it needed more memory than it had; `farm retry` with a larger --mem goes on");
  EXPECT_EQ(farm::why_it_ended("NODE_FAIL"), "its node went down");
  EXPECT_EQ(farm::why_it_ended("SOMETHING_NEW"), "Slurm: something_new");
}

}  // namespace
}  // namespace afterglow::test
