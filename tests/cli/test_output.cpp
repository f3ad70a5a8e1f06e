// SPDX-License-Identifier: MIT
// Outputs appear whole or not at all.
#include "cli_test.h"
#include "small_disk.h"

namespace afterglow::test {
namespace {

class Output : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    make_preset("look.lua");
    make_exr("a.exr", 256, 256);
  }

  void expect_failure(const Outcome& outcome, const std::string& message) const {
    EXPECT_EQ(outcome.exit_code, kFiles);
    EXPECT_TRUE(is_one_error_line(outcome.err));
    EXPECT_THAT(outcome.err, HasSubstr(message));
  }
};

TEST_F(Output, FolderThatDoesNotExist) {
  const auto before = files();
  expect_failure(run({"run", "look.lua", "a.exr", "-o", "nowhere/a.png"}), "nowhere");
  expect_failure(run({"run", "look.lua", "a.exr", "-o", "nowhere/new/"}), "its folder 'nowhere' does not exist");
  EXPECT_EQ(files(), before);
}

TEST_F(Output, NewFolderIsMadeWithTheFirstPicture) {
  write("broken.lua", "return 1\n");
  write("b.exr", "not a picture");
  const auto before = files();
  EXPECT_EQ(run({"run", "broken.lua", "a.exr", "-o", "new/"}).exit_code, kScript);
  EXPECT_EQ(run({"run", "look.lua", "a.exr", "-o", "new/", "--type", "uint8"}).exit_code, kUsage);
  expect_failure(run({"run", "look.lua", "b.exr", "-o", "new/"}), "b.exr");
  EXPECT_EQ(files(), before);
  const Outcome outcome = run({"run", "look.lua", "b.exr", "a.exr", "-o", "new/"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_TRUE(fs::is_regular_file(path("new/a.exr")));
  RunOptions options;
  options.environment["ASAN_OPTIONS"] = "detect_leaks=0";  // which looks by ptrace, if the program was built for it
  const Outcome confined = run({"run", "look.lua", "a.exr", "-o", "new/sandbox/", "--sandbox"}, options);
  EXPECT_EQ(confined.exit_code, kDone) << confined.err;
  EXPECT_TRUE(fs::is_regular_file(path("new/sandbox/a.exr")));
}

TEST_F(Output, FolderThatCannotBeWritten) {
  // Root may write where others may not, but nobody makes files in /proc.
  expect_failure(run({"run", "look.lua", "a.exr", "-o", "/proc/a.png"}), "/proc");
}

TEST_F(Output, FileInPlaceOfAFolder) {
  write("file", "not a folder");
  expect_failure(run({"run", "look.lua", "a.exr", "-o", "file/a.png"}), "file");
  expect_failure(run({"run", "look.lua", "a.exr", "-o", "file/"}), "file: error: is not a folder");
}

TEST_F(Output, FolderInPlaceOfTheFile) {
  fs::create_directories(path("a.png/inside"));
  // A folder takes outputs; with --format it is one, without it the output would have the input's name.
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "a.png", "--format", "png"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_TRUE(fs::is_regular_file(path("a.png/a.png")));
}

TEST_F(Output, UnknownFormat) {
  const auto before = files();
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "a.xyz"});
  EXPECT_THAT(outcome.exit_code, ::testing::AnyOf(kUsage, kFiles));
  EXPECT_TRUE(is_one_error_line(outcome.err));
  EXPECT_THAT(outcome.err, HasSubstr("a.xyz"));
  // Of several pictures too, and with the videos that are written.
  const Outcome several = run({"run", "look.lua", "a.exr", "a.exr", "-o", "a.avi"});
  EXPECT_EQ(several.exit_code, kUsage);
  EXPECT_THAT(several.err, HasSubstr("a.avi: error: '.avi' is not a format that is written; allowed: .exr, "));
  EXPECT_THAT(several.err, HasSubstr(".mp4, .mov, .mkv, .webm, .gif, .apng"));
  EXPECT_EQ(files(), before);
}

class FullDisk : public Output, public ::testing::WithParamInterface<const char*> {};

TEST_P(FullDisk, LeavesTheOldFileAndNothingElse) {
  fs::create_directory(path("disk"));
  const SmallDisk disk(path("disk"), "8k");
  if (!disk.is_mounted()) GTEST_SKIP() << "no disk can be mounted here";
  const std::string name = std::string("disk/") + GetParam();
  write(name, "the picture of yesterday");
  const auto before = files();
  std::vector<std::string> words{"run", "look.lua", "a.exr", "-o", name};
  const bool png = name.ends_with(".png");
  words.insert(words.end(), {png ? "--png-level" : "--compression", png ? "0" : name == "disk/out.exr" ? "none" : ""});
  expect_failure(run(words), name);
  EXPECT_EQ(files(), before) << "something was left behind";
  EXPECT_TRUE(read(name) == "the picture of yesterday");
}

INSTANTIATE_TEST_SUITE_P(Cli, FullDisk, ::testing::Values("out.exr", "out.png", "out.hdr"),
                         [](const auto& info) { return std::string(info.param).substr(4); });

