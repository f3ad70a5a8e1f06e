// SPDX-License-Identifier: MIT
// What is noted of frames that look back: which files, how often they are looked at, and when it changes.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <string_view>
#include <vector>

#include "batch/grouped.h"
#include "batch/resume.h"
#include "batch/schedule.h"
#include "batch/sequence_stamps.h"
#include "core/paths.h"
#include "temporary_folder.h"

namespace {
int looks = 0;  // at files of sequences
}

/// In place of the C library's.
extern "C" int stat(const char* file, struct stat* status) noexcept {
  if (std::string_view(file).find("/s.") != std::string_view::npos) ++looks;
  return fstatat(AT_FDCWD, file, status, 0);
}

namespace afterglow {
namespace {

using ::testing::ElementsAre;

class EarlierFilesTest : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "look.lua") << "return require(\"afterglow\").stack {}\n";
    shaders_ = std::make_unique<ShaderLibrary>(search_path_for(folder_ / "look.lua", {}));
    Diagnostics nowhere;
    auto preset = Preset::load(folder_ / "look.lua", {}, *shaders_, nowhere);
    ASSERT_TRUE(preset) << preset.error().text();
    preset_ = std::make_unique<Preset>(std::move(*preset));
  }
  void make(int frames) {
    for (int i = 1; i <= frames; ++i) write_bytes(file(i), "x");
    request_.inputs = {(folder_ / "s.####.exr").string()};
  }
  std::filesystem::path file(int frame) const { return folder_ / fmt::format("s.{:04}.exr", frame); }
  void touch(int frame) const {
    std::filesystem::last_write_time(file(frame),
                                     std::filesystem::last_write_time(file(frame)) + std::chrono::seconds(10));
  }
  FrameRecords records(const std::vector<int>& frames, int pre_roll) const {
    FrameRecords out;
    for (const int frame : frames) {
      auto job = job_of(request_, request_.inputs.front(), {frame, file(frame)});
      out.push_back({.job = std::move(job).value()});
    }
    note_earlier_files(out, request_, pre_roll);
    return out;
  }
  static std::vector<std::string> names(const FrameJob& job) {
    std::vector<std::string> out;
    for (const auto& file : job.earlier.files()) out.push_back(file.filename().string());
    return out;
  }
  std::vector<Hash> noted(const FrameRecords& frames) const {
    FrameNotes notes(Hash{}, *preset_);
    std::vector<Hash> out;
    for (const auto& frame : frames) out.push_back(notes.inputs_of(frame.job));
    return out;
  }
  static std::vector<int> numbers(int first, int last) {
    std::vector<int> out;
    for (int i = first; i <= last; ++i) out.push_back(i);
    return out;
  }

  TemporaryFolder folder_;
  std::unique_ptr<ShaderLibrary> shaders_;
  std::unique_ptr<Preset> preset_;
  FrameListRequest request_;
};

TEST_F(EarlierFilesTest, AreThoseWithinThePreRoll) {
  make(9);
  const FrameRecords frames = records({9, 1, 4}, 2);
  EXPECT_THAT(names(frames[0].job), ElementsAre("s.0007.exr", "s.0008.exr"));
  EXPECT_THAT(names(frames[1].job), ElementsAre());
  EXPECT_THAT(names(frames[2].job), ElementsAre("s.0002.exr", "s.0003.exr"));
  EXPECT_EQ(frames[0].job.earlier.of, frames[2].job.earlier.of) << "one list";
  EXPECT_EQ(frames[0].job.earlier.of->files.size(), 4u) << "of nothing else";
  EXPECT_EQ(records({9}, 0).front().job.earlier.of, nullptr);
}

TEST_F(EarlierFilesTest, EachFileIsLookedAtOnce) {
  constexpr int kFrames = 300;
  make(kFrames);
  const FrameRecords frames = records(numbers(1, kFrames), kFrames);
  looks = 0;
  noted(frames);
  EXPECT_EQ(looks, kFrames);
  const FrameRecords last = records({kFrames}, 9);
  looks = 0;
  noted(last);
  EXPECT_EQ(looks, 10);
  std::vector<int> backwards = numbers(1, kFrames);
  std::ranges::reverse(backwards);
  const FrameRecords reversed = records(backwards, kFrames);
  looks = 0;
  noted(reversed);
  EXPECT_LE(looks, 2 * kFrames) << "as its own, and for those behind it";
}

