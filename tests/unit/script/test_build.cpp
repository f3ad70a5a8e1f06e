// SPDX-License-Identifier: MIT
// Preset::build: skipping, auxiliary inputs, determinism, and what many runs cost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene.h"

namespace afterglow::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

void add_fog(Scene& scene, const std::string& needs) {
  scene.write("shaders/fog.glsl",
              "uniform sampler2D depth;\nuniform sampler2D source;\nvec4 sample_at(ivec2 pixel) { return fetch(source, "
              "pixel) * fetch(depth, pixel); }\n");
  scene.effect("fog", needs + R"(
    settings = { deep = fx.bool { default = true } },
    build = function(g, s, source)
      local depth = g:input("depth")
      if not depth then g:skip("no depth, no fog") return source end
      return g:pass { shader = "fog", source = source, depth = depth }
    end,)");
}

TEST(Build, AMissingInputSkipsWithOneWarning) {
  Scene scene;
  add_fog(scene, "needs = { \"depth\" },");
  scene.stack("fx.fog {}");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  EXPECT_THAT(preset->needs(), ElementsAre("depth"));
  for (int i = 0; i < 3; ++i) {
    auto graph = scene.build(*preset);
    ASSERT_TRUE(graph);
    EXPECT_EQ(graph->result, graph->source);
    ASSERT_EQ(graph->skipped.size(), 1u);
    EXPECT_EQ(graph->skipped[0].reason, "no depth input");
  }
  EXPECT_THAT(scene.warnings, ElementsAre("effect 'fog' is skipped: no depth input"));
  scene.context.auxiliary["depth"] = {64, 32};
  auto graph = scene.build(*preset);
  ASSERT_TRUE(graph);
  EXPECT_EQ(graph->passes.size(), 1u);
}

TEST(Build, SeveralMissingInputs) {
  Scene scene;
  add_fog(scene, "needs = { \"depth\", \"normal\" },");
  scene.stack("fx.fog {}");
  EXPECT_EQ(scene.graph().skipped[0].reason, "no depth and normal input");
}

