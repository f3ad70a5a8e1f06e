// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <condition_variable>
#include <fstream>

#include "core/file.h"
#include "play/footage_watch.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

class FootageWatchTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("afterglow-footage-watch-" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override {
    watch_.reset();
    fs::remove_all(folder_);
  }
  std::string name(int frame) const { return (folder_ / ("s." + std::to_string(frame) + ".exr")).string(); }
  void write(int frame, const std::string& content) const {
    ASSERT_TRUE(write_file_atomically(name(frame), content).ok());
  }
  void open() {
    options_.inputs = {(folder_ / "s.#.exr").string()};
    Diagnostics none;
    footage_ = Footage::open(options_, none).value();
    watch_ = std::make_unique<FootageWatch>(options_, footage_, [this] {
      const std::lock_guard lock(mutex_);
      told_ = true;
      changed_.notify_all();
    });
  }
  /// The footage after the next change.
  void next() {
    std::unique_lock lock(mutex_);
    ASSERT_TRUE(changed_.wait_for(lock, std::chrono::minutes(1), [this] { return told_; }));
    told_ = false;
    if (auto newer = watch_->take()) footage_ = std::move(newer);
  }
  /// Waits for changes until it holds.
  void until(const std::function<bool()>& holds) {
    while (!holds() && !HasFatalFailure()) next();
  }
  std::vector<int> pictures() const {
    std::vector<int> out;
    for (int i = 0; i < footage_->frames(); ++i) out.push_back(footage_->frame(i).picture);
    return out;
  }

  fs::path folder_;
  FootageOptions options_;
  std::shared_ptr<const Footage> footage_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool told_ = false;
  std::unique_ptr<FootageWatch> watch_;
};

TEST_F(FootageWatchTest, PicturesKeepTheirNumbersAndNewOnesFollow) {
  for (const int frame : {1, 2, 4}) write(frame, "x");
  open();
  EXPECT_THAT(pictures(), ElementsAre(0, 1, 1, 2));
  write(3, "y");
  until([&] { return footage_->pictures() == 4; });
  EXPECT_THAT(pictures(), ElementsAre(0, 1, 3, 2));
  EXPECT_EQ(footage_->picture_name(3), "s.3.exr");
  EXPECT_TRUE(footage_->missing().empty());
  write(2, "rendered again");
  until([&] { return footage_->pictures() == 5; });
  EXPECT_THAT(pictures(), ElementsAre(0, 4, 3, 2));
  EXPECT_EQ(footage_->picture_name(4), "s.2.exr");
  write(2, "and again");
  until([&] { return footage_->pictures() == 6; });
  EXPECT_THAT(pictures(), ElementsAre(0, 5, 3, 2));
}

TEST_F(FootageWatchTest, AFrameThatIsBeingWrittenIsNotThereYet) {
  write(1, "x");
  open();
  std::ofstream slow(name(2));
  slow << "half" << std::flush;
  write(3, "z");
  until([&] { return footage_->frames() == 3; });
  EXPECT_TRUE(footage_->frame(1).held);
  slow << " and half";
  slow.close();
  until([&] { return !footage_->frame(1).held; });
  EXPECT_THAT(pictures(), ElementsAre(0, 2, 1));
}

TEST_F(FootageWatchTest, WhatIsDeletedIsHeld) {
  for (const int frame : {1, 2, 3}) write(frame, "x");
  open();
  fs::remove(name(2));
  write(4, "x");  // deletions alone are seen by and by
  until([&] { return footage_->frames() == 4; });
  EXPECT_TRUE(footage_->frame(1).held);
  write(2, "new");
  until([&] { return !footage_->frame(1).held; });
  EXPECT_EQ(footage_->picture_name(footage_->frame(1).picture), "s.2.exr");
}

}  // namespace
}  // namespace afterglow
