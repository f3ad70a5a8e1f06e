// SPDX-License-Identifier: MIT
// Jobs without a cluster: what is written, what other schedulers get, what is refused.
#include <algorithm>
#include <fstream>
#include <tuple>

#include "core/file.h"
#include "core/temporary.h"
#include "farm/attempt.h"
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

/// Behind a link ".." leads out of where the link leads to, as for `run`.
TEST_F(FarmFiles, OutputsBehindALinkAndUpAreWhereRunPutsThem) {
  fs::create_directories(path("other/place"));
  fs::create_directory_symlink(path("other/place"), path("link"));
  ASSERT_EQ(farm({"look.lua", "in/shot.####.exr", "-o", "link/../graded/", "--jobs", "jobs.json"}).exit_code, kDone);
  EXPECT_TRUE(fs::is_directory(path("other/graded/.afterglow-farm")));
  EXPECT_FALSE(fs::exists(path("graded")));
  const auto jobs = nlohmann::json::parse(read("jobs.json"));
  EXPECT_EQ(jobs["chunks"][0]["outputs"][0], fs::canonical(path("other/graded")).string() + "/shot.0001.exr");
  EXPECT_EQ(farm({"status", "link/../graded"}).exit_code, kDone);
}

TEST_F(FarmFiles, TheLatestJobIsTheLastOfTheSecond) {
  std::string last;
  for (const char* chunk : {"1", "2", "3", "4"}) {
    const Outcome outcome = write_jobs({"--chunk", chunk});
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    last = fs::path(outcome.out.substr(0, outcome.out.find('\n'))).filename().string();
  }
  EXPECT_THAT(farm({"status", "out"}).out, HasSubstr(last + ": "));
}

/// What another scheduler has, Slurm neither waits for nor begins again.
TEST_F(FarmFiles, JobsOfOtherSchedulersAreLeftToThem) {
  ASSERT_EQ(write_jobs().exit_code, kDone);
  for (const auto& [words, part] :
       {std::pair(std::vector<std::string>{"retry", "out"}, "start what is missing where it was"),
        {{"cancel", "out"}, "cancel it where it was"},
        {{"status", "out", "--wait"}, "wait for it where it was"}}) {
    const Outcome outcome = farm(words);
    EXPECT_EQ(outcome.exit_code, kFiles) << part;
    EXPECT_THAT(outcome.err, HasSubstr(part));
  }
  EXPECT_EQ(farm({"chunk", "out", "0"}).exit_code, kDone) << "by the folder of the outputs, as all words";
}

TEST_F(FarmFiles, ADryRunWritesNothing) {
  const auto before = files();
  const Outcome outcome = farm({"look.lua", "in/shot.####.exr", "-o", "out/", "--chunk", "4", "--time", "10",
                                "--dry-run", "--", "--comment=a b"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_EQ(files(), before);
  EXPECT_THAT(outcome.out, HasSubstr("# 10 frames in 3 chunks, each behind 3 frames of pre-roll"));
  EXPECT_THAT(outcome.out, HasSubstr("--time=10 '--comment=a b' --array=0-2"));
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

TEST_F(FarmFiles, SlurmWithoutAConfigurationTellsOfOtherWays) {
  write("bin/scontrol", "#!/bin/sh\necho 'scontrol: fatal: Could not establish a configuration source' >&2\nexit 1\n");
  fs::permissions(path("bin/scontrol"), fs::perms::owner_all);
  RunOptions options;
  options.environment["PATH"] = text("bin") + ":/usr/bin:/bin";
  const Outcome outcome = farm({"look.lua", "in/shot.####.exr", "-o", "out/", "--wait"}, options);
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("scontrol ended with code 1"));
  EXPECT_THAT(outcome.err, HasSubstr("or --jobs FILE.json for other schedulers"));
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
  refused({"status", "out", "--frames", "1-3"}, kUsage,
          "--frames cannot go with 'status'; allowed: --all, --wait, --report");
  refused({"retry", "out", "--set", "glow.gain=2"}, kUsage, "--set cannot go with 'retry'");
  refused({"cancel", "out", "-o", "one/"}, kUsage, "--output cannot go with 'cancel'; allowed: its job alone");
  refused({"report", "out", "--", "--nice"}, kUsage, "words behind -- cannot go with 'report'");
  refused({"look.lua", "-", "-o", "out/", "--raw", "16x9:rgb24"}, kUsage, "unknown option '--raw'");
  refused({"look.lua", "in/shot.####.exr", "-o", "out/", "--resume"}, kUsage, "unknown option '--resume'");
  for (const char* word : {"--array=1-3", "--arr=1-3", "-a", "-a1-3"})
    refused({"look.lua", "in/shot.####.exr", "-o", "out/", "--", word}, kUsage, "the array is that of the chunks");
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

TEST_F(FarmFiles, AFolderThatWasMovedIsTold) {
  ASSERT_EQ(write_jobs({"--chunk", "5"}).exit_code, kDone);
  fs::rename(path("out"), path("elsewhere"));
  const Outcome chunk = farm({"chunk", "elsewhere", "0"});
  EXPECT_EQ(chunk.exit_code, kFiles);
  EXPECT_THAT(chunk.err, HasSubstr("the job's folder was moved here; move it back, or submit the job anew; allowed: " +
                                   path("out/.afterglow-farm").string()));
  fs::rename(path("elsewhere"), path("out"));
  EXPECT_EQ(farm({"chunk", "out", "0"}).exit_code, kDone);
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

}  // namespace
}  // namespace afterglow::test
