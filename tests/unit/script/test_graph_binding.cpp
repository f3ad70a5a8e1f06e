// SPDX-License-Identifier: MIT
// What g:pass, g:filter, g:input and g:skip make.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "graph/history.h"
#include "scene.h"

namespace afterglow::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

// One effect `probe` whose build has the given statements (its first line is line 4) and a few shaders.
struct Binding : testing::Test {
  Binding() {
    scene.write("shaders/plain.glsl", "vec4 apply(vec4 color) { return color; }\n");
    scene.write("shaders/lib_/mix.glsl", R"(
      uniform float amount;
      uniform vec3 tint;
      uniform int steps;
      uniform ivec2 cell;
      uniform bool invert;
      layout(constant_id = 0) const bool fast = true;
      layout(constant_id = 1) const int taps = 5;
      vec4 apply(vec4 color, vec4 high) { return color + high * amount; }
    )");
    scene.write("shaders/edges.glsl",
                "uniform sampler2D depth;\nuniform sampler2D source;\nvec4 sample_at(ivec2 pixel) { return "
                "fetch(depth, pixel) + fetch(source, pixel); }\n");
    scene.write("shaders/lone.glsl",
                "uniform sampler2D depth;\nvec4 sample_at(ivec2 pixel) { return fetch(depth, pixel); }\n");
  }
  Graph graph(const std::string& statements, const std::string& keys = "") {
    scene.effect("probe", keys + "build = function(g, s, source)\n" + statements + "\nend,");
    scene.stack("fx.probe {}");
    Graph graph = scene.graph();
    if (!graph.images.empty()) {
      EXPECT_TRUE(validate(graph)) << validate(graph).error().text();
    }
    return graph;
  }
  Scene scene;
};

TEST_F(Binding, PixelPassWithEverything) {
  const Graph graph = this->graph(R"(
    local high = g:pass { shader = "plain", source = source, name = "high" }
    return g:pass { shader = "lib_/mix", source = source, high = high, amount = 0.5, tint = { 1, 2, 3 }, steps = 4.0,
                    cell = { -1, 7 }, invert = true, taps = 9 })");
  ASSERT_EQ(graph.passes.size(), 2u);
  const Pass& pass = graph.passes[1];
  EXPECT_EQ(pass.name, "probe.mix");
  EXPECT_THAT(pass.inputs,
              ElementsAre(PassInput{"source", graph.source, true}, PassInput{"high", graph.passes[0].output, true}));
  EXPECT_THAT(pass.params, ElementsAre(Pair("amount", ParamValue{ParamType::float1, {0.5}}),
                                       Pair("cell", ParamValue{ParamType::int2, {-1, 7}}),
                                       Pair("invert", ParamValue{ParamType::bool1, {1}}),
                                       Pair("steps", ParamValue{ParamType::int1, {4}}),
                                       Pair("tint", ParamValue{ParamType::float3, {1, 2, 3}})));
  EXPECT_THAT(pass.constants, ElementsAre(Pair("fast", 1.0), Pair("taps", 9.0)));
}

