// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "graph/plan.h"
#include "graphs.h"

namespace afterglow {
namespace {
using test::Builder;

std::vector<std::string> names(const Plan& plan) {
  std::vector<std::string> out;
  for (const auto& kernel : plan.kernels) out.push_back(kernel.name);
  return out;
}
using Names = std::vector<std::string>;

TEST(Plan, NothingToRunWhenTheResultIsTheSource) {
  Builder b;
  EXPECT_TRUE(make_plan(b.graph, {}).kernels.empty());
}

TEST(Plan, DropsPassesNobodyReads) {
  Builder b;
  const ImageId a = b.pixel("a", b.graph.source);
  const ImageId lost = b.filter("lost", a, {4, 4});
  b.filter("lost_too", lost, {2, 2});
  b.pixel("z", a);
  const Plan plan = make_plan(b.graph, {.fusion = Fusion::none});
  EXPECT_EQ(names(plan), (Names{"test.a", "test.z"}));
  ASSERT_EQ(plan.skipped.size(), 2u);
  EXPECT_EQ(plan.skipped[0].name, "test.lost");
  EXPECT_EQ(plan.skipped[0].reason, "nobody reads its image");
}

TEST(Plan, JoinsPixelPassesWithWhatFeedsThem) {
  Builder b;
  const ImageId half = b.pixel("threshold", b.filter("down", b.graph.source, {8, 4}));
  const ImageId up = b.filter("up", half, {16, 8});
  b.pixel("tone", b.pixel("add", up, {{"high", b.graph.source, true}}));
  EXPECT_EQ(names(make_plan(b.graph, {})), (Names{"test.down+test.threshold", "test.up+test.add+test.tone"}));
  EXPECT_EQ(make_plan(b.graph, {.fusion = Fusion::none}).kernels.size(), 5u);
}

TEST(Plan, JoinsPassesWhoseImageAllReadAtTheirOwnPixel) {
  Builder b;
  const ImageId a = b.pixel("a", b.graph.source);
  const ImageId c = b.pixel("b", a);
  b.pixel("mix", c, {{"other", a, true}});
  const Plan plan = make_plan(b.graph, {});
  EXPECT_EQ(names(plan), (Names{"test.a+test.b+test.mix"}));
  const PlanKernel& kernel = plan.kernels[0];
  EXPECT_EQ(value_in(b.graph, kernel, b.graph.source), 0);  // what the anchor reads
  EXPECT_EQ(value_in(b.graph, kernel, a), 1);
  EXPECT_EQ(value_in(b.graph, kernel, c), 2);
}

TEST(Plan, JoinsAPassThatReadsAnImageTwice) {
  Builder b;
  const ImageId a = b.pixel("a", b.graph.source);
  b.pixel("square", a, {{"other", a, true}});
  EXPECT_EQ(make_plan(b.graph, {}).kernels.size(), 1u);
}

TEST(Plan, KeepsTheBoundaryWhereAnImageIsReadAround) {
  Builder b;
  const ImageId a = b.pixel("a", b.graph.source);
  const ImageId c = b.sample("lines", {{"picture", a, false}}, {16, 8});
  b.pixel("mix", c, {{"other", a, true}});
  EXPECT_EQ(names(make_plan(b.graph, {})), (Names{"test.a", "test.lines+test.mix"}));
}

TEST(Plan, PutsAMaskIntoTheKernelThatItMasks) {
  Builder b;
  const ImageId before = b.pixel("before", b.graph.source);
  const ImageId effect = b.pixel("effect", before);
  const ImageId luma = b.pixel("luma", before), radial = b.pixel("radial", before);
  const ImageId mask = b.pixel("multiply", luma, {{"other", radial, true}});
  b.pixel("blend", effect, {{"below", before, true}, {"mask", mask, true}});
  EXPECT_EQ(names(make_plan(b.graph, {})),
            (Names{"test.before+test.effect+test.luma+test.radial+test.multiply+test.blend"}));
}

TEST(Plan, AHeadStandsFirstWhateverIsJoinedToIt) {
  Builder b;
  const ImageId a = b.pixel("a", b.graph.source);
  const ImageId blur = b.filter("blur", b.graph.source, {16, 8});
  b.pixel("add", blur, {{"high", a, true}});
  const Plan plan = make_plan(b.graph, {});
  EXPECT_EQ(names(plan), (Names{"test.blur+test.a+test.add"}));
  EXPECT_EQ(value_in(b.graph, plan.kernels[0], blur), 0);
  EXPECT_EQ(value_in(b.graph, plan.kernels[0], a), 1);
  EXPECT_EQ(value_in(b.graph, plan.kernels[0], b.graph.source), std::nullopt);
}

TEST(Plan, WhatNoPictureReachesIsMadeOnceAndSharesNothing) {
  Builder b;
  const ImageId spots = b.sample("spots", {}, {8, 4});
  const ImageId tinted = b.pixel("tint", b.filter("soft", spots, {16, 8}));
  const ImageId blurred = b.filter("blur", b.graph.source, {16, 8});
  b.pixel("tone", b.pixel("lit", blurred, {{"dirt", tinted, true}}));
  for (const Fusion fusion : {Fusion::none, Fusion::filters, Fusion::all}) {
    const Plan plan = make_plan(b.graph, {.fusion = fusion});
    if (fusion == Fusion::all) {
      EXPECT_EQ(names(plan), (Names{"test.spots", "test.soft+test.tint", "test.blur+test.lit+test.tone"}))
          << "what is made in each frame does not take along what is not";
    }
    const int end = static_cast<int>(plan.kernels.size()) - 1;
    ASSERT_EQ(plan.once.size(), plan.kernels.size());
    for (std::size_t k = 0; k < plan.kernels.size(); ++k) {
      const std::string& name = plan.kernels[k].name;
      EXPECT_EQ(plan.once[k], name.find("lit") == name.npos && name != "test.blur" && name != "test.tone") << name;
      EXPECT_EQ(plan.transient[k], plan.kernels[k].output);
      if (plan.once[k]) {
        EXPECT_EQ(plan.lifetimes[k].first, 0) << name;
        EXPECT_EQ(plan.lifetimes[k].last, end) << name;
      }
    }
  }
}

TEST(Plan, ResultsAndWhatFramesHandOnAreMadeInEachFrame) {
  Builder b;
  b.sample("spots", {}, {16, 8});
  EXPECT_EQ(make_plan(b.graph, {}).once, std::vector<bool>{false});
  const ImageId made = b.sample("more", {}, {16, 8});
  b.graph.images.push_back({"test.before", {16, 8}, -1});
  const auto before = static_cast<ImageId>(b.graph.images.size()) - 1;
  b.pixel("mix", before);
  b.graph.histories = {{.name = "test.before", .effect = "test", .previous = before, .next = made}};
  EXPECT_EQ(make_plan(b.graph, {}).once, (std::vector<bool>{false, false}));
}

TEST(Plan, TwoAnchorsShareNoKernel) {
  Builder b;
  const ImageId a = b.filter("a", b.graph.source, {16, 8}), c = b.filter("c", b.graph.source, {16, 8});
  b.pixel("add", a, {{"other", c, true}});
  EXPECT_EQ(names(make_plan(b.graph, {})), (Names{"test.c", "test.a+test.add"}));
}

TEST(Plan, DoesNotJoinSamplersOrFiltersToWhatFeedsThem) {
  Builder b;
  const ImageId a = b.pixel("a", b.graph.source);
  b.sample("edges", {{"source", a}}, {16, 8});
  EXPECT_EQ(make_plan(b.graph, {}).kernels.size(), 2u);
}

TEST(Plan, CutsBehindASamplerWhereManyPassesGainByRows) {
  const auto plan_of = [](int passes, Size size, const ExecutionConfig& config) {
    Builder b;
    ImageId last = b.sample("lens", {{"picture", b.graph.source, false}}, size);
    const ImageId lens = last;
    for (int i = 0; i < passes; ++i) last = b.pixel("p" + std::to_string(i), last, {{"lens", lens, true}});
    return names(make_plan(b.graph, config));
  };
  constexpr Size kLarge{1024, 512};
  constexpr ExecutionConfig kRows{.rows = 8};
  const Names one{"test.lens+test.p0+test.p1+test.p2+test.p3+test.p4"};
  EXPECT_EQ(plan_of(5, kLarge, kRows), (Names{"test.lens", "test.p0+test.p1+test.p2+test.p3+test.p4"}));
  EXPECT_EQ(plan_of(5, kLarge, {}), one) << "without rows nothing is gained";
  EXPECT_EQ(plan_of(5, {1024, 511}, kRows), one) << "small images are not worth it";
  EXPECT_EQ(plan_of(5, kLarge, {.storage = Storage::fp16, .rows = 8}), one) << "half floats would round the image";
  EXPECT_EQ(plan_of(4, kLarge, kRows), (Names{"test.lens+test.p0+test.p1+test.p2+test.p3"}));
}

TEST(Plan, JoinedKernelsRunWhereTheirLastPassStood) {
  Builder b;
  const ImageId anchor = b.filter("anchor", b.graph.source, {16, 8});
  const ImageId side = b.sample("side", {{"source", b.graph.source}}, {16, 8});
  b.pixel("mix", anchor, {{"other", side, true}});
  EXPECT_EQ(names(make_plan(b.graph, {})), (Names{"test.side", "test.anchor+test.mix"}));
}

TEST(Plan, HeadsAreAFilterAndThePixelPassOfItsEffectThatFollows) {
  Builder b;
  const ImageId half = b.pixel("threshold", b.filter("down", b.graph.source, {8, 4}));
  const ImageId up = b.pixel("add", b.filter("up", half, {16, 8}), {{"high", b.graph.source, true}});
  b.pixel("tone", up);  // a second pixel pass stays apart
  EXPECT_EQ(names(make_plan(b.graph, {.fusion = Fusion::filters})),
            (Names{"test.down+test.threshold", "test.up+test.add", "test.tone"}));
}

TEST(Plan, HeadsOfAnotherEffectStayApart) {
  Builder b;
  b.pixel("tone", b.filter("blur", b.graph.source, {16, 8}));
  b.graph.passes.back().effect = "another";
  EXPECT_EQ(make_plan(b.graph, {.fusion = Fusion::filters}).kernels.size(), 2u);
  EXPECT_EQ(make_plan(b.graph, {}).kernels.size(), 1u);
}

TEST(Plan, HeadsAreFiltersAlone) {
  Builder b;
  b.pixel("b", b.pixel("a", b.graph.source));
  EXPECT_EQ(make_plan(b.graph, {.fusion = Fusion::filters}).kernels.size(), 2u);
  Builder c;
  c.pixel("ink", c.sample("edges", {{"source", c.graph.source}}, {16, 8}));
  EXPECT_EQ(make_plan(c.graph, {.fusion = Fusion::filters}).kernels.size(), 2u);
}

TEST(Plan, StopsBeforeTooManyImages) {
  Builder b;
  std::vector<PassInput> many;
  for (int i = 0; i < 14; ++i) {
    const std::string name = "i" + std::to_string(i);
    many.push_back({name, b.filter(name, b.graph.source, {16, 8}), true});
  }
  const ImageId x = b.filter("x", b.graph.source, {16, 8}), y = b.filter("y", b.graph.source, {16, 8});
  const ImageId a = b.pixel("a", b.graph.source, many);
  b.pixel("b", a, {{"x", x, true}, {"y", y, true}});
  EXPECT_EQ(make_plan(b.graph, {}).kernels.back().name, "test.x+test.b");  // with "a" there would be 17 images
}

TEST(Plan, StopsBeforeKernelsGrowTooLong) {
  Builder b;
  ImageId image = b.filter("blur", b.graph.source, {16, 8});
  for (int i = 0; i < 60; ++i) image = b.pixel("p" + std::to_string(i), image);
  std::size_t longest = 0, passes = 0;
  const Plan plan = make_plan(b.graph, {});
  for (const auto& kernel : plan.kernels) {
    longest = std::max(longest, kernel.passes.size());
    passes += kernel.passes.size();
  }
  EXPECT_EQ(passes, 61u);
  EXPECT_EQ(longest, 24u);
  EXPECT_EQ(plan.kernels.size(), 3u);
}

// On random graphs: fused or not, every pass that matters runs once and after what it reads; lifetimes cover all
// readers.
TEST(Plan, HoldsOnRandomGraphs) {
  std::mt19937 random(7);
  for (int round = 0; round < 2000; ++round) {
    Builder b;
    std::vector<ImageId> images{b.graph.source};
    const int count = 1 + static_cast<int>(random() % 12);
    for (int i = 0; i < count; ++i) {
      const auto pick = [&] { return images[random() % images.size()]; };
      const std::string name = "p" + std::to_string(i);
      switch (random() % 3) {
        case 0:
          images.push_back(b.pixel(name, pick(), {{"other", pick(), true}}));
          break;
        case 1:
          images.push_back(b.filter(name, pick(), {16, 8}));
          break;
        default:
          images.push_back(b.pixel(name, pick()));
          break;
      }
    }
    ASSERT_TRUE(validate(b.graph));
    for (const Fusion fusion : {Fusion::none, Fusion::filters, Fusion::all}) {
      const Plan plan = make_plan(b.graph, {.fusion = fusion});
      std::vector<int> made_by(b.graph.images.size(), -1);
      std::vector<int> runs(b.graph.passes.size(), 0);
      for (std::size_t k = 0; k < plan.kernels.size(); ++k) {
        const auto& passes = plan.kernels[k].passes;
        for (std::size_t i = 0; i < passes.size(); ++i) {
          const Pass& pass = b.graph.passes[passes[i]];
          ++runs[passes[i]];
          for (std::size_t n = 0; n < pass.inputs.size(); ++n) {
            const ImageId read = pass.inputs[n].image;
            const int producer = b.graph.images[read].producer;
            const auto here = std::ranges::find(passes, producer);
            if (here != passes.end()) {
              EXPECT_LT(here - passes.begin(), static_cast<std::ptrdiff_t>(i));
              EXPECT_TRUE(reads_own_pixel(pass, pass.inputs[n]));
              EXPECT_TRUE(value_in(b.graph, plan.kernels[k], read));
              continue;
            }
            if (producer < 0) continue;
            ASSERT_GE(made_by[read], 0);
            const auto it = std::find(plan.transient.begin(), plan.transient.end(), read);
            ASSERT_NE(it, plan.transient.end());
            const auto life = plan.lifetimes[it - plan.transient.begin()];
            EXPECT_LE(life.first, static_cast<int>(k));
            EXPECT_GE(life.last, static_cast<int>(k));
          }
        }
        made_by[plan.kernels[k].output] = static_cast<int>(k);
        EXPECT_EQ(plan.kernels[k].output, b.graph.passes[passes.back()].output);
      }
      for (const int n : runs) EXPECT_LE(n, 1);
      EXPECT_EQ(std::count(runs.begin(), runs.end(), 1) + static_cast<long>(plan.skipped.size()),
                static_cast<long>(b.graph.passes.size()));
      EXPECT_EQ(made_by[b.graph.result], static_cast<int>(plan.kernels.size()) - 1);
    }
  }
}

/// The least uniform block that a device has holds 16 KiB.
TEST(Plan, ParametersOfAKernelFitIntoEveryDevice) {
  Builder b;
  ImageId image = b.graph.source;
  for (const char* name : {"a", "b", "c", "d", "e"}) {
    image = b.pixel(name, image);
    b.graph.passes.back().params["all"] = {ParamType::float4, std::vector<double>(4 * 256), 256};  // 4 KiB
  }
  const Plan plan = make_plan(b.graph, {});
  EXPECT_EQ(names(plan), (Names{"test.a+test.b+test.c+test.d", "test.e"}));
}

}  // namespace
}  // namespace afterglow
