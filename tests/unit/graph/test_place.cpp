// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <random>

#include "graph/plan.h"

namespace afterglow {
namespace {

TEST(Place, SharesMemoryOfBlocksThatNeverMeet) {
  const std::vector<Block> blocks{{100, 16, 0, 1}, {60, 16, 1, 2}, {100, 16, 2, 3}};
  const Placement shared = place(blocks, true);
  EXPECT_EQ(shared.offsets[0], shared.offsets[2]);
  EXPECT_EQ(shared.sum, 260u);
  EXPECT_EQ(shared.lower_bound, 160u);
  EXPECT_EQ(shared.total, 172u);  // 100, aligned to 112, + 60
  EXPECT_GE(place(blocks, false).total, 260u);
}

TEST(Place, EmptyNeedsNothing) { EXPECT_EQ(place({}, true).total, 0u); }

TEST(Place, NeverOverlapsWhatLivesAtOnce) {
  std::mt19937_64 random(11);
  for (int round = 0; round < 1000; ++round) {
    std::vector<Block> blocks(1 + random() % 20);
    for (auto& block : blocks) {
      block.size = 1 + random() % 1000;
      block.alignment = std::uint64_t{1} << (random() % 9);
      block.first = static_cast<int>(random() % 20);
      block.last = block.first + static_cast<int>(random() % 8);
    }
    for (const bool share : {true, false}) {
      const Placement p = place(blocks, share);
      EXPECT_GE(p.total, p.lower_bound);
      for (std::size_t i = 0; i < blocks.size(); ++i) {
        EXPECT_EQ(p.offsets[i] % blocks[i].alignment, 0u);
        EXPECT_LE(p.offsets[i] + blocks[i].size, p.total);
        for (std::size_t j = 0; j < i; ++j) {
          const bool alive_together = blocks[i].first <= blocks[j].last && blocks[j].first <= blocks[i].last;
          const bool overlap =
              p.offsets[i] < p.offsets[j] + blocks[j].size && p.offsets[j] < p.offsets[i] + blocks[i].size;
          EXPECT_FALSE(overlap && (alive_together || !share));
        }
      }
    }
  }
}

}  // namespace
}  // namespace afterglow
