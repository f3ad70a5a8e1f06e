// SPDX-License-Identifier: MIT
// How many frames of a sequence are read and written beside the one that is processed.
#include <gtest/gtest.h>

#include <ostream>
#include <utility>

#include "batch/frame_plan.h"

namespace afterglow {

std::ostream& operator<<(std::ostream& out, const Overlap& overlap) {
  return out << overlap.read << " read, " << overlap.written << " written";
}

namespace {

constexpr std::uint64_t kPlenty = 1 << 20;
constexpr FrameNeed kNeed{.device = 100, .reading = 10, .result = 20, .held = 5};  // 135 for one frame

TEST(Overlap, FollowsTheProcessors) {
  EXPECT_EQ(overlap_of(kNeed, kPlenty, 1, false), (Overlap{2, 3}));
  EXPECT_EQ(overlap_of(kNeed, kPlenty, 2, false), (Overlap{2, 3}));
  EXPECT_EQ(overlap_of(kNeed, kPlenty, 8, false), (Overlap{4, 4}));
  EXPECT_EQ(overlap_of(kNeed, kPlenty, 16, false), (Overlap{8, 8}));
  EXPECT_EQ(overlap_of(kNeed, kPlenty, 128, false), (Overlap{8, 8}));
  EXPECT_EQ(overlap_of(kNeed, kPlenty, 0, false), (Overlap{2, 3})) << "a system that does not say";
}

TEST(Overlap, ReadsWhatComesInOrderOneByOne) { EXPECT_EQ(overlap_of(kNeed, kPlenty, 16, true), (Overlap{1, 8})); }

TEST(Overlap, TakesNoMoreThanThereIs) {
  EXPECT_FALSE(overlap_of(kNeed, kNeed.frames(1, 1) - 1, 16, false));
  EXPECT_EQ(overlap_of(kNeed, kNeed.frames(1, 1), 16, false), (Overlap{1, 1}));
  EXPECT_EQ(overlap_of(kNeed, kNeed.frames(1, 1) + 10, 16, false), (Overlap{2, 1})) << "room for one that is read";
  for (std::uint64_t room = kNeed.frames(1, 1); room < 1000; ++room) {
    const Overlap overlap = overlap_of(kNeed, room, 16, false);
    EXPECT_LE(kNeed.frames(overlap.read, overlap.written), room);
    EXPECT_TRUE(overlap.written == 8 || kNeed.frames(overlap.read, overlap.written + 1) > room) << room;
    EXPECT_TRUE(overlap.read == 8 || kNeed.frames(overlap.read + 1, overlap.written) > room) << room;
  }
}

}  // namespace
}  // namespace afterglow
