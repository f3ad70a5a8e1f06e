// SPDX-License-Identifier: MIT
// Histories as data: what they need, what goes without them, and what makes them another one.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "graph/changes.h"
#include "graph/condition.h"
#include "graph/history.h"
#include "graph/plan.h"
#include "graph/region.h"
#include "graphs.h"

namespace afterglow {
namespace {

using test::Builder;

/// source → mix (reads before) → grade; mix is kept. `spot`, half as large, is made for nobody else.
struct Trail {
  Builder b;
  ImageId before, spot, mix, grade;
  explicit Trail(bool first = false) {
    before = static_cast<ImageId>(b.graph.images.size());
    b.graph.images.push_back({"test.before", {16, 8}, -1});
    spot = b.pixel("spot", b.graph.source);
    mix = b.sample("mix", {{"source", b.graph.source}, {"before", before}}, {16, 8});
    grade = b.pixel("grade", mix);
    b.graph.histories.push_back({.name = "test.before", .effect = "test", .previous = before, .next = mix});
    if (first) b.graph.histories[0].first = spot;
  }
  std::string error() const {
    const auto valid = validate(b.graph);
    return valid ? "" : valid.error().message;
  }
  History& history() { return b.graph.histories[0]; }
};

TEST(History, GoodOnesAreValid) {
  EXPECT_EQ(Trail().error(), "");
  EXPECT_EQ(Trail(true).error(), "");
}

TEST(History, BadOnesAreRefused) {
  Trail t;
  t.history().next = t.b.graph.source;
  EXPECT_EQ(t.error(), "history 'test.before' of effect 'test': no pass makes 'source' for the next frame");
  t.history().next = t.grade;
  EXPECT_EQ(t.error(), "history 'test.before' of effect 'test': the result cannot be kept for the next frame");
  t.history().next = 99;
  EXPECT_EQ(t.error(), "history 'test.before' of effect 'test': it is about no image of this graph");
  t = Trail();
  t.history().previous = t.spot;
  EXPECT_EQ(t.error(), "history 'test.before' of effect 'test': 'test.spot' cannot be what the frame before made");
  t = Trail();
  t.b.graph.images[t.before].size = {8, 8};
  EXPECT_EQ(t.error(), "history 'test.before' of effect 'test': it is 8×8, but the next frame gets 16×8");
  t = Trail(true);
  t.history().first = t.grade;
  EXPECT_EQ(t.error(), "history 'test.before' of effect 'test': 'test.before' is read before its first image is made");
  t = Trail(true);
  t.history().first = t.before;
  EXPECT_EQ(t.error(), "history 'test.before' of effect 'test': its first image is itself of an earlier frame");
  t = Trail();
  t.history().initial[2] = 1e300;
  EXPECT_EQ(t.error(), "history 'test.before' of effect 'test': its first value is not finite");
  t = Trail();
  t.b.graph.histories.push_back(t.history());
  EXPECT_EQ(t.error(), "history 'test.before' of effect 'test': another one has its name or an image of it");
}

TEST(History, WhatIsKeptIsNeitherJoinedNorShared) {
  const Trail t(true);
  const Plan plan = make_plan(t.b.graph, {});
  ASSERT_EQ(plan.kernels.size(), 3u) << "mix is kept, spot may be read in its place: grade joins neither";
  EXPECT_TRUE(plan.skipped.empty());
  for (std::size_t i = 0; i < plan.transient.size(); ++i) {
    if (plan.transient[i] == t.mix) {
      EXPECT_EQ(plan.lifetimes[i].last, 2);
    }
    if (plan.transient[i] == t.spot) {
      EXPECT_EQ(plan.lifetimes[i].last, 1);
    }
  }
  const Plan without = make_plan(Trail().b.graph, {});
  EXPECT_EQ(without.kernels.size(), 2u);
  ASSERT_EQ(without.skipped.size(), 1u);
  EXPECT_EQ(without.skipped[0].name, "test.spot");
}

TEST(History, StructureCountsValuesDoNot) {
  const Trail a;
  Trail b;
  b.history().initial = {1, 2, 3, 4};
  b.history().pre_roll = 9;
  EXPECT_TRUE(same_structure(a.b.graph, b.b.graph));
  b.history().precise = false;
  EXPECT_FALSE(same_structure(a.b.graph, b.b.graph));
  EXPECT_FALSE(same_structure(a.b.graph, Trail(true).b.graph));
}

TEST(History, ARegionNeedsAllThatIsKept) {
  const Trail t;
  const Plan plan = make_plan(t.b.graph, {});
  const Regions parts = regions(t.b.graph, plan, {4, 4, 2, 2});
  EXPECT_EQ(parts.kernels[0], (Rect{0, 0, 16, 8}));
  EXPECT_EQ(parts.kernels[1], (Rect{4, 4, 2, 2}));
}

TEST(History, WhatItHoldsReachesItsReaders) {
  const auto changed = [](const Graph& graph, const Plan& plan, ImageId image, bool first_kernel) {
    std::vector<Hash> own(plan.kernels.size());
    const auto before = content_keys(graph, plan, own, [](ImageId) { return Hash{}; });
    if (first_kernel) own[0] = {1, 1};
    const auto after = content_keys(graph, plan, own, [&](ImageId id) { return Hash{id == image ? 1u : 0u, 0}; });
    std::vector<bool> out;
    for (std::size_t i = 0; i < before.size(); ++i) out.push_back(before[i] != after[i]);
    return out;
  };
  const Trail t;
  const Plan plan = make_plan(t.b.graph, {});
  EXPECT_EQ(changed(t.b.graph, plan, t.before, false), (std::vector<bool>{true, true}));
  // Through a first image, what makes that counts too.
  const Trail first(true);
  const Plan longer = make_plan(first.b.graph, {});
  EXPECT_EQ(changed(first.b.graph, longer, kNoImage, true), (std::vector<bool>{true, true, true}));
}

TEST(History, WhatIsHandedOnRuns) {
  const Trail t;
  const Plan plan = make_plan(t.b.graph, {});
  EXPECT_EQ(kernels_to_run(t.b.graph, plan, {true, false}), (std::vector<bool>{true, false}));
}

TEST(History, IdleEffectsKeepWhatMakesTheirHistories) {
  Trail t;
  t.b.graph.idle.push_back({"test", t.b.graph.source, t.grade, 0.5});
  ASSERT_TRUE(validate(t.b.graph));
  const Graph out = without_idle(t.b.graph, {true});
  ASSERT_TRUE(validate(out)) << validate(out).error().text();
  ASSERT_EQ(out.histories.size(), 1u);
  std::vector<std::string> names;
  for (const auto& pass : out.passes) names.push_back(pass.name);
  EXPECT_EQ(names, (std::vector<std::string>{"test.spot", "test.mix", "test.result"})) << "and a copy of the source";
  EXPECT_EQ(out.passes.back().inputs[0].image, out.source);
  EXPECT_EQ(out.passes[1].inputs[1].image, out.histories[0].previous);
}

TEST(History, WhatNothingShownReadsGoes) {
  Trail t;
  t.b.graph.result = t.spot;
  drop_unread_histories(t.b.graph);
  ASSERT_TRUE(validate(t.b.graph)) << validate(t.b.graph).error().text();
  EXPECT_TRUE(t.b.graph.histories.empty());
  ASSERT_EQ(t.b.graph.passes.size(), 1u);
  ASSERT_EQ(t.b.graph.skipped.size(), 1u);
  EXPECT_EQ(t.b.graph.skipped[0].name, "test.before");
  Trail used;
  drop_unread_histories(used.b.graph);
  EXPECT_EQ(used.b.graph.histories.size(), 1u);
  EXPECT_TRUE(used.b.graph.skipped.empty());
}

TEST(History, AKeptResultIsCopied) {
  Trail t;
  t.b.graph.result = t.mix;
  EXPECT_NE(t.error(), "");
  separate_result(t.b.graph);
  EXPECT_EQ(t.error(), "");
  EXPECT_EQ(t.b.graph.passes.back().name, "test.result");
  const std::size_t passes = t.b.graph.passes.size();
  separate_result(t.b.graph);
  EXPECT_EQ(t.b.graph.passes.size(), passes);
}

TEST(History, EffectsAddUpTheirPreRolls) {
  Trail t;
  EXPECT_EQ(pre_roll(t.b.graph), 1);
  t.history().pre_roll = 10;
  t.b.graph.histories.push_back(t.history());
  t.b.graph.histories.back().pre_roll = 4;
  EXPECT_EQ(pre_roll(t.b.graph), 10) << "the same effect";
  t.b.graph.histories.back().effect = "other";
  EXPECT_EQ(pre_roll(t.b.graph), 14);
  EXPECT_EQ(pre_roll(Builder().graph), 0);
}

TEST(History, ItsPartIsWhatMakesIt) {
  const Trail a;
  const Hash part = history_part(a.b.graph, a.b.graph.histories[0]);
  const auto part_with = [](const auto& change) {
    Trail t;
    change(t);
    return history_part(t.b.graph, t.b.graph.histories[0]);
  };
  EXPECT_EQ(part, part_with([](Trail& t) { t.b.graph.passes[2].shader = "test/other"; })) << "behind it";
  EXPECT_EQ(part, part_with([](Trail& t) { t.b.graph.passes[1].params["x"] = {ParamType::float1, {2}}; }));
  EXPECT_NE(part, part_with([](Trail& t) { t.b.graph.passes[1].shader = "test/other"; }));
  EXPECT_NE(part, part_with([](Trail& t) { t.b.graph.passes[1].constants["x"] = 2; }));
  EXPECT_NE(part, part_with([](Trail& t) { t.history().precise = false; }));
  // What another effect makes flows in, whatever that is.
  const auto from = [](const std::string& effect) {
    return [effect](Trail& t) {
      t.b.graph.passes[0].effect = effect;
      t.b.graph.passes[1].inputs[0].image = t.spot;
    };
  };
  EXPECT_EQ(part, part_with(from("another")));
  EXPECT_NE(part, part_with(from("test")));
}

TEST(History, IsDumped) {
  Trail t(true);
  const auto json = nlohmann::json::parse(to_json(t.b.graph))["histories"][0];
  EXPECT_EQ(json["name"], "test.before");
  EXPECT_EQ(json["previous"], "test.before");
  EXPECT_EQ(json["next"], "test.mix");
  EXPECT_EQ(json["first"], "test.spot");
  EXPECT_EQ(json["pre_roll"], 1);
  EXPECT_EQ(json["precise"], true);
}

}  // namespace
}  // namespace afterglow