// As daemons start programs. What is said must not land in the files that got the numbers of closed streams.
TEST_F(Output, ClosedStandardStreamsChangeNothing) {
  for (int frame = 1; frame <= 8; ++frame) make_exr("in/a.000" + std::to_string(frame) + ".exr");
  write("talks.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.exposure { ev = function(t) "
        "for i = 1, 9 do print(\"said\", t.frame) end return t.frame end } }\n");
  RunOptions shell;
  shell.program = "/bin/sh";
  const auto made = [&](const std::string& folder, const std::string& closed) {
    const Outcome outcome = run({"-c", std::string("exec '") + AFTERGLOW_PROGRAM +
                                           "' run talks.lua 'in/a.####.exr' -o " + folder + "/ " + closed},
                                shell);
    EXPECT_EQ(outcome.exit_code, kDone) << closed << outcome.err;
    std::string all;
    for (int frame = 1; frame <= 8; ++frame) all += read(folder + "/a.000" + std::to_string(frame) + ".exr");
    return all;
  };
  const std::string usual = made("usual", "");
  for (const char* closed : {"<&-", ">&-", "2>&-", "<&- >&- 2>&-"}) {
    EXPECT_TRUE(made("closed", closed) == usual) << closed;
    fs::remove_all(path("closed"));
  }
  // A stream that is needed is still missed.
  const Outcome lost =
      run({"-c", std::string("exec '") + AFTERGLOW_PROGRAM + "' run talks.lua a.exr -o - --format png >&-"}, shell);
  EXPECT_EQ(lost.exit_code, kFiles) << lost.err;
}

TEST_F(Output, ReportThatCannotBeWritten) {
  const Outcome nowhere = run({"run", "look.lua", "a.exr", "-o", "a.png", "--report", "nowhere/report.json"});
  expect_failure(nowhere, "nowhere/report.json");
  EXPECT_FALSE(fs::exists(path("a.png"))) << "said before the work";
  const Outcome full = run({"run", "look.lua", "a.exr", "-o", "a.png", "--report", "/dev/full"});
  expect_failure(full, "/dev/full");
  EXPECT_TRUE(fs::exists(path("a.png"))) << "the picture itself is fine";
  const Outcome beside = run({"run", "look.lua", "a.exr", "-o", "new/", "--format", "png", "--report", "new/r.json"});
  EXPECT_EQ(beside.exit_code, kDone) << beside.err;
  EXPECT_TRUE(fs::exists(path("new/r.json"))) << "in a folder that was made for the results";
}

TEST_F(Output, ReadOnlyFilesAreNotReplaced) {
  for (const char* name : {"a.png", "o.0001.png", "report.json"}) {
    write(name, "");
    fs::permissions(path(name), fs::perms::owner_read);
  }
  fs::copy_file(path("a.exr"), path("s.0001.exr"));
  fs::copy_file(path("a.exr"), path("s.0002.exr"));
  const auto before = files();
  const auto refuses = [&](const char* input, const std::vector<std::string>& more, const std::string& name) {
    std::vector<std::string> words{"run", "look.lua", input};
    words.insert(words.end(), more.begin(), more.end());
    expect_failure(run(words, {.bound = true}), name + ": error: cannot be written: Permission denied");
    EXPECT_EQ(files(), before) << "before any work";
    EXPECT_EQ(read(name), "");
  };
  refuses("a.exr", {"-o", "a.png"}, "a.png");
  refuses("s.####.exr", {"-o", "o.####.png"}, "o.0001.png");
  refuses("a.exr", {"-o", "b.png", "--report", "report.json"}, "report.json");
}

TEST_F(Output, WhatResumeKeepsMayBeReadOnly) {
  for (const char* name : {"s.0001.exr", "s.0002.exr"}) {
    fs::copy_file(path("a.exr"), path(name));
    fs::last_write_time(path(name), fs::file_time_type::clock::now() - std::chrono::hours(1));
  }
  const std::vector<std::string> words{"run", "look.lua", "s.####.exr", "-o", "o.####.png", "--resume"};
  ASSERT_EQ(run(words).exit_code, kDone);
  fs::permissions(path("o.0001.png"), fs::perms::owner_read);
  fs::remove(path("o.0002.png"));
  const Outcome outcome = run(words, {.bound = true});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
}

/// Whoever may write into the outputs' folder may write their notes; where they cannot be, frames are made all the
/// same.
TEST_F(Output, NotesAreAsOpenAsTheFolderAndNoReasonToFail) {
  for (const char* name : {"s.0001.exr", "s.0002.exr"}) fs::copy_file(path("a.exr"), path(name));
  fs::create_directory(path("out"));
  fs::permissions(path("out"), fs::perms::all);
  ASSERT_EQ(run({"run", "look.lua", "s.####.exr", "-o", "out/"}).exit_code, kDone);
  EXPECT_EQ(fs::status(path("out/.afterglow")).permissions(), fs::perms::all);
  fs::remove_all(path("out/.afterglow"));
  fs::create_directory(path("out/.afterglow"));
  fs::permissions(path("out/.afterglow"), fs::perms::owner_read | fs::perms::owner_exec);
  const Outcome outcome = run({"run", "look.lua", "s.####.exr", "-o", "out/"}, {.bound = true});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("cannot be written: Permission denied; --resume will make such frames again"));
}

TEST_F(Output, ALinkThatLeadsNowhereStays) {
  fs::create_directory(path("disk"));
  fs::create_symlink("disk/o.png", path("o.png"));
  ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", "o.png"}).exit_code, kDone);
  EXPECT_TRUE(fs::is_symlink(path("o.png")));
  EXPECT_TRUE(fs::is_regular_file(path("disk/o.png")));
}

TEST_F(Output, LongNamesCanBeWritten) {
  const std::string name = std::string(251, 'x') + ".png";
  EXPECT_EQ(run({"run", "look.lua", "a.exr", "-o", name}).exit_code, kDone);
  EXPECT_TRUE(fs::is_regular_file(path(name)));
}

TEST_F(Output, SameInputSamePixelsSameBytes) {
  for (const char* name : {"1.png", "2.png"})
    ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", name, "--dither", "blue"}).exit_code, kDone);
  EXPECT_EQ(read("1.png"), read("2.png"));
}

}  // namespace
}  // namespace afterglow::test
