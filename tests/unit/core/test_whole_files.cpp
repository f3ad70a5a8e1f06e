// SPDX-License-Identifier: MIT
// Which files are whole, whatever the system tells of them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/stopwatch.h"
#include "core/whole_files.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;

class WholeFilesTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("afterglow_whole_" + std::string(test->name()) + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "store");
    files_ = std::make_unique<WholeFiles>(std::set<fs::path>{folder_});
  }
  void TearDown() override { fs::remove_all(folder_); }
  /// Whether it comes to be.
  bool becomes_whole(const std::string& name) {
    constexpr double kPatience = 60'000;  // ms
    for (const auto start = Clock::now(); milliseconds_since(start) < kPatience; files_->wait())
      if (files_->whole(folder_ / name)) return true;
    return false;
  }

  fs::path folder_;
  std::unique_ptr<WholeFiles> files_;
};

TEST_F(WholeFilesTest, AreThoseThatAreClosedOrRenamedIntoPlace) {
  std::ofstream writer(folder_ / "a");
  writer << "half" << std::flush;
  files_->wait();
  EXPECT_FALSE(files_->whole(folder_ / "a"));
  writer.close();
  EXPECT_TRUE(becomes_whole("a"));
  std::ofstream(folder_ / "store" / "b") << "b";
  fs::rename(folder_ / "store" / "b", folder_ / "b");
  EXPECT_TRUE(becomes_whole("b"));
}

/// As farms publish frames: nobody writes them under these names, so nobody closes them.
TEST_F(WholeFilesTest, LinksAreToWhatIsThere) {
  std::ofstream(folder_ / "store" / "c") << "c";
  fs::create_hard_link(folder_ / "store" / "c", folder_ / "hard");
  fs::create_symlink("store/c", folder_ / "soft");
  EXPECT_TRUE(becomes_whole("hard"));
  EXPECT_TRUE(becomes_whole("soft"));
}

/// The system keeps so many events (16,384 by default) and drops the rest.
TEST_F(WholeFilesTest, WhatWasLostIsMadeUpByTime) {
  std::ofstream frame(folder_ / "frame");
  frame << "half" << std::flush;
  files_->wait();
  EXPECT_FALSE(files_->whole(folder_ / "frame"));
  std::ifstream limit("/proc/sys/fs/inotify/max_queued_events");
  int most = 0;
  ASSERT_TRUE(limit >> most);
  std::ofstream one(folder_ / "one"), two(folder_ / "two");
  for (int i = 0; i <= most / 2 + 1; ++i) {
    one << '.' << std::flush;
    two << '.' << std::flush;
  }
  frame << "whole";
  frame.close();
  EXPECT_TRUE(becomes_whole("frame"));
}

}  // namespace
}  // namespace afterglow
