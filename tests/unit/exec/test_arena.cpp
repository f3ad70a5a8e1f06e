// SPDX-License-Identifier: MIT
// Which blocks share an allocation: as data, without a device.
#include <gtest/gtest.h>

#include <set>

#include "exec/arena.h"

namespace afterglow {
namespace {

constexpr std::uint64_t kMiB = 1u << 20;

TEST(GroupBlocks, AllInOneAllocationWhenItFits) {
  const std::vector<Block> blocks{{4 * kMiB, 256, 0, 1}, {4 * kMiB, 256, 1, 2}, {4 * kMiB, 256, 2, 3}};
  const auto groups = group_blocks(blocks, true, 64 * kMiB);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].blocks, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(groups[0].placement.total, 8 * kMiB);
  EXPECT_EQ(group_blocks(blocks, false, 64 * kMiB)[0].placement.total, 12 * kMiB);
}

TEST(GroupBlocks, LargestBlocksGetAllocationsOfTheirOwnWhenOneIsTooSmall) {
  const std::vector<Block> blocks{{3 * kMiB, 1, 0, 9}, {10 * kMiB, 1, 0, 9}, {4 * kMiB, 1, 0, 9}, {9 * kMiB, 1, 0, 9}};
  const auto groups = group_blocks(blocks, true, 12 * kMiB);
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[0].blocks, (std::vector<int>{1}));
  EXPECT_EQ(groups[1].blocks, (std::vector<int>{3}));
  EXPECT_EQ(groups[2].blocks, (std::vector<int>{0, 2}));
  EXPECT_EQ(groups[2].placement.total, 7 * kMiB);
  std::set<int> seen;
  for (const auto& group : groups) {
    EXPECT_LE(group.placement.total, 12 * kMiB);
    EXPECT_EQ(group.placement.offsets.size(), group.blocks.size());
    seen.insert(group.blocks.begin(), group.blocks.end());
  }
  EXPECT_EQ(seen.size(), blocks.size());
}

TEST(GroupBlocks, NothingForNothing) { EXPECT_TRUE(group_blocks({}, true, kMiB).empty()); }

TEST(GroupBlocks, ABlockThatIsTooLargeStaysAloneForTheDeviceToRefuse) {
  const auto groups = group_blocks({{8 * kMiB, 1, 0, 0}}, true, kMiB);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].placement.total, 8 * kMiB);
}

}  // namespace
}  // namespace afterglow
