#include <gtest/gtest.h>

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
  const Plan plan = make_plan(b.graph, {.joining = Joining::none});
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
  EXPECT_EQ(make_plan(b.graph, {.joining = Joining::none}).kernels.size(), 5u);
}

TEST(Plan, KeepsTheBoundaryWhereAnImageHasTwoReaders) {
  Builder b;
  const ImageId a = b.pixel("a", b.graph.source);
  const ImageId c = b.pixel("b", a);
  b.pixel("mix", c, {{"other", a, true}});
  EXPECT_EQ(names(make_plan(b.graph, {})), (Names{"test.a", "test.b+test.mix"}));
}

TEST(Plan, KeepsTheBoundaryWhereOnePassReadsAnImageTwice) {
  Builder b;
  const ImageId a = b.pixel("a", b.graph.source);
  b.pixel("square", a, {{"other", a, true}});
  EXPECT_EQ(make_plan(b.graph, {}).kernels.size(), 2u);
}

TEST(Plan, DoesNotJoinSamplersOrFiltersToWhatFeedsThem) {
  Builder b;
  const ImageId a = b.pixel("a", b.graph.source);
  b.sample("edges", {{"source", a}}, {16, 8});
  EXPECT_EQ(make_plan(b.graph, {}).kernels.size(), 2u);
}

TEST(Plan, JoinedKernelsRunWhereTheirLastPassStood) {
  Builder b;
  const ImageId head = b.filter("head", b.graph.source, {16, 8});
  const ImageId side = b.sample("side", {{"source", b.graph.source}}, {16, 8});
  b.pixel("mix", head, {{"other", side, true}});
  EXPECT_EQ(names(make_plan(b.graph, {})), (Names{"test.side", "test.head+test.mix"}));
}

TEST(Plan, HeadsAreAFilterAndThePixelPassOfItsEffectThatFollows) {
  Builder b;
  const ImageId half = b.pixel("threshold", b.filter("down", b.graph.source, {8, 4}));
  const ImageId up = b.pixel("add", b.filter("up", half, {16, 8}), {{"high", b.graph.source, true}});
  b.pixel("tone", up);  // a second pixel pass stays apart
  EXPECT_EQ(names(make_plan(b.graph, {.joining = Joining::heads})),
            (Names{"test.down+test.threshold", "test.up+test.add", "test.tone"}));
}

TEST(Plan, HeadsOfAnotherEffectStayApart) {
  Builder b;
  b.pixel("tone", b.filter("blur", b.graph.source, {16, 8}));
  b.graph.passes.back().effect = "another";
  EXPECT_EQ(make_plan(b.graph, {.joining = Joining::heads}).kernels.size(), 2u);
  EXPECT_EQ(make_plan(b.graph, {}).kernels.size(), 1u);
}

TEST(Plan, HeadsAreFiltersAlone) {
  Builder b;
  b.pixel("b", b.pixel("a", b.graph.source));
  EXPECT_EQ(make_plan(b.graph, {.joining = Joining::heads}).kernels.size(), 2u);
  Builder c;
  c.pixel("ink", c.sample("edges", {{"source", c.graph.source}}, {16, 8}));
  EXPECT_EQ(make_plan(c.graph, {.joining = Joining::heads}).kernels.size(), 2u);
}

TEST(Plan, StopsBeforeTooManyImages) {
  Builder b;
  std::vector<PassInput> many;
  for (int i = 0; i < 14; ++i) many.push_back({"i" + std::to_string(i), b.graph.source, true});
  const ImageId a = b.pixel("a", b.graph.source, many);
  b.pixel("b", a, {{"x", b.graph.source, true}, {"y", b.graph.source, true}});
  EXPECT_EQ(make_plan(b.graph, {}).kernels.size(), 2u);
}

// On random graphs: joined or not, every pass that matters runs once and after what it reads; lifetimes cover all
// readers.
TEST(Plan, HoldsOnRandomGraphs) {
  std::mt19937 random(7);
  for (int round = 0; round < 500; ++round) {
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
    for (const Joining joining : {Joining::none, Joining::heads, Joining::all}) {
      const Plan plan = make_plan(b.graph, {.joining = joining});
      std::vector<int> made_by(b.graph.images.size(), -1);
      std::vector<int> runs(b.graph.passes.size(), 0);
      for (std::size_t k = 0; k < plan.kernels.size(); ++k) {
        const auto& passes = plan.kernels[k].passes;
        for (std::size_t i = 0; i < passes.size(); ++i) {
          const Pass& pass = b.graph.passes[passes[i]];
          ++runs[passes[i]];
          for (std::size_t n = 0; n < pass.inputs.size(); ++n) {
            const ImageId read = pass.inputs[n].image;
            if (i > 0 && n == 0) {
              EXPECT_EQ(read, b.graph.passes[passes[i - 1]].output);
              continue;
            }
            if (b.graph.images[read].producer < 0) continue;
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

}  // namespace
}  // namespace afterglow
