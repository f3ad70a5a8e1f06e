// SPDX-License-Identifier: MIT
// Jobs without a cluster: what is written, what other schedulers get, what is refused.
#include <algorithm>
#include <fstream>
#include <future>
#include <tuple>

#include "core/file.h"
#include "core/temporary.h"
#include "farm/attempt.h"
#include "farm/slurm.h"
#include "farm/status.h"
#include "farm_test.h"

namespace afterglow::test {
namespace {

class FarmFiles : public FarmTest {
 protected:
  void SetUp() override {
    FarmTest::SetUp();
    make_frames("in", 1, 10);
    make_look_back();
    fs::create_directory(path("out"));
    fs::create_directory(path("one"));
  }
  Outcome write_jobs(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"look.lua", "in/shot.####.exr", "-o", "out/", "--jobs", "jobs.json"};
    words.insert(words.end(), more.begin(), more.end());
    return farm(words);
  }
  /// A job's chunk by the line for shells that jobs.json has for it.
  Outcome run_line(const nlohmann::json& chunk) const {
    RunOptions options;
    options.program = "/bin/sh";
    options.folder = "/";  // as other schedulers may
    return run({"-c", chunk["shell"].get<std::string>()}, options);
  }
};

TEST_F(FarmFiles, JobsHaveCommandsNeedsAndOutputsThatAnySchedulerCanRun) {
  ASSERT_EQ(run({"run", "look.lua", "in/shot.####.exr", "-o", "one/"}).exit_code, kDone);
  const Outcome outcome = write_jobs({"--chunk", "4", "--mem", "2G"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  const auto jobs = nlohmann::json::parse(read("jobs.json"));
  EXPECT_EQ(jobs["afterglow_jobs"], 1);
  EXPECT_EQ(jobs["needs"]["memory"], "2G");
  ASSERT_EQ(jobs["chunks"].size(), 3u);
  const auto& second = jobs["chunks"][1];
  EXPECT_EQ(second["frames"], "5-8");
  EXPECT_EQ(second["outputs"].size(), 4u);
  EXPECT_EQ(second["outputs"][0], text("out/shot.0005.exr"));
  EXPECT_EQ(second["inputs"].size(), 7u) << "its own, and three that it looks back at";
  EXPECT_EQ(second["inputs"][0], text("in/shot.0002.exr"));
  EXPECT_THAT(farm({"status", "out"}).out, HasSubstr("0 of 10 frames, 3 chunks: 3 not begun"));
  for (auto chunk = jobs["chunks"].rbegin(); chunk != jobs["chunks"].rend(); ++chunk) {
    const Outcome made = run_line(*chunk);
    EXPECT_EQ(made.exit_code, kDone) << made.err;
  }
  expect_as_one_run("out", "one");
  EXPECT_THAT(farm({"status", "out"}).out, HasSubstr("10 of 10 frames, 3 chunks: 3 done"));
  EXPECT_EQ(report_of("out")["frames"].size(), 10u);
}

/// As docs/farms.md says, on this machine alone.
TEST_F(FarmFiles, GnuParallelRunsTheLines) {
  if (std::system("command -v parallel >/dev/null") != 0) GTEST_SKIP() << "GNU parallel is not installed";
  ASSERT_EQ(run({"run", "look.lua", "in/shot.####.exr", "-o", "one/"}).exit_code, kDone);
  ASSERT_EQ(write_jobs({"--chunk", "3"}).exit_code, kDone);
  RunOptions options;
  options.program = "/bin/sh";
  const Outcome ended = run({"-c",
                             "python3 -c 'import json; print(\"\\n\".join(c[\"shell\"] for c in "
                             "json.load(open(\"jobs.json\"))[\"chunks\"]))' "
                             "> lines && parallel --jobs 2 --joblog log --retries 3 < lines"},
                            options);
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  expect_as_one_run("out", "one");
  const std::string log = read("log");
  EXPECT_EQ(std::ranges::count(log, '\n'), 5) << log;
  EXPECT_EQ(report_of("out")["frames_done"], 10);
}

TEST_F(FarmFiles, ADryRunWritesNothing) {
  const auto before = files();
  const Outcome outcome = farm({"look.lua", "in/shot.####.exr", "-o", "out/", "--chunk", "4", "--time", "10",
                                "--dry-run", "--", "--comment=a b"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_EQ(files(), before);
  EXPECT_THAT(outcome.out, HasSubstr("# 10 frames in 3 chunks, each behind 3 frames of pre-roll"));
  EXPECT_THAT(outcome.out, HasSubstr("--array=0-2 --time=10 '--comment=a b'"));
  EXPECT_THAT(outcome.out, HasSubstr("farm chunk \"$job\" \"$chunk\""));
}

TEST_F(FarmFiles, NewFolderOfOutputsIsMadeByAJobAlone) {
  const auto before = files();
  EXPECT_EQ(farm({"look.lua", "in/shot.####.exr", "-o", "new/", "--dry-run"}).exit_code, kDone);
  RunOptions no_slurm;
  no_slurm.environment["PATH"] = path("").string();
  EXPECT_EQ(farm({"look.lua", "in/shot.####.exr", "-o", "new/"}, no_slurm).exit_code, kFiles);
  EXPECT_EQ(files(), before);
  const Outcome outcome = farm({"look.lua", "in/shot.####.exr", "-o", "new/", "--jobs", "jobs.json"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  const Outcome made = run_line(nlohmann::json::parse(read("jobs.json"))["chunks"][0]);
  EXPECT_EQ(made.exit_code, kDone) << made.err;
  EXPECT_EQ(pictures("new").size(), 10u);
}

TEST_F(FarmFiles, WithoutSlurmNothingIsLeft) {
  RunOptions options;
  options.environment["PATH"] = path("").string();
  const Outcome outcome = farm({"look.lua", "in/shot.####.exr", "-o", "out/"}, options);
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_TRUE(is_one_error_line(outcome.err));
  EXPECT_THAT(outcome.err, HasSubstr("'scontrol' cannot be started: No such file or directory"));
  EXPECT_THAT(outcome.err, HasSubstr("--jobs FILE.json"));
  EXPECT_FALSE(fs::exists(path("out/.afterglow-farm")));
}

TEST_F(FarmFiles, WhatIsWrongIsOneLine) {
  const auto refused = [&](const std::vector<std::string>& words, int exit_code, const std::string& part) {
    const Outcome outcome = farm(words);
    EXPECT_EQ(outcome.exit_code, exit_code) << part;
    EXPECT_TRUE(is_one_error_line(outcome.err));
    EXPECT_THAT(outcome.err, HasSubstr(part));
  };
  refused({"look.lua"}, kUsage, "INPUT is required");
  refused({"look.lua", "in/shot.####.exr"}, kUsage, "--output is required");
  refused({"status", "out", "one"}, kUsage, "'status' is for one job");
  refused({"statsu", "out"}, kUsage,
          "'statsu' is no word of it; allowed: status, report, cancel, retry, chunk, join; did you mean 'status'?");
  refused({"look.lua", "in/shot.####.exr", "-o", "none/shot.####.exr", "--jobs", "j.json"}, kFiles,
          "its folder 'none' does not exist");
  refused({"status", "out"}, kFiles, "there is no farm job");
  refused({"cancel", "nowhere"}, kFiles, "nowhere: error: there is no farm job");
  refused({"chunk", "out"}, kUsage, "chunk needs a job's folder and a number");
  refused({"look.lua", "-", "-o", "out/", "--raw", "16x9:rgb24"}, kUsage, "unknown option '--raw'");
  refused({"look.lua", "in/shot.####.exr", "-o", "out/", "--resume"}, kUsage, "unknown option '--resume'");
  refused({"look.lua", "in/shot.####.exr", "-o", "out/", "--", "--array=1-3"}, kUsage,
          "the array is that of the chunks");
  refused({"look.lua", "in/shot.####.exr", "-o", "out/", "--jobs", "j.json", "--wait"}, kUsage,
          "--jobs submits nothing");
  refused({"look.lua", "in/none.####.exr", "-o", "out/", "--jobs", "j.json"}, kFiles, "no file matches");
  refused({"none.lua", "in/shot.####.exr", "-o", "out/", "--jobs", "j.json"}, kScript, "none.lua: error: ");
  refused({"look.lua", "in/shot.####.exr", "-o", "out/shot.exr", "--jobs", "j.json"}, kUsage,
          "afterglow farm: error: 10 frames cannot go into the one file");
  for (const auto& [option, value, part] :
       {std::tuple("--format", "foo", "'.foo' is not a format that is written"),
        std::tuple("--type", "uint12", "exr files cannot hold samples of type uint12"),
        std::tuple("--crf", "3", "--crf is for videos")})
    refused({"look.lua", "in/shot.####.exr", "-o", "out/", "--jobs", "j.json", option, value}, kUsage, part);
  refused({"look.lua", "in/shot.0001.exr", "in/shot.0002.exr", "-o", "out/", "--jobs", "j.json"}, kUsage,
          "is no sequence, and the look has effects that look back");
  EXPECT_FALSE(fs::exists(path("out/.afterglow-farm")));
}

TEST_F(FarmFiles, TablesOfAnyFrameArePackedAndNotesAreThoseOfOneRun) {
  make_frames("many", 1, 140, 8, 8);
  write("id.cube", "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n");
  write("half.cube", "LUT_1D_SIZE 2\n0 0 0\n0.5 0.5 0.5\n");
  write("look.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.stack { fx.lut { file = function(t) return t.frame == 2 and \"half.cube\" or \"id.cube\" end } }\n");
  RunOptions options;
  options.environment["AFTERGLOW_HOME"] = AFTERGLOW_PROJECT_FOLDER;
  const Outcome outcome =
      farm({"look.lua", "many/shot.####.exr", "-o", "out/", "--jobs", "jobs.json", "--chunk", "3"}, options);
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  const auto jobs = nlohmann::json::parse(read("jobs.json"));
  for (const int chunk : {0, 1}) {
    const Outcome made = run_line(jobs["chunks"][chunk]);
    EXPECT_EQ(made.exit_code, kDone) << made.err;
  }
  const Outcome rest = run(
      {"run", "look.lua", "many/shot.####.exr", "-o", "out/", "--frames", "1-7", "--resume", "--report", "report.json"},
      options);
  EXPECT_EQ(rest.exit_code, kDone) << rest.err;
  const auto frames = nlohmann::json::parse(read("report.json"))["frames"];
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(frames[i]["state"], i < 6 ? "up to date" : "done") << i;
  const auto job = nlohmann::json::parse(read(fs::relative(job_of("out"), path("")) / "job.json"));
  EXPECT_EQ(job["environment"]["AFTERGLOW_HOME"], AFTERGLOW_PROJECT_FOLDER);
}

TEST_F(FarmFiles, WhatWasPackedMustStayAsItIs) {
  ASSERT_EQ(write_jobs().exit_code, kDone);
  const auto jobs = nlohmann::json::parse(read("jobs.json"));
  const fs::path job = jobs["job"].get<std::string>();
  ASSERT_EQ(jobs["chunks"].size(), 1u);
  for (const auto& entry : fs::recursive_directory_iterator(job / "look"))
    if (entry.path().filename() == "look.lua") std::ofstream(entry.path(), std::ios::app) << "-- changed\n";
  const Outcome outcome = run_line(jobs["chunks"][0]);
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("look.lua: error: has changed since the job was submitted; submit it again"));
  EXPECT_THAT(farm({"status", "out"}).out, HasSubstr("1 failed"));
}

TEST_F(FarmFiles, WhatAMachineThatDiedHasLeftGoes) {
  ASSERT_EQ(write_jobs({"--chunk", "5"}).exit_code, kDone);
  const auto jobs = nlohmann::json::parse(read("jobs.json"));
  const auto job = farm::read_job(job_of("out"));
  ASSERT_TRUE(job);
  // A try on another machine: nobody here knows its processes.
  ASSERT_TRUE(farm::Attempt::begin(*job, 0));
  const std::string begun = fs::relative(job->folder / "attempts" / "0.1.begun", path("")).string();
  std::string text = read(begun);
  const std::size_t mark = text.find(temporary_mark());
  ASSERT_NE(mark, std::string::npos) << text;
  write(begun, text.replace(mark, temporary_mark().size(), "0badcafe-77"));
  write("out/.shot.0002.0badcafe-77-3.tmp.exr", "half");
  write("out/.afterglow/.shot.0002.exr.0badcafe-77-4.tmp.made", "half");
  write("out/.shot.0002.0badcafe-771-3.tmp.exr", "somebody else's");
  EXPECT_EQ(run_line(jobs["chunks"][1]).exit_code, kDone);
  EXPECT_TRUE(fs::exists(path("out/.shot.0002.0badcafe-77-3.tmp.exr"))) << "another chunk's";
  const Outcome made = run_line(jobs["chunks"][0]);
  EXPECT_EQ(made.exit_code, kDone) << made.err;
  EXPECT_FALSE(fs::exists(path("out/.shot.0002.0badcafe-77-3.tmp.exr")));
  EXPECT_FALSE(fs::exists(path("out/.afterglow/.shot.0002.exr.0badcafe-77-4.tmp.made")));
  EXPECT_TRUE(fs::exists(path("out/.shot.0002.0badcafe-771-3.tmp.exr")));
  const auto tries = farm::attempts_of(*job);
  ASSERT_TRUE(tries);
  ASSERT_EQ(tries->size(), 3u);
  EXPECT_EQ((*tries)[1].number, 2) << "of the first chunk the second";
  EXPECT_EQ((*tries)[1].exit_code, 0);
}

TEST_F(FarmFiles, WhatAProcessThatLivesWritesStays) {
  ASSERT_EQ(write_jobs({"--chunk", "5"}).exit_code, kDone);
  const auto job = farm::read_job(job_of("out"));
  ASSERT_TRUE(job);
  ASSERT_TRUE(farm::Attempt::begin(*job, 0));
  const fs::path mine = temporary_beside(path("out/shot.0002.exr"));
  write("out/" + mine.filename().string(), "half");
  EXPECT_EQ(farm({"chunk", job->folder.string(), "0"}).exit_code, kDone);
  EXPECT_TRUE(fs::exists(mine));
}

TEST_F(FarmFiles, WhatFailsBehindWhatWasDoneHasFailed) {
  ASSERT_EQ(write_jobs({"--chunk", "5"}).exit_code, kDone);
  const auto jobs = nlohmann::json::parse(read("jobs.json"));
  for (const auto& chunk : jobs["chunks"]) ASSERT_EQ(run_line(chunk).exit_code, kDone);
  const std::string picture = read("in/shot.0007.exr");
  fs::remove(path("in/shot.0007.exr"));
  fs::remove(path("out/shot.0007.exr"));
  EXPECT_EQ(run_line(jobs["chunks"][1]).exit_code, kFiles);
  EXPECT_THAT(farm({"status", "out"}).out, HasSubstr("5 of 10 frames, 2 chunks: 1 done, 1 failed"));
  EXPECT_EQ(farm({"status", "out", "--wait"}).exit_code, kFiles);
  write("in/shot.0007.exr", picture);
  EXPECT_EQ(run_line(jobs["chunks"][1]).exit_code, kDone);
  EXPECT_THAT(farm({"status", "out"}).out, HasSubstr("10 of 10 frames, 2 chunks: 2 done"));
}

TEST_F(FarmFiles, FramesThatAreNotThereYetAreSaid) {
  const Outcome outcome = write_jobs({"--frames", "9-14"});
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_THAT(outcome.err, HasSubstr("warning: 4 of 6 frames are not there yet: in/shot.0011.exr"));
}

TEST_F(FarmFiles, AListThatCannotBeWrittenLeavesNoJob) {
  const Outcome outcome = farm({"look.lua", "in/shot.####.exr", "-o", "out/", "--jobs", "none/jobs.json"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_FALSE(fs::exists(path("out/.afterglow-farm")));
}

TEST_F(FarmFiles, DescriptionsThatAreNoneAreRefused) {
  ASSERT_EQ(write_jobs().exit_code, kDone);
  const fs::path job = job_of("out");
  const std::string good = read(fs::relative(job / "job.json", path("")).string());
  const auto with = [&](const std::string& content) {
    std::ofstream(job / "job.json") << content;
    const Outcome outcome = farm({"status", "out"});
    EXPECT_EQ(outcome.exit_code, kFiles) << content.substr(0, 40);
    EXPECT_TRUE(is_one_error_line(outcome.err));
    EXPECT_THAT(outcome.err, HasSubstr("job.json: error: this is no farm job"));
    return outcome.err;
  };
  with("");
  with("{}");
  with(good.substr(0, good.size() / 2));
  auto later = nlohmann::json::parse(good);
  later["afterglow_farm"] = 3;
  EXPECT_THAT(with(later.dump()), HasSubstr("it has version 3, this program reads version 2"));
}

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

TEST_F(FakeSlurm, AccountingIsAskedOnTheJobsCluster) {
  program("sbatch", "echo '123;alpha'");
  program("sacct", "case \"$*\" in *--clusters=alpha*) ;; *) echo '123_0|TIMEOUT|stranger' ;; esac");
  ASSERT_EQ(run({"farm", "look.lua", "in/shot.####.exr", "-o", "out/"}, with_fakes()).exit_code, kDone);
  const Outcome status = run({"farm", "status", job_of("out").string()}, with_fakes());
  EXPECT_THAT(status.out + status.err, Not(HasSubstr("stranger")));
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
