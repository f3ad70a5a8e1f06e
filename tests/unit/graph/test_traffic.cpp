// SPDX-License-Identifier: MIT
// Bytes that kernels move, counted by hand.
#include <gtest/gtest.h>

#include "graph/memory.h"
#include "graphs.h"

namespace afterglow {
namespace {

using test::Builder;

constexpr std::uint64_t kPixels = 16 * 8, kFull = 16, kHalf = 8;

Traffic of(const Graph& graph, const ExecutionConfig& config = {}) {
  return traffic_of(graph, make_plan(graph, config), config);
}

TEST(Traffic, OneFusedKernelMovesWhatCannotBeSpared) {
  Builder b;
  b.pixel("b", b.pixel("a", b.graph.source));
  const Traffic fused = of(b.graph);
  ASSERT_EQ(fused.kernels.size(), 1u);
  EXPECT_EQ(fused.kernels[0].read, kPixels * kFull);
  EXPECT_EQ(fused.kernels[0].written, kPixels * kFull);
  EXPECT_EQ(fused.total, 2 * kPixels * kFull);
  EXPECT_EQ(fused.unavoidable, fused.total);
  EXPECT_EQ(fused.excess(), 1);
  const Traffic half = of(b.graph, {.storage = Storage::fp16});
  EXPECT_EQ(half.total, 2 * kPixels * kHalf);
  EXPECT_DOUBLE_EQ(half.milliseconds(1e6), 2.0 * kPixels * kHalf / 1e3);
  const Traffic apart = of(b.graph, {.fusion = Fusion::none});
  EXPECT_EQ(apart.total, 4 * kPixels * kFull);
  EXPECT_EQ(apart.unavoidable, fused.unavoidable);
  EXPECT_EQ(apart.excess(), 2);
}

/// What the first of two draws of a sample pass leaves behind takes 16 bits a pixel, of the largest one alone.
TEST(MemoryNeeded, CountsWhatTwoDrawsMark) {
  Builder pixels, samples;
  pixels.pixel("b", pixels.pixel("a", pixels.graph.source));
  samples.sample("b", {{"in", samples.sample("a", {{"in", samples.graph.source}}, {16, 8})}}, {16, 8});
  const ExecutionConfig plain{.fusion = Fusion::none};
  EXPECT_EQ(memory_needed(samples.graph, plain), memory_needed(pixels.graph, plain) + 2 * kPixels);
}

TEST(Traffic, PyramidsAreToldApartAndImagesReadTwiceByAKernelCountOnce) {
  Builder b;
  const ImageId down = b.filter("down", b.graph.source, {8, 4});
  b.sample("mix", {{"high", b.graph.source}, {"low", down}, {"again", b.graph.source}}, {16, 8});
  const Traffic traffic = of(b.graph);
  const std::uint64_t small = kPixels / 4 * kFull;
  EXPECT_EQ(traffic.small, 2 * small);  // written once, read once
  EXPECT_EQ(traffic.total, 3 * kPixels * kFull + 2 * small);
  EXPECT_EQ(traffic.unavoidable, 2 * kPixels * kFull);
  EXPECT_DOUBLE_EQ(traffic.excess(), 1.5);
}

TEST(Traffic, WhatIsMadeOnceMovesNothingBetweenFrames) {
  Builder b;
  const ImageId spots = b.sample("spots", {}, {16, 8});
  b.sample("lit", {{"source", b.graph.source}, {"dirt", spots}}, {16, 8});
  const Traffic traffic = of(b.graph);
  ASSERT_EQ(traffic.kernels.size(), 2u);
  EXPECT_EQ(traffic.kernels[0].written, 0u);
  EXPECT_EQ(traffic.total, 3 * kPixels * kFull);
}

TEST(Traffic, RegionsMoveTheirPart) {
  Builder b;
  b.pixel("a", b.graph.source);
  const Plan plan = make_plan(b.graph, {});
  const Regions parts = regions(b.graph, plan, {4, 2, 5, 3});
  const Traffic traffic = traffic_of(b.graph, plan, {}, &parts);
  EXPECT_EQ(traffic.total, 2 * 15 * kFull);
  EXPECT_EQ(traffic.unavoidable, traffic.total);
}

TEST(Traffic, NothingThatRunsMovesNothing) {
  const Builder b;
  EXPECT_EQ(of(b.graph).total, 0u);
  EXPECT_EQ(of(b.graph).excess(), 0);
}

}  // namespace
}  // namespace afterglow
