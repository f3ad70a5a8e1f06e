// What has to run again after a change.
#include <gtest/gtest.h>

#include "graph/changes.h"
#include "graphs.h"

namespace afterglow {
namespace {

/// source → half → up ┐
///        └──────────→ add → (joined) grade
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
  std::vector<bool> run(std::vector<bool> kernels, const std::vector<ImageId>& images = {}) const {
    return kernels_to_run(b.graph, plan, kernels, images);
  }
};

TEST(Changes, NothingRunsWhenNothingChanged) {
  const Scene s;
  ASSERT_EQ(s.plan.kernels.size(), 3u);  // half, up, copy+add
  EXPECT_EQ(s.run({false, false, false}), (std::vector<bool>{false, false, false}));
}

TEST(Changes, WhatIsDownstreamRuns) {
  const Scene s;
  EXPECT_EQ(s.run({false, true, false}), (std::vector<bool>{false, true, true}));
  EXPECT_EQ(s.run({false, false, true}), (std::vector<bool>{false, false, true}));
  EXPECT_EQ(s.run({false, false, false}, {s.b.graph.source}), (std::vector<bool>{true, true, true}));
}

TEST(Changes, OnlyReadersOfAnInputRun) {
  test::Builder b;
  b.graph.images.push_back({"depth", {16, 8}, -1});
  const ImageId depth = 1;
  b.graph.auxiliary["depth"] = depth;
  const ImageId blur = b.filter("blur", b.graph.source, {16, 8});
  b.sample("fog", {{"source", blur}, {"depth", depth}}, {16, 8});
  const Plan plan = make_plan(b.graph, {});
  EXPECT_EQ(kernels_to_run(b.graph, plan, {false, false}, {depth}), (std::vector<bool>{false, true}));
}

}  // namespace
}  // namespace afterglow