TEST(Build, RequiredMakesItAnError) {
  Scene scene;
  add_fog(scene, "needs = { \"depth\" },");
  scene.stack("\nfx.fog { required = true }");
  EXPECT_EQ(scene.build_error(), "preset.lua:4: error: effect 'fog' is required, but there is no depth input");
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(Build, OptionalInputsAreAskedForButNotNeeded) {
  Scene scene;
  add_fog(scene, "optional = { \"depth\" },");
  scene.stack("fx.fog { required = true }");
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  EXPECT_THAT(preset->needs(), ElementsAre("depth"));
  auto graph = scene.build(*preset);
  ASSERT_TRUE(graph) << graph.error().text();
  EXPECT_EQ(graph->skipped[0].reason, "no depth, no fog");
}

TEST(Build, NeedsMayFollowTheSettings) {
  Scene scene;
  add_fog(scene, "needs = function(s) return s.deep and { \"depth\" } or { \"normal\" } end,");
  scene.stack("fx.fog {}, fx.fog { deep = false }, fx.fog { enabled = false }");
  EXPECT_THAT(scene.load()->needs(), ElementsAre("depth", "normal"));
}

TEST(Build, DisabledAndInactiveEffectsNeedNothing) {
  Scene scene;
  add_fog(scene, "needs = { \"depth\" }, active = function(s) return s.deep, \"not deep\" end,");
  scene.stack("fx.fog { enabled = false, required = true }, fx.fog { deep = false, required = true }");
  EXPECT_THAT(scene.load()->needs(), IsEmpty());
  const Graph graph = scene.graph();
  ASSERT_EQ(graph.skipped.size(), 2u);
  EXPECT_EQ(graph.skipped[0].name, "fog");
  EXPECT_EQ(graph.skipped[0].reason, "disabled");
  EXPECT_EQ(graph.skipped[1].name, "fog#2");
  EXPECT_EQ(graph.skipped[1].reason, "not deep");
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(Build, AnInactiveEffectWithoutAReason) {
  Scene scene;
  scene.effect("off", "active = function(s) return false end, build = function(g, s, source) return source end,");
  scene.stack("fx.off {}");
  EXPECT_EQ(scene.graph().skipped[0].reason, "its settings leave the picture as it is");
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(Build, AnInactiveEffectMayWantToBeHeardOf) {
  Scene scene;
  scene.effect("off",
               "active = function(s) return false, \"no file\", true end, build = function(g, s, source) return source "
               "end,");
  scene.stack("fx.off {}");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(scene.build(*preset));
  EXPECT_THAT(scene.warnings, ElementsAre("effect 'off' is skipped: no file"));
}

// A pyramid much like that of a bloom: 20 passes.
void add_pyramid(Scene& scene) {
  scene.write("shaders/add.glsl",
              "uniform float amount;\nvec4 apply(vec4 color, vec4 high) { return color * amount + high; }\n");
  scene.effect("pyramid", R"(
    settings = { amount = fx.float { default = 1 } },
    build = function(g, s, source)
      local image, levels = source, {}
      for i = 1, 7 do
        image = g:filter { source = image, size = { math.max(image.width // 2, 1), math.max(image.height // 2, 1) },
                           filter = fx.filters.gaussian_halving(), name = ("down[%d]"):format(i) }
        levels[i] = image
      end
      for i = 6, 1, -1 do
        local up = g:filter { source = image, size = levels[i], filter = fx.filters.bspline(), name = ("up[%d]"):format(i) }
        image = g:pass { shader = "add", source = up, high = levels[i], amount = s.amount, name = ("combine[%d]"):format(i) }
      end
      return g:filter { source = image, size = source, filter = fx.filters.bilinear(), name = "final" }
    end,)");
  scene.stack("fx.pyramid {}");
}

TEST(Build, TheMeanOverAnAreaReadsEachTexelOfAWholeNumberOnce) {
  const auto taps = [](const std::string& ratios) {
    Scene scene;
    scene.effect("small",
                 "settings = {}, build = function(g, s, source)\n"
                 "local small = g:filter { source = source, size = { 8, 8 }, filter = fx.filters.area(" +
                     ratios +
                     ") }\nreturn g:filter { source = small, size = source, filter = "
                     "fx.filters.bilinear() } end,");
    scene.stack("fx.small {}");
    return scene.graph().passes.front().filter;
  };
  const auto expect = [](const std::vector<Tap>& taps, const std::vector<double>& offsets) {
    ASSERT_EQ(taps.size(), offsets.size());
    for (std::size_t i = 0; i < taps.size(); ++i) {
      EXPECT_DOUBLE_EQ(taps[i].offset, offsets[i]);
      EXPECT_DOUBLE_EQ(taps[i].weight, 1.0 / static_cast<double>(offsets.size()));
    }
  };
  const Filter whole = taps("3, 4");
  expect(whole.x, {-1, 0, 1});
  expect(whole.y, {-1.5, -0.5, 0.5, 1.5});
  const Filter between = taps("1.5, 1");
  expect(between.x, {-0.5, 0, 0.5});
  expect(between.y, {0});
}

TEST(Build, IsTheSameEveryTime) {
  Scene scene;
  add_pyramid(scene);
  const std::string first = to_json(scene.graph());
  for (int i = 0; i < 5; ++i) EXPECT_EQ(to_json(scene.graph()), first);  // a new state each time
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  for (int i = 0; i < 5; ++i) {
    auto graph = scene.build(*preset);
    ASSERT_TRUE(graph);
    EXPECT_EQ(to_json(*graph), first);
  }
  EXPECT_EQ(scene.graph().passes.size(), 20u);
}

TEST(Build, AThousandRunsDoNotGrowTheState) {
  Scene scene;
  add_pyramid(scene);
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  ASSERT_TRUE(scene.build(*preset));
  const std::size_t before = preset->memory_used();
  for (int i = 0; i < 1000; ++i) {
    scene.context.frame = i;
    ASSERT_TRUE(scene.build(*preset));
  }
  EXPECT_LE(preset->memory_used(), before + 1024);
}

TEST(Build, APresetMovesWithItsState) {
  Scene scene;
  add_pyramid(scene);
  auto loaded = scene.load();
  ASSERT_TRUE(loaded);
  Preset a = std::move(*loaded);
  ASSERT_TRUE(scene.build(a));
  Preset b = std::move(a);
  EXPECT_EQ(scene.build(b)->passes.size(), 20u);
}

// Every preset that comes with the program makes a valid graph, at ordinary and at odd sizes.
class ShippedPreset : public testing::TestWithParam<std::filesystem::path> {};

std::vector<std::filesystem::path> shipped() {
  std::vector<std::filesystem::path> files;
  for (const auto& file : std::filesystem::recursive_directory_iterator(AFTERGLOW_PROJECT_FOLDER "/presets")) {
    const auto& path = file.path();
    const auto folder = path.parent_path().filename();
    if (path.extension() == ".lua" && folder != "effects") files.push_back(path);
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST_P(ShippedPreset, Builds) {
  Scene scene;
  ShaderLibrary shaders(search_path_for(GetParam(), {}));
  auto preset = Preset::load(GetParam(), {}, shaders, scene.diagnostics);
  ASSERT_TRUE(preset) << preset.error().text();
  for (const Size size : {Size{1920, 1080}, Size{1, 1}, Size{3, 5}, Size{16384, 1}, Size{127, 16384}}) {
    const BuildContext context{size, {{"depth", size}, {"normal", size}}, 1, 0, 24};
    const auto made = preset->evaluate(context, scene.diagnostics);
    ASSERT_TRUE(made) << made.error().text();
    EXPECT_TRUE(validate(made->graph)) << validate(made->graph).error().text();
    const auto bare = preset->evaluate({size, {}, 1, 0, 24}, scene.diagnostics);
    EXPECT_TRUE(bare) << bare.error().text();
  }
}

INSTANTIATE_TEST_SUITE_P(Build, ShippedPreset, testing::ValuesIn(shipped()),
                         [](const auto& test) { return test.param.stem().string(); });

TEST(Build, WhatMayLookBackIsKnownByItsText) {
  Scene scene;
  add_fog(scene, "needs = { \"depth\" },");
  scene.effect("echo", R"(build = function(g, s, source)
      local before = g:history { first = source }
      g:keep(before, source)
      return before
    end,)");
  scene.stack("fx.fog {}");
  EXPECT_FALSE(scene.load()->may_look_back());
  scene.stack("fx.fog {}, fx.echo { enabled = false }");
  EXPECT_TRUE(scene.load()->may_look_back());
}

}  // namespace
}  // namespace afterglow::test
