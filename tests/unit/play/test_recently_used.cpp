// SPDX-License-Identifier: MIT
// The order of use, and what it costs: comparisons of keys are counted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "play/recently_used.h"

namespace afterglow {
namespace {

using ::testing::ElementsAre;

int compared = 0;

struct CountedKey {
  int number = 0;
  friend bool operator==(const CountedKey& a, const CountedKey& b) {
    ++compared;
    return a.number == b.number;
  }
  friend bool operator<(const CountedKey& a, const CountedKey& b) {
    ++compared;
    return a.number < b.number;
  }
};

template <class Key>
std::vector<int> values(const RecentlyUsed<Key, int>& used) {
  std::vector<int> out;
  for (const auto& entry : used.entries()) out.push_back(entry.value);
  return out;
}

TEST(RecentlyUsed, KeepsTheOrderOfUse) {
  RecentlyUsed<int, int> used;
  for (const int key : {1, 2, 3, 4}) used.put(key, 10 * key);
  EXPECT_THAT(values(used), ElementsAre(40, 30, 20, 10));
  EXPECT_TRUE(used.touch(2));
  EXPECT_EQ(*used.find(1), 10) << "which is no use";
  EXPECT_THAT(values(used), ElementsAre(20, 40, 30, 10));
  used.put(3, 31);
  EXPECT_THAT(values(used), ElementsAre(31, 20, 40, 10));
  used.erase(2);
  EXPECT_THAT(values(used), ElementsAre(31, 40, 10));
  EXPECT_FALSE(used.touch(2));
  EXPECT_EQ(used.find(2), nullptr);
  EXPECT_EQ(used.size(), 3u);
  used.clear();
  EXPECT_FALSE(used.contains(1));
  EXPECT_TRUE(used.entries().empty());
}

TEST(RecentlyUsed, NothingWalksAllOfThem) {
  constexpr int kMany = 1 << 14, kSome = 256,
                kMostEach = 2 * 2 * 15;  // two ways down a tree of 2¹⁴, never balanced well
  RecentlyUsed<CountedKey, int> used;
  for (int i = 0; i < kMany; ++i) used.put({i}, i);
  compared = 0;
  for (int i = 0; i < kSome; ++i) EXPECT_TRUE(used.touch({i * (kMany / kSome)}));
  EXPECT_LT(compared, kSome * kMostEach) << "touched";
  compared = 0;
  for (int i = 0; i < kSome; ++i) used.erase({i * (kMany / kSome)});
  EXPECT_LT(compared, kSome * kMostEach) << "erased";
  compared = 0;
  for (int i = 0; i < kSome; ++i) used.put({kMany + i}, i);
  EXPECT_LT(compared, kSome * kMostEach) << "put";
}

}  // namespace
}  // namespace afterglow
