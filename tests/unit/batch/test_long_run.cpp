// SPDX-License-Identifier: MIT
// What stays in memory of frames that are done.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>
#include <set>

#include "batch/batch_run.h"
#include "batch/schedule.h"
#include "batch/watch_run.h"
#include "image/reader.h"
#include "image/writer.h"
#include "temporary_folder.h"

namespace {
std::atomic<long long> live_bytes = 0;  // of everything that C++ has allocated
}

void* operator new(std::size_t bytes) {
  void* memory = std::malloc(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  live_bytes += static_cast<long long>(malloc_usable_size(memory));
  return memory;
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  void* memory = std::malloc(bytes);
  if (memory != nullptr) live_bytes += static_cast<long long>(malloc_usable_size(memory));
  return memory;
}
void operator delete(void* memory) noexcept {
  live_bytes -= static_cast<long long>(malloc_usable_size(memory));
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }

namespace afterglow {
namespace {

constexpr int kFrames = 1600, kFirst = 100, kSome = 60;

class LongRun : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "look.lua") << "local fx = require \"afterglow\"\n"
                                           "return fx.stack { fx.tone_mapping { mode = \"aces\" } }\n";
    std::filesystem::create_directories(folder_ / "in");
    Picture picture;
    picture.color = Image(16, 8, 4);
    for (float& value : picture.color.pixels) value = 1;
    picture.data_window = picture.display_window = {0, 0, 16, 8};
    ASSERT_TRUE(write_picture(picture, folder_ / "one.exr", {}, diagnostics_));
    for (int i = 1; i <= kFrames; ++i)
      std::filesystem::create_hard_link(folder_ / "one.exr", folder_ / fmt::format("in/{:04}.exr", i));
    request_.preset = folder_ / "look.lua";
    request_.files.inputs = {(folder_ / "in/####.exr").string()};
    request_.files.output = (folder_ / "out/####.exr").string();
    std::filesystem::create_directories(folder_ / "out");
  }

  /// `at` is called before each frame.
  void run(const std::function<void(int)>& at) {
    const RunEvents events{
        diagnostics_,
        [&](std::size_t done, std::size_t, const std::string&, double) { at(static_cast<int>(done)); },
        [] {},
        [](const Error& error) { FAIL() << error.text(); },
        [](const std::string&) {},
        [] { return false; }};
    const auto done = run_batch(request_, events, report_);
    ASSERT_TRUE(done) << done.error().text();
  }

  TemporaryFolder folder_;
  Diagnostics diagnostics_;
  BatchRequest request_;
  RunReport report_;
};

TEST_F(LongRun, FramesThatSkipTheSameShareOneList) {
  run([](int) {});
  ASSERT_EQ(report_.frames.size(), static_cast<std::size_t>(kFrames));
  std::set<const void*> lists;
  for (const auto& frame : report_.frames) {
    ASSERT_TRUE(frame.skipped);
    EXPECT_EQ(frame.skipped->front().reason, "alpha is 1 everywhere");
    lists.insert(frame.skipped.get());
  }
  EXPECT_LE(lists.size(),
            2u);  // the first is run; the others are the same picture, which is told where one is in flight
}

TEST_F(LongRun, NothingIsKeptOfAFrameThatIsDone) {
  // Buffers of single frames come and go, some 30 KB: the least of some frames is told, and there are many frames.
  long long before = std::numeric_limits<long long>::max(), after = before;
  run([&](int done) {
    if (done >= kFirst && done < kFirst + kSome) before = std::min<long long>(before, live_bytes);
    if (done >= kFrames - kSome) after = std::min<long long>(after, live_bytes);
  });
  EXPECT_GT(before, 0);
  constexpr long long kMost =
      32 * (kFrames - kSome - kFirst);  // a note of what each was made of would be three times as much
  EXPECT_LT(after, before + kMost);
}

/// Pictures bring memory that was not taken from there: floats of one that came as halves.
TEST(PixelMemoryKeeps, NoMoreThanWasTakenFromIt) {
  PixelMemory memory;
  constexpr std::size_t kCount = 4 * 64 * 64;
  long long after_two = 0;
  for (int i = 0; i < 20; ++i) {
    Picture picture;
    picture.halves = memory.take_halves(kCount);
    picture.color.pixels.assign(kCount, 1.0f);
    memory.give(std::move(picture));
    if (i == 1) after_two = live_bytes;
  }
  EXPECT_EQ(live_bytes, after_two);
}

/// Of frames that look back to all before them; they need not be there.
class LongHistory : public testing::Test {
 protected:
  static constexpr int kFrames = 2000;
  static constexpr long long kMostEach = 1000;  // bytes; a list of its own for each would be some hundred times as much

  void SetUp() override {
    for (int i = 1; i <= kFrames; ++i) {
      FrameJob job{.frame = i, .input = fmt::format("none/s.{:05}.exr", i), .depth = {}, .normal = {}, .motion = {}};
      job.sequence = "none/s.#####.exr";
      frames_.push_back({.job = std::move(job)});
    }
  }
  FrameRecords frames_;
};

TEST_F(LongHistory, FramesShareTheListOfFilesThatTheyLookBackTo) {
  const long long before = live_bytes;
  note_earlier_files(frames_, {}, kFrames);
  EXPECT_LT(live_bytes - before, kFrames * kMostEach);
}

TEST_F(LongHistory, WatchingKeepsNoListForEachFrame) {
  Diagnostics diagnostics;
  const long long before = live_bytes;
  long long held = 0;
  const RunEvents events{diagnostics,
                         [](std::size_t, std::size_t, const std::string&, double) {},
                         [] {},
                         [](const Error&) {},
                         [](const std::string&) {},
                         [&] {
                           held = live_bytes - before;
                           return true;
                         }};
  const auto done = run_watching(frames_, kFrames, false, events, [] { return Result<void>(); });
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, ErrorKind::interrupted);
  EXPECT_GT(held, 0);
  EXPECT_LT(held, kFrames * kMostEach);
}

}  // namespace
}  // namespace afterglow