TEST_F(Binding, SamplePassTakesItsSize) {
  const Graph graph = this->graph(R"(
    local half = g:pass { shader = "edges", source = source, depth = source, size = { source.width // 2, 8 }, name = "half" }
    local same = g:pass { shader = "edges", source = half, depth = source, name = "same" }
    local like = g:pass { shader = "lone", depth = same, size = source, name = "like" }
    return like)");
  ASSERT_EQ(graph.passes.size(), 3u);
  const auto size = [&](std::size_t pass) {
    return graph.images[static_cast<std::size_t>(graph.passes[pass].output)].size;
  };
  EXPECT_EQ(graph.passes[0].kind, PassKind::sample);
  EXPECT_EQ(size(0), (Size{32, 8}));
  EXPECT_EQ(size(1), (Size{32, 8}));
  EXPECT_EQ(size(2), (Size{64, 32}));
  // In the order in which the shader declares them, whatever the table's.
  EXPECT_THAT(graph.passes[1].inputs,
              ElementsAre(PassInput{"depth", graph.source, false}, PassInput{"source", graph.passes[0].output, false}));
}

TEST_F(Binding, ComputePassesAndWays) {
  const std::string group = "layout(local_size_x = 8) in;\n";
  scene.write("shaders/lone_group.glsl",
              group + "uniform sampler2D depth;\nvec4 compute_at(ivec2 pixel) { return fetch(depth, pixel); }\n");
  const Graph graph = this->graph(R"(
    local one = g:pass { shader = "lone", compute = "lone_group", depth = source, size = source, name = "one" }
    return g:pass { shader = "lone_group", depth = one, size = source, reach = 0 })");
  ASSERT_EQ(graph.passes.size(), 3u);
  EXPECT_EQ(graph.passes[0].kind, PassKind::sample);
  EXPECT_EQ(graph.passes[0].by_workgroups, "lone_group");
  EXPECT_THAT(shaders_of(graph.passes[0]), ElementsAre("lone", "lone_group"));
  EXPECT_EQ(graph.passes[1].kind, PassKind::compute);
  EXPECT_EQ(graph.passes[2].name, "probe.result");  // results are drawn
  Graph other = graph;
  other.passes[0].by_workgroups.clear();
  EXPECT_FALSE(same_structure(graph, other));
  EXPECT_THAT(to_json(graph), testing::HasSubstr("\"compute\": \"lone_group\""));
}

TEST_F(Binding, AComputePassThatIsKeptIsCopied) {
  scene.write("shaders/lone_group.glsl",
              "layout(local_size_x = 8) in;\nuniform sampler2D depth;\n"
              "vec4 compute_at(ivec2 pixel) { return fetch(depth, pixel); }\n");
  const Graph graph = this->graph(R"(
    local before = g:history { name = "before", size = source }
    local now = g:pass { shader = "lone_group", depth = before, size = source }
    g:keep(before, now)
    return g:pass { shader = "lone", depth = now, size = source })");
  ASSERT_EQ(graph.histories.size(), 1u);
  EXPECT_FALSE(is_computed(graph, graph.histories[0].next));
}

TEST_F(Binding, Filters) {
  const Graph graph = this->graph(R"(
    local half = { source.width // 2, source.height // 2 }
    local a = g:filter { source = source, size = half, filter = { x = { { -1, 0.25 }, { 0, 0.5 }, { 1, 0.25 } } }, name = "down[1]" }
    local b = g:filter { source = a, filter = { interpolation = "nearest", taps = { { 1, -2, 0.5 } } } }
    return g:filter { source = b, size = source, filter = { interpolation = "cubic_bspline" } })");
  ASSERT_EQ(graph.passes.size(), 3u);
  EXPECT_EQ(graph.passes[0].kind, PassKind::filter);
  EXPECT_EQ(graph.passes[0].name, "probe.down[1]");
  EXPECT_THAT(graph.passes[0].inputs, ElementsAre(PassInput{"source", graph.source, false}));
  EXPECT_EQ(graph.passes[0].filter, (Filter{Interpolation::linear, {{-1, 0.25}, {0, 0.5}, {1, 0.25}}, {{0, 1}}, {}}));
  EXPECT_EQ(graph.passes[1].name, "probe.filter");
  EXPECT_EQ(graph.passes[1].filter, (Filter{Interpolation::nearest, {{0, 1}}, {{0, 1}}, {{1, -2, 0.5}}}));
  EXPECT_EQ(graph.passes[2].name, "probe.filter#2");
  EXPECT_EQ(graph.passes[2].filter.interpolation, Interpolation::cubic_bspline);
  EXPECT_EQ(graph.images[static_cast<std::size_t>(graph.result)].size, (Size{64, 32}));
}

/// A filter's image has as many channels as its source.
TEST_F(Binding, Channels) {
  const Graph graph = this->graph(R"(
    local edges = g:pass { shader = "lone", depth = source, size = source, channels = 2, name = "edges" }
    local small = g:filter { source = edges, size = { 8, 8 }, filter = {}, name = "small" }
    local less = g:filter { source = edges, filter = {}, channels = 1, name = "less" }
    local all = g:filter { source = less, filter = {}, channels = 4, name = "all" }
    return g:pass { shader = "edges", depth = small, source = all })");
  const auto channels = [&](std::size_t pass) {
    return graph.images[static_cast<std::size_t>(graph.passes[pass].output)].channels;
  };
  ASSERT_EQ(graph.passes.size(), 5u);
  EXPECT_EQ(channels(0), 2);
  EXPECT_EQ(channels(1), 2);
  EXPECT_EQ(channels(2), 1);
  EXPECT_EQ(channels(3), 4);
  EXPECT_EQ(channels(4), 4);
  Graph other = graph;
  other.images[static_cast<std::size_t>(graph.passes[0].output)].channels = 1;
  EXPECT_FALSE(same_structure(graph, other));
  EXPECT_THAT(to_json(graph), testing::HasSubstr("\"channels\": 2"));
  other.images[static_cast<std::size_t>(graph.passes[0].output)].channels = 3;
  EXPECT_FALSE(validate(other));
  other = graph;
  other.images[static_cast<std::size_t>(graph.source)].channels = 1;
  EXPECT_FALSE(validate(other));  // pictures are what they are
}

/// An input has no pass that could make less of it.
TEST_F(Binding, AnInputIsKeptInAsManyChannelsAsAreWanted) {
  const Graph graph = this->graph(R"(
    local before = g:history { name = "before", size = source, channels = 1 }
    g:keep(before, source)
    return g:pass { shader = "edges", depth = before, source = source })");
  ASSERT_EQ(graph.histories.size(), 1u);
  EXPECT_EQ(graph.images[static_cast<std::size_t>(graph.histories[0].next)].channels, 1);
  EXPECT_TRUE(validate(graph));
}

TEST_F(Binding, Precise) {
  const Graph graph = this->graph(R"(
    local a = g:pass { shader = "lone", depth = source, size = source, precise = true }
    local b = g:filter { source = a, filter = {}, precise = true }
    local c = g:filter { source = b, filter = {} }
    return g:pass { shader = "edges", depth = c, source = source, precise = true })");
  const auto precise = [&](std::size_t pass) { return is_precise(graph, graph.passes[pass].output); };
  ASSERT_EQ(graph.passes.size(), 4u);
  EXPECT_TRUE(precise(0));
  EXPECT_TRUE(precise(1));
  EXPECT_FALSE(precise(2));
  EXPECT_FALSE(precise(3)) << "the result is what whoever runs it wants";
  Graph other = graph;
  other.images[static_cast<std::size_t>(graph.passes[0].output)].precise = false;
  EXPECT_FALSE(same_structure(graph, other));
  EXPECT_THAT(to_json(graph), testing::HasSubstr("\"precise\": true"));
}

TEST_F(Binding, FilterLibrary) {
  const Graph graph = this->graph(R"(
    local fx = require "afterglow"
    local image = source
    for _, filter in ipairs { fx.filters.bilinear(), fx.filters.bspline(), fx.filters.gaussian_halving(), fx.filters.gaussian_vertical(),
                              fx.filters.plus(1), fx.filters.box(0.5), fx.filters.tent() } do
      image = g:filter { source = image, filter = filter }
    end
    return image)");
  ASSERT_EQ(graph.passes.size(), 7u);
  const auto filter = [&](std::size_t i) { return graph.passes[i].filter; };
  EXPECT_EQ(filter(0), (Filter{Interpolation::linear, {{0, 1}}, {{0, 1}}, {}}));
  EXPECT_EQ(filter(1), (Filter{Interpolation::cubic_bspline, {{0, 1}}, {{0, 1}}, {}}));
  const double w[] = {0.01621622, 0.05405405, 0.12162162, 0.19459459, 0.22702703};
  Filter halving{Interpolation::linear, {}, {{0, 1}}, {}};
  for (int i = -4; i <= 4; ++i) halving.x.push_back({2.0 * i, w[4 - std::abs(i)]});
  EXPECT_EQ(filter(2), halving);
  const double binomial[] = {66, 220, 495, 792, 924};
  Filter vertical{Interpolation::linear, {{0, 1}}, {}, {}};
  for (int i = -4; i <= 4; ++i) vertical.y.push_back({double(i), binomial[4 - std::abs(i)] / 4070});
  EXPECT_EQ(filter(3), vertical);
  EXPECT_EQ(
      filter(4),
      (Filter{Interpolation::linear, {{0, 1}}, {{0, 1}}, {{1, 0, 0.25}, {0, 1, 0.25}, {-1, 0, 0.25}, {0, -1, 0.25}}}));
  EXPECT_EQ(filter(5), (Filter{Interpolation::linear, {{-0.5, 0.5}, {0.5, 0.5}}, {{-0.5, 0.5}, {0.5, 0.5}}, {}}));
  EXPECT_EQ(filter(6),
            (Filter{Interpolation::linear, {{-1, 0.25}, {0, 0.5}, {1, 0.25}}, {{-1, 0.25}, {0, 0.5}, {1, 0.25}}, {}}));
}

TEST_F(Binding, NamesAreUnique) {
  const Graph graph = this->graph(R"(
    local image = source
    for i = 1, 3 do image = g:pass { shader = "plain", source = image } end
    return g:pass { shader = "plain", source = image, name = "up[2]" })");
  ASSERT_EQ(graph.passes.size(), 4u);
  EXPECT_EQ(graph.passes[0].name, "probe.plain");
  EXPECT_EQ(graph.passes[1].name, "probe.plain#2");
  EXPECT_EQ(graph.passes[2].name, "probe.plain#3");
  EXPECT_EQ(graph.passes[3].name, "probe.up[2]");
}

TEST_F(Binding, InputsSkipsAndTheContext) {
  scene.context = {{64, 32}, {{"depth", {64, 32}}}, 12, 0.5, 25};
  const Graph graph = this->graph(R"(
    assert(g.frame == 12 and g.time == 0.5 and g.fps == 25)
    local depth = g:input("depth")
    assert(depth.width == 64 and depth == g:input("depth") and depth ~= source)
    assert(g:input("normal") == nil)
    assert(tostring(depth) == "image")
    g:skip("nothing to do")
    return source)",
                                  "needs = { \"depth\" }, optional = { \"normal\" },\n");
  EXPECT_TRUE(graph.passes.empty());
  EXPECT_EQ(graph.result, graph.source);
  EXPECT_THAT(graph.auxiliary, ElementsAre(Pair("depth", 1)));
  EXPECT_EQ(graph.images[1].name, "depth");
  ASSERT_EQ(graph.skipped.size(), 1u);
  EXPECT_EQ(graph.skipped[0].name, "probe");
  EXPECT_EQ(graph.skipped[0].reason, "nothing to do");
}

TEST_F(Binding, ReturningTheSourceIsReported) {
  const Graph graph = this->graph("return source");
  ASSERT_EQ(graph.skipped.size(), 1u);
  EXPECT_EQ(graph.skipped[0].reason, "returned its source");
}

/// Scripts write matrices row by row, GLSL keeps them column by column.
TEST_F(Binding, MatricesAndArrays) {
  scene.write(
      "shaders/turn.glsl",
      "uniform mat3 turn;\nuniform float weights[4];\nuniform vec2 places[3];\nuniform int order[2];\n"
      "vec4 apply(vec4 color) { return vec4(turn * color.rgb * weights[order[0]], color.a) + places[2].xyxy; }");
  const auto pass = [&](const std::string& turn, const std::string& weights, const std::string& places) {
    return graph("return g:pass { shader = 'turn', source = source, order = { 3, 1 }, turn = " + turn +
                 ", weights = " + weights + ", places = " + places + " }")
        .passes[0];
  };
  const std::string rows = "{ { 1, 2, 3 }, { 4, 5, 6 }, { 7, 8, 9 } }";
  const Pass whole = pass(rows, "{ 0.5, 1, 2, 4 }", "{ { 1, 2 }, { 3, 4 }, { 5, 6 } }");
  EXPECT_EQ(whole.params.at("turn"), (ParamValue{ParamType::matrix3, {1, 4, 7, 2, 5, 8, 3, 6, 9}}));
  EXPECT_EQ(whole.params.at("weights"), (ParamValue{ParamType::float1, {0.5, 1, 2, 4}, 4}));
  EXPECT_EQ(whole.params.at("places"), (ParamValue{ParamType::float2, {1, 2, 3, 4, 5, 6}, 3}));
  EXPECT_EQ(whole.params.at("order"), (ParamValue{ParamType::int1, {3, 1}, 2}));
  EXPECT_EQ(rows_of(whole.params.at("turn")).at(1), (std::vector<double>{4, 5, 6}));
  const Pass shorter = pass(rows, "{ 7 }", "{ { 1, 2 } }");
  EXPECT_EQ(shorter.params.at("weights"), (ParamValue{ParamType::float1, {7, 0, 0, 0}, 4})) << "the rest is 0";
  EXPECT_EQ(shorter.params.at("places"), (ParamValue{ParamType::float2, {1, 2, 0, 0, 0, 0}, 3}));
}

TEST_F(Binding, WhatIsNoMatrixOrArrayIsToldSo) {
  scene.write("shaders/turn.glsl",
              "uniform mat2 turn;\nuniform vec3 colors[2];\nuniform int order[2];\n"
              "vec4 apply(vec4 color) { return vec4(turn * color.rg, colors[order[1]].xy); }");
  const auto error = [&](const std::string& turn, const std::string& colors, const std::string& order) {
    scene.effect("probe", "build = function(g, s, source) return g:pass { shader = 'turn', source = source, turn = " +
                              turn + ", colors = " + colors + ", order = " + order + " } end,");
    scene.stack("fx.probe {}");
    return scene.build_error();
  };
  const std::string turn = "{ { 1, 0 }, { 0, 1 } }", colors = "{ { 1, 2, 3 } }", order = "{ 1, 0 }";
  EXPECT_THAT(error("1", colors, order), HasSubstr("turn = 1 is no matrix; allowed: 2 rows, each { 2 numbers }"));
  EXPECT_THAT(error("{ 1, 0, 0, 1 }", colors, order), HasSubstr("turn = {1, 0, 0, 1} is a matrix of another size"));
  EXPECT_THAT(error("{ { 1, 0 } }", colors, order), HasSubstr("is a matrix of another size"));
  EXPECT_THAT(error("{ { 1, 0 }, { 0 } }", colors, order),
              HasSubstr("turn = a table is no matrix: it has a table of 1 at 2, and a table of 2 before"));
  EXPECT_THAT(error(turn, "{ { 1, 2, 3 }, { 1, 2 } }", order),
              HasSubstr("colors = a table is no array: it has a table of 2 at 2, and a table of 3 before"));
  EXPECT_THAT(error(turn, colors, "{ [0] = 1, 1 }"), HasSubstr("order = {1} is no array: it has the key 0"));
  EXPECT_THAT(error(turn, colors, "{ 1, x = 2 }"), HasSubstr("it has the key \"x\"; keys are 1, 2"));
  EXPECT_THAT(error(turn, colors, "{ 1, 'two' }"), HasSubstr("it has \"two\" at 2"));
  EXPECT_THAT(error(turn, colors, "{ 1, nil, 2 }"), HasSubstr("order = "));
  EXPECT_THAT(error("{ { 1, 0 }, { 0, 0/0 } }", colors, order), HasSubstr("turn = a table is not finite"));
  EXPECT_THAT(error(turn, "{}", order), HasSubstr("is no array; allowed: a table of 1 to 2, each { 3 numbers }"));
  EXPECT_THAT(error(turn, "{ 1, 2 }", order), HasSubstr("colors = {1, 2} is an array of other elements"));
  EXPECT_THAT(error(turn, "{ { 1, 2, 3 }, { 1, 2, 3 }, { 1, 2, 3 } }", order),
              HasSubstr("colors = a table is too long"));
  EXPECT_THAT(error(turn, colors, "{ 0.5 }"), HasSubstr("is not an integer"));
  EXPECT_THAT(error(turn, colors, "source"), HasSubstr("order = an image is no array"));
}

TEST_F(Binding, SettingsReachThePass) {
  scene.effect("probe", R"(
    settings = { tint = fx.color { default = "#ffffff" }, cell = fx.vec2 { default = { 3, 4 } }, steps = fx.int { default = 2 },
                 invert = fx.bool { default = true }, amount = fx.float { default = 0.25 } },
    build = function(g, s, source)
      assert(#s.tint == 3 and s.tint[2] == 2 and s.cell[2] == 4 and math.type(s.steps) == "integer")
      local names = {}
      for name in pairs(s) do names[#names + 1] = name end
      assert(table.concat(names, " ") == "amount cell invert steps tint")
      return g:pass { shader = "lib_/mix", source = source, high = source, tint = s.tint, cell = s.cell, steps = s.steps, invert = s.invert,
                      amount = s.amount, fast = not s.invert }
    end,)");
  scene.stack("fx.probe { tint = { 0.5, 2, 0 } }");
  const Graph graph = scene.graph();
  ASSERT_EQ(graph.passes.size(), 1u);
  EXPECT_EQ(graph.passes[0].params.at("tint"), (ParamValue{ParamType::float3, {0.5, 2, 0}}));
  EXPECT_EQ(graph.passes[0].params.at("cell"), (ParamValue{ParamType::int2, {3, 4}}));
  EXPECT_EQ(graph.passes[0].constants.at("fast"), 0);
}

}  // namespace
}  // namespace afterglow::test
