// SPDX-License-Identifier: MIT
// Caches that are held within limits.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "core/cache_folder.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;
using std::chrono::hours;

class CacheFolder : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  void file(const std::string& name, std::size_t bytes, hours unused) {
    std::ofstream(folder_ / name) << std::string(bytes, 'x');
    fs::last_write_time(folder_ / name, now_ - unused);
  }
  bool has(const std::string& name) const { return fs::exists(folder_ / name); }
  CacheTrim trim(const CacheLimits& limits) const { return trim_cache(folder_, ".kernel", limits, now_); }

  fs::path folder_ = fs::temp_directory_path() / ("afterglow_cache_" + std::to_string(getpid()));
  fs::file_time_type now_ = fs::file_time_type::clock::now();
};

TEST_F(CacheFolder, WhatFitsStays) {
  file("a.kernel", 100, hours(1));
  file("b.kernel", 100, hours(2));
  const CacheTrim done = trim({.bytes = 200, .unused = hours(48)});
  EXPECT_EQ(done.removed, 0);
  EXPECT_EQ(done.bytes, 200u);
}

TEST_F(CacheFolder, WhatWasUsedLongestAgoGoesFirst) {
  for (int i = 0; i < 8; ++i) file(std::to_string(i) + ".kernel", 100, hours(8 - i));
  const CacheTrim done = trim({.bytes = 700, .unused = hours(48)});
  EXPECT_EQ(done.removed, 3);  // down to three quarters of the limit
  EXPECT_EQ(done.bytes, 500u);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(has(std::to_string(i) + ".kernel"), i >= 3) << i;
}

TEST_F(CacheFolder, WhatNobodyUsesGoes) {
  file("old.kernel", 1, hours(49));
  file("new.kernel", 1, hours(47));
  EXPECT_EQ(trim({.bytes = 200, .unused = hours(48)}).removed, 1);
  EXPECT_FALSE(has("old.kernel"));
  EXPECT_TRUE(has("new.kernel"));
}

TEST_F(CacheFolder, OtherFilesAreNotTouched) {
  file("notes.txt", 1000, hours(1000));
  fs::create_directories(folder_ / "folder.kernel");
  EXPECT_EQ(trim({.bytes = 1, .unused = hours(1)}).removed, 0);
  EXPECT_TRUE(has("notes.txt"));
  EXPECT_TRUE(has("folder.kernel"));
  EXPECT_EQ(trim_cache(folder_ / "missing", ".kernel").removed, 0);
}

TEST_F(CacheFolder, UseIsNotedOnceADay) {
  file("a.kernel", 1, hours(30));
  file("b.kernel", 1, hours(3));
  const auto before = fs::last_write_time(folder_ / "b.kernel");
  note_cache_use(folder_ / "a.kernel");
  note_cache_use(folder_ / "b.kernel");
  note_cache_use(folder_ / "missing.kernel");
  EXPECT_GE(fs::last_write_time(folder_ / "a.kernel"), now_);
  EXPECT_EQ(fs::last_write_time(folder_ / "b.kernel"), before);
}

}  // namespace
}  // namespace afterglow
