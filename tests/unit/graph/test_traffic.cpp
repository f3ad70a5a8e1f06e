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

/// A channel that is not stored moves nothing; of the result, and where four are wanted, all four are.
TEST(Traffic, FewerChannelsAreFewerBytes) {
  Builder b;
  const ImageId edges = b.sample("edges", {{"in", b.graph.source}}, {16, 8});
  const ImageId weights = b.sample("weights", {{"in", edges}}, {16, 8});
  b.sample("blend", {{"in", b.graph.source}, {"weights", weights}}, {16, 8});
  b.graph.images[static_cast<std::size_t>(edges)].channels = 1;
  b.graph.images[static_cast<std::size_t>(weights)].channels = 2;
  b.graph.images[static_cast<std::size_t>(b.graph.result)].channels = 2;
  for (const Storage storage : {Storage::fp32, Storage::fp16}) {
    const std::uint64_t channel = storage == Storage::fp16 ? 2 : 4;
    EXPECT_EQ(of(b.graph, {.storage = storage}).total, kPixels * channel * (4 + 1 + 1 + 2 + 4 + 2 + 4));
    EXPECT_EQ(of(b.graph, {.storage = storage, .four_channels = true}).total, kPixels * channel * 7 * 4);
    // The most is alive when weights are read and the result is written: 2 + 4 in place of 4 + 4.
    const std::uint64_t few = memory_needed(b.graph, {.storage = storage});
    EXPECT_EQ(memory_needed(b.graph, {.storage = storage, .four_channels = true}) - few, kPixels * channel * 2);
  }
}

/// What a frame hands on has the channels of its history, in full floats or in those of other images.
TEST(Traffic, HistoriesHaveTheirChannels) {
  Builder b;
  b.graph.images.push_back({"before", {16, 8}, -1});
  const auto before = static_cast<ImageId>(b.graph.images.size()) - 1;
  const ImageId kept = b.sample("kept", {{"in", b.graph.source}, {"before", before}}, {16, 8});
  b.sample("out", {{"in", b.graph.source}, {"before", before}}, {16, 8});
  b.graph.images[static_cast<std::size_t>(kept)].channels = 1;
  b.graph.histories.push_back({.name = "past", .effect = "", .previous = before, .next = kept});
  EXPECT_EQ(stored_channels(b.graph, kept, {}), 4);
  const std::uint64_t pixels = kPixels;
  const std::uint64_t four = memory_needed(b.graph, {.storage = Storage::fp16});
  for (const int channels : {1, 2}) {
    b.graph.images[static_cast<std::size_t>(before)].channels = channels;
    const auto count = static_cast<std::uint64_t>(channels);
    EXPECT_EQ(stored_channels(b.graph, kept, {}), channels);
    EXPECT_EQ(stored_channels(b.graph, kept, {.four_channels = true}), 4);
    for (const bool precise : {true, false}) {
      b.graph.histories[0].precise = precise;
      const std::uint64_t bytes = count * (precise ? 4 : 2);
      // Source twice, before twice, kept and the result once.
      EXPECT_EQ(of(b.graph, {.storage = Storage::fp16}).total, pixels * (2 * 8 + 2 * bytes + bytes + 8));
      EXPECT_EQ(four - memory_needed(b.graph, {.storage = Storage::fp16}), 2 * pixels * (16 - bytes));
    }
  }
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
