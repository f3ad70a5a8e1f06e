// SPDX-License-Identifier: MIT
// From a preset file to a graph.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene.h"

namespace afterglow::test {
namespace {

using testing::ElementsAre;
using testing::Pair;

// Two pixel effects: one with a parameter, one with a choice of shaders.
void add_effects(Scene& scene) {
  scene.write("shaders/gain/apply.glsl", "uniform float gain;\nvec4 apply(vec4 color) { return color * gain; }\n");
  scene.write("shaders/tone/soft.glsl", "vec4 apply(vec4 color) { return color / (color + 1.0); }\n");
  scene.effect("gain", R"(
    doc = "Multiplies.", at = "post_process", order = 10,
    settings = { amount = fx.float { min = 0, max = 8, default = 1, doc = "Factor.", unit = "×" } },
    active = function(s) return s.amount ~= 1, "amount is 1" end,
    build = function(g, s, source) return g:pass { shader = "gain/apply", source = source, gain = s.amount } end,)");
  scene.effect("tone", R"(
    at = "after_post_process",
    settings = { curve = fx.enum { "soft", default = "soft" } },
    build = function(g, s, source) return g:pass { shader = "tone/" .. s.curve, source = source, name = "curve" } end,)");
}

TEST(Preset, TwoPixelEffectsBecomeAGraph) {
  Scene scene;
  add_effects(scene);
  scene.preset(R"(local fx = require "afterglow"
return fx.stack { name = "Two", max_error = 1e-4,
  fx.tone {},
  fx.gain { amount = 2.5 },
})");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  EXPECT_EQ(preset->name(), "Two");
  EXPECT_EQ(preset->max_error(), 1e-4);
  ASSERT_EQ(preset->entries().size(), 2u);
  EXPECT_EQ(preset->entries()[0].name, "gain");  // post_process comes before after_post_process
  EXPECT_EQ(preset->entries()[0].line, 4);
  EXPECT_THAT(preset->entries()[0].changed, ElementsAre("amount"));
  EXPECT_EQ(preset->entries()[1].name, "tone");
  EXPECT_THAT(preset->entries()[1].changed, ElementsAre());
  EXPECT_EQ(preset->schema("gain").doc, "Multiplies.");

  auto graph = scene.build(*preset);
  ASSERT_TRUE(graph) << graph.error().text();
  ASSERT_TRUE(validate(*graph));
  ASSERT_EQ(graph->passes.size(), 2u);
  const Pass& gain = graph->passes[0];
  EXPECT_EQ(gain.name, "gain.apply");
  EXPECT_EQ(gain.effect, "gain");
  EXPECT_EQ(gain.kind, PassKind::pixel);
  EXPECT_EQ(gain.shader, "gain/apply");
  EXPECT_THAT(gain.params, ElementsAre(Pair("gain", ParamValue{ParamType::float1, {2.5}})));
  ASSERT_EQ(gain.inputs.size(), 1u);
  EXPECT_EQ(gain.inputs[0], (PassInput{"source", graph->source, true}));
  EXPECT_EQ(scene.shorten(gain.file), "effects/gain.lua");
  EXPECT_EQ(gain.line, 7);
  const Pass& tone = graph->passes[1];
  EXPECT_EQ(tone.name, "tone.curve");
  EXPECT_EQ(tone.inputs[0].image, gain.output);
  EXPECT_EQ(graph->result, tone.output);
  EXPECT_EQ(graph->images[static_cast<std::size_t>(graph->result)].size, (Size{64, 32}));
}

TEST(Preset, AnInactiveEffectCostsNothing) {
  Scene scene;
  add_effects(scene);
  scene.stack("fx.gain {}, fx.tone { enabled = false }");
  const Graph graph = scene.graph();
  EXPECT_TRUE(graph.passes.empty());
  EXPECT_EQ(graph.result, graph.source);
  ASSERT_EQ(graph.skipped.size(), 2u);
  EXPECT_EQ(graph.skipped[0].name, "gain");
  EXPECT_EQ(graph.skipped[0].reason, "amount is 1");
  EXPECT_EQ(graph.skipped[1].name, "tone");
  EXPECT_EQ(graph.skipped[1].reason, "disabled");
}

}  // namespace
}  // namespace afterglow::test
