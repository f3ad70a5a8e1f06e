// SPDX-License-Identifier: MIT
// Kernels as compute shaders: the same bits as those that are drawn, with everything that kernels are done with.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "workshop.h"

namespace afterglow {
namespace {

/// A filter down, a box and a filter up, with stages behind them, and the result: kernels of every kind.
class Dispatched : public Workshop {
 protected:
  Graph look(Size size) {
    shader("near",
           "uniform sampler2D source;\nvec4 sample_at(ivec2 p) {\n"
           "  return 0.5 * fetch(source, p) + 0.25 * (fetch(source, p + ivec2(1, 0)) + fetch(source, p - ivec2(0, "
           "1)));\n}\n");
    shader("mix2",
           "vec4 apply(vec4 color, vec4 light) { return vec4(color.rgb * 0.75 + light.rgb * 0.5, color.a); }\n");
    shader("where", "vec4 apply(vec4 color, ivec2 at) { return color * (1.0 + 0.001 * float(at.x + 3 * at.y)); }\n");
    GraphBuilder b(size);
    const Size half{(size.width + 1) / 2, (size.height + 1) / 2};
    const ImageId small = b.filter("small", b.source(), half, Filter{});
    const ImageId blurred = b.pixel("moved", "where", b.sample("near", "near", half, {{"source", small}}));
    const ImageId large = b.filter("large", blurred, size, Filter{.interpolation = Interpolation::cubic_bspline});
    return b.finish(b.pixel("place", "where", b.pixel("both", "mix2", b.source(), {{"light", large}})));
  }
  /// Compilers of GPUs may put multiplications and additions together otherwise where rows stand side by side.
  static bool same(const std::vector<float>& a, const std::vector<float>& b) {
    const float apart = device().is_cpu() ? 0 : 2e-6f;
    return std::ranges::equal(a, b, [&](float x, float y) { return std::abs(x - y) <= apart * std::abs(y); });
  }
  static ProgramOptions stored(ExecutionConfig config) {
    config.dispatched = true;
    return {
        .config = config, .inputs_are_storage = true, .worth = {0, 0}, .result_by_rows = true, .result_stored = true};
  }
};

TEST_F(Dispatched, PixelsAreTheSameBits) {
  for (const Size size : {Size{1, 1}, Size{17, 9}, Size{101, 57}})
    for (const Storage storage : {Storage::fp32, Storage::fp16})
      for (const Fusion fusion : {Fusion::none, Fusion::all})
        for (const bool storage_reads : {false, true})
          for (const int rows : {1, 2, kMaxRows})
            for (const bool direct : {false, true}) {
              const Graph graph = look(size);
              const auto pixels = noise(size, 31);
              const std::map<std::string, HostImage> inputs{{"source", {pixels.data(), size, 4}}};
              const ExecutionConfig config{
                  .fusion = fusion, .storage = storage, .storage_reads = storage_reads, .rows = rows};
              const auto made = program(graph, stored(config));
              ASSERT_TRUE(made);
              for (const auto& kernel : made->plan().kernels) EXPECT_TRUE(kernel.dispatched) << kernel.name;
              EXPECT_TRUE(made->stores_result());
              const auto drawn =
                  run(graph, inputs, {.config = {.fusion = fusion, .storage = storage}, .worth = {0, 0}}, direct);
              EXPECT_TRUE(same(run(graph, inputs, stored(config), direct).pixels, drawn.pixels))
                  << execution_name(made->config()) << ' ' << size.width << 'x' << size.height;
            }
}

TEST_F(Dispatched, CodesFlagsAndRegionsToo) {
  const Size size{101, 57};
  const Graph graph = look(size);
  auto pixels = noise(size, 32);
  for (float& value : pixels) value *= 0.01f;
  pixels[4 * 999] = std::numeric_limits<float>::infinity();
  const std::map<std::string, HostImage> inputs{{"source", {pixels.data(), size, 4}}};
  for (const int rows : {1, 4})
    for (const bool unorm8 : {false, true}) {
      ProgramOptions drawn{.worth = {0, 0}, .unorm8 = unorm8, .flag_non_finite = true},
          options = stored({.rows = rows});
      options.unorm8 = unorm8;
      options.flag_non_finite = true;
      const auto a = run(graph, inputs, drawn), b = run(graph, inputs, options);
      EXPECT_TRUE(a.flagged == b.flagged && a.unorm8 == b.unorm8) << rows << unorm8;
      ASSERT_EQ(a.pixels.size(), b.pixels.size());
      if (!unorm8) {
        EXPECT_EQ(std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)), 0);
      }
      for (const Rect part : {Rect{0, 0, 1, 1}, Rect{37, 21, 30, 9}, Rect{96, 50, 5, 7}}) {
        options.region = part;
        const auto c = run(graph, inputs, options);
        const std::size_t bytes = 4 * static_cast<std::size_t>(part.width) * (unorm8 ? 1 : sizeof(float));
        for (int y = part.y; y < part.y + part.height; ++y) {
          const std::size_t at = (static_cast<std::size_t>(y) * size.width + part.x) * 4;
          ASSERT_EQ(unorm8 ? std::memcmp(&a.unorm8[at], &c.unorm8[at], bytes)
                           : std::memcmp(&a.pixels[at], &c.pixels[at], bytes),
                    0)
              << y;
        }
        options.region.reset();
      }
    }
}

