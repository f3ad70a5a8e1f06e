// SPDX-License-Identifier: MIT
// Medians, spreads, and which points are on the front.
#include <gtest/gtest.h>

#include "bench/turns.h"
#include "reports.h"

namespace afterglow::bench {
namespace {

TEST(Spread, MedianAndQuartilesOfKnownSamples) {
  const Spread odd = Spread::of({5, 1, 4, 2, 3});
  EXPECT_DOUBLE_EQ(odd.median, 3);
  EXPECT_DOUBLE_EQ(odd.lower, 2);
  EXPECT_DOUBLE_EQ(odd.upper, 4);
  EXPECT_EQ(odd.samples, (std::vector<double>{5, 1, 4, 2, 3}));
  const Spread even = Spread::of({4, 1, 3, 2});
  EXPECT_DOUBLE_EQ(even.median, 2.5);
  EXPECT_DOUBLE_EQ(even.lower, 1.75);
  EXPECT_DOUBLE_EQ(even.upper, 3.25);
}

TEST(Spread, OneSampleAndNone) {
  EXPECT_DOUBLE_EQ(Spread::of({7}).upper, 7);
  EXPECT_DOUBLE_EQ(Spread::of({}).median, 0);
}

TEST(Spread, OutliersDoNotMoveTheMedian) { EXPECT_DOUBLE_EQ(Spread::of({1, 1, 1, 1, 1e9}).median, 1); }

std::vector<bool> fronts(std::vector<Point> points) {
  std::vector<bool> out;
  const auto report = test::report(std::move(points));
  for (const auto& p : report.cells[0].points) out.push_back(p.front);
  return out;
}

TEST(Front, IsWhatNothingBeatsInBoth) {
  using test::point;
  EXPECT_EQ(fronts({point("a", 10, 1e-3), point("b", 5, 1e-2), point("c", 12, 1e-2), point("d", 20, 1e-6)}),
            (std::vector<bool>{true, true, false, true}));
}

TEST(Front, EqualPointsAreBothOnIt) {
  EXPECT_EQ(fronts({test::point("a", 10, 1e-3), test::point("b", 10, 1e-3)}), (std::vector<bool>{true, true}));
}

TEST(Front, OneEqualAndOneWorseIsBeaten) {
  EXPECT_EQ(fronts({test::point("a", 10, 1e-3), test::point("b", 10, 2e-3)}), (std::vector<bool>{true, false}));
  EXPECT_EQ(fronts({test::point("a", 10, 1e-3), test::point("b", 11, 1e-3)}), (std::vector<bool>{true, false}));
}

TEST(Front, PointsWithoutQualityNeitherStandNorBeat) {
  Point unknown = test::point("fast", 1, 0);
  unknown.quality.reset();
  EXPECT_EQ(fronts({unknown, test::point("b", 10, 1e-3)}), (std::vector<bool>{false, true}));
}

TEST(InTurns, EveryRoundRunsAllAndBeginsWithAnother) {
  std::string order;
  std::vector<Measured> all;
  for (const char name : {'a', 'b', 'c'})
    all.emplace_back([&order, name]() -> Result<double> {
      order += name;
      return static_cast<double>(order.size());
    });
  const auto spreads = run_in_turns(all, 3, [](int) { return Result<void>(); });
  ASSERT_TRUE(spreads);
  EXPECT_EQ(order, "abcbcacababc");                                   // the first three warm up
  EXPECT_EQ((*spreads)[0].samples, (std::vector<double>{6, 8, 10}));  // a: last of "bca", second of "cab", …
  EXPECT_EQ((*spreads)[2].samples, (std::vector<double>{5, 7, 12}));
}

TEST(InTurns, StopsWhenTheStepOrTheWorkFails) {
  int runs = 0;
  const std::vector<Measured> fine{[&]() -> Result<double> { return ++runs; }};
  const auto stopped = run_in_turns(fine, 9, [](int round) -> Result<void> {
    if (round == 2) return Error{ErrorKind::interrupted, "stop"};
    return {};
  });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().kind, ErrorKind::interrupted);
  EXPECT_EQ(runs, 2);
  const std::vector<Measured> broken{[]() -> Result<double> { return Error{ErrorKind::device, "lost"}; }};
  EXPECT_FALSE(run_in_turns(broken, 1, [](int) { return Result<void>(); }));
}

}  // namespace
}  // namespace afterglow::bench