TEST_F(EarlierFilesTest, AChangeReachesThoseThatLookBackToIt) {
  make(8);
  const FrameRecords frames = records(numbers(1, 8), 3);
  const auto before = noted(frames);
  EXPECT_EQ(noted(frames), before);
  touch(3);
  const auto after = noted(frames);
  std::vector<int> changed;
  for (std::size_t i = 0; i < after.size(); ++i)
    if (after[i] != before[i]) changed.push_back(static_cast<int>(i) + 1);
  EXPECT_THAT(changed, ElementsAre(3, 4, 5, 6));
  std::filesystem::remove(file(4));
  const auto gone = noted(frames);
  for (std::size_t i = 0; i < gone.size(); ++i)
    EXPECT_EQ(gone[i] == Hash{}, i >= 3 && i <= 6) << "frame " << i + 1 << " needs what is not there";
}

TEST_F(EarlierFilesTest, AreTheSameWhicheverFramesAreAskedFor) {
  make(8);
  const auto all = noted(records(numbers(1, 8), 3));
  EXPECT_EQ(noted(records({7}, 3)).front(), all[6]);
  const auto some = noted(records({8, 2, 6}, 3));
  EXPECT_EQ(some, (std::vector<Hash>{all[7], all[1], all[5]}));
}

/// What a history holds is of the file that was read, whatever lies there when the frames behind it run.
TEST_F(EarlierFilesTest, AreNotedAsTheFramesBeforeFoundThem) {
  make(3);
  const FrameRecords frames = records({1, 2, 3}, 3);
  const auto before = noted(frames);
  FrameNotes notes(Hash{}, *preset_);
  notes.inputs_of(frames[0].job);
  touch(1);
  EXPECT_EQ(notes.inputs_of(frames[1].job), before[1]);
  notes.inputs_of(frames[0].job);  // it is run again
  EXPECT_NE(notes.inputs_of(frames[1].job), before[1]);
}

/// Those that are not written, too.
TEST_F(EarlierFilesTest, ThePreRollLooksAtItsFilesBeforeItIsRead) {
  make(3);
  FrameRecords frames = records({3}, 2);
  const auto before = noted(frames);
  FrameNotes notes(Hash{}, *preset_);
  const Schedule schedule = schedule_with_histories(frames, request_, 2, {});
  ASSERT_EQ(schedule.frames.size(), 3u);
  for (const auto& scheduled : schedule.frames) {
    const Hash now = notes.inputs_of(scheduled.record->job);
    EXPECT_EQ(now == before.front(), !scheduled.pre_roll);
    touch(scheduled.record->job.frame);  // while it is read
  }
}

TEST(SequenceStamps, PartsAreWhatTheirFilesAre) {
  constexpr std::size_t kFiles = 13;
  std::vector<Hash> of(kFiles);
  for (std::size_t i = 0; i < kFiles; ++i) of[i] = hash_text(std::to_string(i));
  SequenceStamps stamps(kFiles);
  int asked = 0;
  const auto look = [&](std::size_t file) {
    ++asked;
    return of[file];
  };
  stamps.set(5, hash_text("before"));
  stamps.set(5, of[5]);
  for (std::size_t begin = 0; begin < kFiles; ++begin)
    for (std::size_t end = begin; end <= kFiles; ++end) {
      Hash sum;
      for (std::size_t i = begin; i < end; ++i) sum = {sum.high + of[i].high, sum.low + of[i].low};
      EXPECT_EQ(stamps.of(begin, end, look), sum) << begin << " to " << end;
    }
  EXPECT_EQ(asked, static_cast<int>(kFiles) - 1);
  stamps.set(7, {});
  EXPECT_FALSE(stamps.of(3, 8, look));
  EXPECT_TRUE(stamps.of(3, 7, look));
  stamps.set(7, of[7]);
  EXPECT_TRUE(stamps.of(3, 8, look));
}

TEST(Grouped, AsksEachItemOnce) {
  std::vector<std::string> words;
  for (int i = 0; i < 1000; ++i) words.push_back(std::to_string(i % 500));
  int asked = 0;
  const auto groups = grouped(words, [&](const std::string& word) {
    ++asked;
    return word;
  });
  EXPECT_EQ(asked, 1000);
  ASSERT_EQ(groups.size(), 500u);
  EXPECT_THAT(groups[7], ElementsAre(&words[7], &words[507]));
}

}  // namespace
}  // namespace afterglow
