// SPDX-License-Identifier: MIT
// Which effects a frame's content makes idle, and the graph without them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "graph/condition.h"
#include "graph/plan.h"
#include "graphs.h"

namespace afterglow {
namespace {

using test::Builder;

/// source → glow (half, up, add) → grade; glow is idle up to 0.5.
struct Glow {
  Builder b;
  ImageId half, up, add, grade;
  Glow() {
    half = b.filter("half", 0, {8, 4});
    up = b.filter("up", half, {16, 8});
    add = b.pixel("add", up, {{"high", b.graph.source, true}});
    grade = b.pixel("grade", add);
    b.graph.idle.push_back({"glow", b.graph.source, add, 0.5});
  }
};

TEST(Condition, HoldsUpToItsLimitAndNotAbove) {
  const Glow g;
  EXPECT_EQ(idle_effects(g.b.graph, 0.0f), std::vector<bool>{true});
  EXPECT_EQ(idle_effects(g.b.graph, 0.5f), std::vector<bool>{true});
  EXPECT_EQ(idle_effects(g.b.graph, std::nextafter(0.5f, 1.0f)), std::vector<bool>{false});
  EXPECT_EQ(idle_effects(g.b.graph, std::numeric_limits<float>::infinity()), std::vector<bool>{false});
  EXPECT_EQ(idle_effects(g.b.graph, std::numeric_limits<float>::quiet_NaN()), std::vector<bool>{false});
}

TEST(Condition, LimitsAreRoundedAsShaderParametersAre) {
  Glow g;
  g.b.graph.idle[0].limit = 0.1;  // 0.1f is larger
  EXPECT_EQ(idle_effects(g.b.graph, 0.1f), std::vector<bool>{true});
}

TEST(Condition, AnIdleEffectLeavesTheOthers) {
  const Glow g;
  ASSERT_TRUE(validate(g.b.graph));
  const Graph out = without_idle(g.b.graph, {true});
  ASSERT_TRUE(validate(out)) << validate(out).error().text();
  ASSERT_EQ(out.passes.size(), 1u);
  EXPECT_EQ(out.passes[0].name, "test.grade");
  EXPECT_EQ(out.passes[0].inputs[0].image, out.source);
  EXPECT_EQ(out.result, out.passes[0].output);
  EXPECT_EQ(out.images.size(), 2u);
  ASSERT_EQ(out.skipped.size(), 1u);
  EXPECT_EQ(out.skipped[0].name, "glow");
  EXPECT_EQ(out.skipped[0].reason, "nothing is brighter than 0.5");
}

TEST(Condition, WithoutOtherEffectsNothingIsLeft) {
  Glow g;
  g.b.graph.passes.pop_back();
  g.b.graph.images.pop_back();
  g.b.graph.result = g.add;
  ASSERT_TRUE(validate(g.b.graph));
  const Graph out = without_idle(g.b.graph, {true});
  EXPECT_EQ(out.result, out.source);
  EXPECT_TRUE(out.passes.empty());
}

TEST(Condition, PassesThatOthersReadStay) {
  Builder b;
  const ImageId blur = b.filter("blur", b.graph.source, {16, 8});
  const ImageId add = b.pixel("add", blur, {{"high", b.graph.source, true}});
  b.pixel("mix", add, {{"blur", blur, true}});
  b.graph.idle.push_back({"glow", b.graph.source, add, 1});
  const Graph out = without_idle(b.graph, {true});
  ASSERT_TRUE(validate(out)) << validate(out).error().text();
  ASSERT_EQ(out.passes.size(), 2u);
  EXPECT_EQ(out.passes[1].inputs[0].image, out.source);
  EXPECT_EQ(out.passes[1].inputs[1].image, out.passes[0].output);
}

TEST(Condition, AnEffectBehindAnIdleOneLooksAtTheSourceToo) {
  Builder b;
  const ImageId first = b.pixel("first", b.graph.source);
  const ImageId second = b.pixel("second", first);
  b.graph.idle = {{"a", b.graph.source, first, 0.5}, {"b", first, second, 2}};
  EXPECT_EQ(idle_effects(b.graph, 0.4f), (std::vector<bool>{true, true}));
  EXPECT_EQ(idle_effects(b.graph, 1.0f), (std::vector<bool>{false, false}));  // what `first` makes is not known
  const Graph out = without_idle(b.graph, {true, true});
  EXPECT_EQ(out.result, out.source);
}

TEST(Condition, InputsStayWhetherReadOrNot) {
  Glow g;
  g.b.graph.images.push_back({"depth", {16, 8}, -1});
  const auto depth = static_cast<ImageId>(g.b.graph.images.size()) - 1;
  g.b.graph.auxiliary["depth"] = depth;
  g.b.graph.passes[1].inputs.push_back({"depth", depth});
  const Graph out = without_idle(g.b.graph, {true});
  ASSERT_EQ(out.auxiliary.size(), 1u);
  EXPECT_EQ(out.images[out.auxiliary.at("depth")].name, "depth");
}

TEST(Condition, LimitsAreNoStructureButImagesAre) {
  const Glow a;
  Glow b;
  b.b.graph.idle[0].limit = 2;
  EXPECT_TRUE(same_structure(a.b.graph, b.b.graph));
  b.b.graph.idle[0].output = b.grade;
  EXPECT_FALSE(same_structure(a.b.graph, b.b.graph));
  b.b.graph.idle.clear();
  EXPECT_FALSE(same_structure(a.b.graph, b.b.graph));
}

TEST(Condition, WhatCannotBeIsRefused) {
  const auto refused = [](IdleCondition condition) {
    Glow g;
    condition.effect = "glow";
    g.b.graph.idle = {condition};
    const auto result = validate(g.b.graph);
    return result ? std::string() : result.error().message;
  };
  const Glow g;
  EXPECT_EQ(refused({"", 0, 99, 1}), "idle of effect 'glow': it is about no image of this graph");
  EXPECT_EQ(refused({"", g.add, 0, 1}), "idle of effect 'glow': no pass makes the image that it replaces");
  EXPECT_EQ(refused({"", g.grade, g.add, 1}),
            "idle of effect 'glow': it looks at an image that is made after the one it replaces");
  EXPECT_EQ(refused({"", 0, g.half, 1}), "idle of effect 'glow': the two images have different sizes");
  EXPECT_EQ(refused({"", 0, g.add, std::nan("")}), "idle of effect 'glow': its limit is not finite");
  EXPECT_EQ(refused({"", 0, g.add, 1}), "");
}

TEST(Condition, OpaqueSourcesNeedNoDivision) {
  Glow g;
  for (auto& pass : g.b.graph.passes) pass.straight = pass.kind == PassKind::pixel;
  EXPECT_EQ(straight_passes(g.b.graph), 2);
  const Graph out = without_division(g.b.graph);
  EXPECT_EQ(straight_passes(out), 0);
  EXPECT_EQ(out.passes.size(), g.b.graph.passes.size());
  ASSERT_EQ(out.skipped.size(), 1u);
  EXPECT_EQ(out.skipped[0].name, "division by alpha in 2 passes");
  EXPECT_FALSE(same_structure(out, g.b.graph));
  EXPECT_TRUE(without_division(out).skipped.size() == 1);  // nothing more to leave out
}

}  // namespace
}  // namespace afterglow