/// Beyond an array, a vector or a matrix lies its last element, before it the first.
TEST_F(Dispatched, IndicesAreHeldWithinTheirArrays) {
  shader("beyond",
         "const float kTable[4] = float[4](1.0, 2.0, 3.0, 4.0);\nuniform sampler2D source;\n"
         "vec4 sample_at(ivec2 p) {\n  float own[3];\n  for (int i = 0; i < 3; ++i) own[i] = float(10 * i);\n"
         "  vec4 v = vec4(5.0, 6.0, 7.0, 8.0);\n  int at = p.x - 2;\n"
         "  return vec4(kTable[at], own[at], v[at], 1.0) + 0.0 * fetch(source, p);\n}\n");
  const Size size{9, 2};
  GraphBuilder b(size);
  const Graph graph = b.finish(b.sample("beyond", "beyond", size, {{"source", b.source()}}));
  const auto pixels = noise(size, 34);
  const std::map<std::string, HostImage> inputs{{"source", {pixels.data(), size, 4}}};
  for (const bool dispatched : {false, true}) {
    const auto out = run(graph, inputs, dispatched ? stored({.rows = 4}) : ProgramOptions{.worth = {0, 0}});
    ASSERT_FALSE(out.pixels.empty());
    for (int x = 0; x < size.width; ++x) {
      const auto held = [&](int last) { return static_cast<float>(std::clamp(x - 2, 0, last)); };
      const float* pixel = &out.pixels[static_cast<std::size_t>(x) * 4];
      EXPECT_EQ(pixel[0], 1 + held(3)) << x << dispatched;
      EXPECT_EQ(pixel[1], 10 * held(2)) << x << dispatched;
      EXPECT_EQ(pixel[2], 5 + held(3)) << x << dispatched;
    }
  }
}

/// texture() interpolates, whatever the engine's own sampler does.
TEST_F(Dispatched, TextureIsLinearInEveryWay) {
  shader(
      "half",
      "uniform sampler2D source;\nvec4 sample_at(ivec2 p) {\n  vec2 size = vec2(textureSize(source, 0));\n"
      "  vec4 at = texture(source, (vec2(p) + 0.5) / size), between = textureLod(source, (vec2(p) + vec2(1.0, 0.5)) / "
      "size, 0.0);\n"
      "  return vec4(at.r, between.r, textureOffset(source, (vec2(p) + 0.5) / size, ivec2(-1, 0)).r, 1.0);\n}\n");
  const Size size{37, 3};
  GraphBuilder b(size);
  const Graph graph = b.finish(b.sample("half", "half", size, {{"source", b.source()}}));
  std::vector<float> ramp(static_cast<std::size_t>(size.area()) * 4, 1.0f);
  const auto value = [&](int x) { return static_cast<float>(std::clamp(x, 0, size.width - 1) % 7); };
  for (std::size_t i = 0; i < ramp.size(); i += 4) ramp[i] = value(static_cast<int>(i) / 4 % size.width);
  const std::map<std::string, HostImage> inputs{{"source", {ramp.data(), size, 4}}};
  for (const ExecutionConfig& config :
       {ExecutionConfig{}, ExecutionConfig{.hardware_filter = true}, ExecutionConfig{.storage_reads = true, .rows = 4},
        ExecutionConfig{.hardware_filter = true, .dispatched = true}}) {
    ProgramOptions options = config.dispatched ? stored(config) : ProgramOptions{.config = config, .worth = {0, 0}};
    const auto out = run(graph, inputs, options);
    ASSERT_FALSE(out.pixels.empty());
    for (int x = 0; x < size.width; ++x) {
      const float* pixel = &out.pixels[static_cast<std::size_t>(x) * 4];
      EXPECT_EQ(pixel[0], value(x)) << "a texel's centre";
      EXPECT_NEAR(pixel[1], (value(x) + value(x + 1)) / 2, 1e-5f);
      EXPECT_NEAR(pixel[2], value(x - 1), 1e-5f);
    }
  }
}

/// Who gives an image that cannot be stored to gets it drawn; what draws and what stores may stand side by side.
TEST_F(Dispatched, AResultThatCannotBeStoredIsDrawn) {
  const Size size{64, 64};
  const auto pixels = noise(size, 33);
  const Graph graph = look(size);
  ProgramOptions options = stored({});
  options.result_stored = false;
  const auto made = program(graph, options);
  ASSERT_TRUE(made);
  EXPECT_FALSE(made->stores_result());
  EXPECT_FALSE(made->plan().kernels.back().dispatched);
  EXPECT_TRUE(made->plan().kernels.front().dispatched);
  const std::map<std::string, HostImage> inputs{{"source", {pixels.data(), size, 4}}};
  EXPECT_EQ(run(graph, inputs, options).pixels, run(graph, inputs, {.worth = {0, 0}}).pixels);
  EXPECT_FALSE(program(graph, {.config = {.dispatched = true}, .reference = true, .result_stored = true})
                   ->plan()
                   .kernels.front()
                   .dispatched);
}

/// One runner for programs that store and such that draw, in turns.
TEST_F(Dispatched, ProgramsMayTakeTurns) {
  const Size size{64, 64};
  const auto pixels = noise(size, 34);
  const Graph graph = look(size);
  const std::map<std::string, HostImage> inputs{{"source", {pixels.data(), size, 4}}};
  const auto stores = program(graph, stored({})), draws = program(graph, {.inputs_are_storage = true, .worth = {0, 0}});
  auto runner = FrameRunner::create(device(), 6ull << 30, true);
  ASSERT_TRUE(stores && draws && runner);
  std::vector<float> first;
  for (int frame = 0; frame < 6; ++frame) {
    HostResult out;
    const auto times = (*runner)->run(frame % 3 ? *stores : *draws, inputs, out, KernelTiming::none);
    ASSERT_TRUE(times) << times.error().text();
    if (first.empty()) first = out.pixels;
    EXPECT_EQ(out.pixels, first) << frame;
  }
}

}  // namespace
}  // namespace afterglow
