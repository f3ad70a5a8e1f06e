// SPDX-License-Identifier: MIT
// What has to run again after a change.
#include <gtest/gtest.h>

#include "graph/changes.h"
#include "graphs.h"

namespace afterglow {
namespace {

/// source → half → up ┐
///        └──────────→ add → (fused) grade
struct Scene {
  test::Builder b;
  ImageId half, up, add;
  Plan plan;
  Scene() {
    half = b.filter("half", b.graph.source, {8, 4});
    up = b.filter("up", half, {16, 8});
    b.filter("copy", up, {16, 8});
    add = b.pixel("add", b.graph.result, {{"high", up, true}});
    plan = make_plan(b.graph, {});
  }
  std::vector<bool> run(const std::vector<bool>& stale) const { return kernels_to_run(b.graph, plan, stale); }
  /// Kernels whose keys are others when a kernel does something else, or an image that is brought holds something else.
  std::vector<bool> changed(int kernel, ImageId image = kNoImage) const {
    return changed(b.graph, plan, kernel, image);
  }
  static std::vector<bool> changed(const Graph& graph, const Plan& plan, int kernel, ImageId image) {
    std::vector<Hash> own(plan.kernels.size());
    for (std::size_t i = 0; i < own.size(); ++i) own[i] = {1, i};
    const auto keys = [&](ImageId other) {
      return content_keys(graph, plan, own, [&](ImageId id) {
        return Hash{id == other ? 7u : 2u, static_cast<std::uint64_t>(id)};
      });
    };
    const auto before = keys(kNoImage);
    if (kernel >= 0) own[static_cast<std::size_t>(kernel)].high = 9;
    const auto after = keys(image);
    std::vector<bool> out;
    for (std::size_t i = 0; i < before.size(); ++i) out.push_back(before[i] != after[i]);
    return out;
  }
};

TEST(Changes, NothingRunsWhenNothingChanged) {
  const Scene s;
  ASSERT_EQ(s.plan.kernels.size(), 3u);  // half, up, copy+add
  EXPECT_EQ(s.run({false, false, false}), (std::vector<bool>{false, false, false}));
  EXPECT_EQ(s.changed(-1), (std::vector<bool>{false, false, false}));
}

TEST(Changes, KeysOfWhatIsDownstreamChange) {
  const Scene s;
  EXPECT_EQ(s.changed(0), (std::vector<bool>{true, true, true}));
  EXPECT_EQ(s.changed(1), (std::vector<bool>{false, true, true}));
  EXPECT_EQ(s.changed(2), (std::vector<bool>{false, false, true}));
  EXPECT_EQ(s.changed(-1, s.b.graph.source), (std::vector<bool>{true, true, true}));
}

TEST(Changes, OnlyReadersOfAnInputChange) {
  test::Builder b;
  b.graph.images.push_back({"depth", {16, 8}, -1});
  const ImageId depth = 1;
  b.graph.auxiliary["depth"] = depth;
  const ImageId blur = b.filter("blur", b.graph.source, {16, 8});
  b.sample("fog", {{"source", blur}, {"depth", depth}}, {16, 8});
  EXPECT_EQ(Scene::changed(b.graph, make_plan(b.graph, {}), -1, depth), (std::vector<bool>{false, true}));
}

TEST(Changes, WhatNobodyWantsStaysStale) {
  const Scene s;
  EXPECT_EQ(s.run({false, true, true}), (std::vector<bool>{false, true, true}));
  EXPECT_EQ(s.run({true, false, true}), (std::vector<bool>{false, false, true}));  // `up` holds what it should
  EXPECT_EQ(s.run({true, true, false}), (std::vector<bool>{false, false, false}));
}

}  // namespace
}  // namespace afterglow
