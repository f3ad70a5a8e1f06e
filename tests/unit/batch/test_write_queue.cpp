// SPDX-License-Identifier: MIT
// Frames on their way into one thing: made ready beside each other, written in order.
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <vector>

#include "batch/write_queue.h"

namespace afterglow {
namespace {

constexpr std::chrono::minutes kLongest{2};  // until a test that can no longer succeed gives up

class OneThing : public FrameSink {
 public:
  explicit OneThing(std::size_t bad) : bad_(bad) {}

  /// The first frame is not written before the second one has begun.
  Result<void> write(const FrameJob&, std::size_t index, const Picture&, const Turn& turn) override {
    if (index == 1) second_begun_.set_value();
    AFTERGLOW_CHECK(turn());
    if (index == 0) overlaps_ = second_begun_.get_future().wait_for(kLongest) == std::future_status::ready;
    if (index == bad_) return Error{ErrorKind::io, "the disk is full"};
    written.push_back(index);
    return {};
  }
  bool overlaps() const { return overlaps_; }

  std::vector<std::size_t> written;

 private:
  std::size_t bad_;
  std::promise<void> second_begun_;
  bool overlaps_ = false;
};

constexpr std::size_t kQueued = 6;

std::vector<bool> results_of(OneThing& sink) {
  PixelMemory memory;
  FrameRecords records(kQueued);
  WriteQueue queue(sink, memory);
  for (std::size_t i = 0; i < kQueued; ++i) queue.add(records[i], i, {});
  std::vector<bool> results;
  while (const auto done = queue.take()) {
    EXPECT_EQ(done->frame, &records[results.size()]);
    results.push_back(static_cast<bool>(done->result));
  }
  return results;
}

TEST(WriteQueue, MakesFramesReadyBesideThoseBeforeAndWritesThemInOrder) {
  OneThing sink(kQueued);
  EXPECT_EQ(results_of(sink), std::vector<bool>(kQueued, true));
  EXPECT_TRUE(sink.overlaps());
  EXPECT_EQ(sink.written, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5}));
}

TEST(WriteQueue, WritesNothingBehindAFrameThatCouldNotBe) {
  OneThing sink(2);
  EXPECT_EQ(results_of(sink), (std::vector<bool>{true, true, false, false, false, false}));
  EXPECT_EQ(sink.written, (std::vector<std::size_t>{0, 1}));
}

}  // namespace
}  // namespace afterglow
