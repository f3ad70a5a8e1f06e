// SPDX-License-Identifier: MIT
// Compute passes: workgroups that share variables, against sums and histograms in double precision; as one of two ways
// of a pass; with everything that kernels are done with (stages, regions, half floats, reuse).
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/hash.h"
#include "exec/barriers.h"
#include "gpu/pipeline.h"
#include "workshop.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

constexpr int kBlock = 16;  ///< pixels each way that one workgroup reads

/// One pixel for each block of the source, made by 8 × 4 invocations.
constexpr const char* kReduce = R"(#include "lib/workgroup.glsl"
layout(local_size_x = 8, local_size_y = 4, pixels_x = 1, pixels_y = 1) in;
layout(constant_id = 0) const int what = 0;
uniform sampler2D source;
vec4 compute_at(ivec2 pixel) {
  ivec2 size = image_size(source), first = pixel * 16, last = min(first + 16, size);
  vec4 value = what == 0 ? vec4(0.0) : fetch(source, first);
  for (int y = first.y + int(gl_LocalInvocationID.y); y < last.y; y += 4)
    for (int x = first.x + int(gl_LocalInvocationID.x); x < last.x; x += 8) {
      vec4 texel = fetch(source, ivec2(x, y));
      value = what == 0 ? value + texel : what == 1 ? max(value, texel) : min(value, texel);
    }
  return what == 0 ? workgroup_sum(value) : what == 1 ? workgroup_max(value) : workgroup_min(value);
}
)";

/// The same sum, pixel by pixel.
constexpr const char* kReduceOneByOne = R"(layout(constant_id = 0) const int what = 0;
uniform sampler2D source;
vec4 sample_at(ivec2 pixel) {
  ivec2 size = image_size(source), first = pixel * 16, last = min(first + 16, size);
  vec4 value = vec4(0.0);
  for (int y = first.y; y < last.y; ++y)
    for (int x = first.x; x < last.x; ++x) {
      vec4 texel = fetch(source, ivec2(x, y));
      value = what == 0 ? value + texel : what == 1 ? max(value, texel) : min(value, texel);
    }
  return value;
}
)";

/// A box of three columns, each texel read once into shared memory, with one more on each side.
constexpr const char* kBox = R"(layout(local_size_x = 8, local_size_y = 2) in;
uniform sampler2D source;
uniform float gain;
shared vec4 texels[20];
vec4 compute_at(ivec2 pixel) {
  int row = int(gl_LocalInvocationID.y) * 10, x = int(gl_LocalInvocationID.x);
  texels[row + x + 1] = fetch(source, pixel);
  if (x == 0) texels[row] = fetch(source, pixel - ivec2(1, 0));
  if (x == 7) texels[row + 9] = fetch(source, pixel + ivec2(1, 0));
  barrier();
  return gain * (texels[row + x] + texels[row + x + 1] + texels[row + x + 2]);
}
)";

class Compute : public Workshop {
 protected:
  void SetUp() override {
    Workshop::SetUp();
    shader("reduce", kReduce);
    shader("one_by_one", kReduceOneByOne);
    shader("box", kBox);
    shader("spread", "uniform sampler2D sums;\nvec4 sample_at(ivec2 p) { return fetch(sums, p / 16); }\n");
    shader("half_more", "vec4 apply(vec4 color) { return color * 1.5; }\n");
    shader("add", "vec4 apply(vec4 color, vec4 other) { return color + other; }\n");
  }

  /// The reduction of each block, spread over the block again.
  Graph blocks(Size size, int what, const std::string& shader = "reduce", PassKind kind = PassKind::compute,
               const std::string& by_workgroups = "") {
    GraphBuilder b(size);
    const Size sums{(size.width + kBlock - 1) / kBlock, (size.height + kBlock - 1) / kBlock};
    const ImageId reduced = b.sample("sums", shader, sums, {{"source", b.source()}});
    Graph graph = b.finish(b.sample("spread", "spread", size, {{"sums", reduced}}));
    graph.passes[0].kind = kind;
    graph.passes[0].by_workgroups = by_workgroups;
    graph.passes[0].constants = {{"what", what}};
    return graph;
  }

  static Picture64 expected_blocks(const Picture64& source, int what) {
    Picture64 out(source.size);
    for (int y = 0; y < source.size.height; ++y)
      for (int x = 0; x < source.size.width; ++x)
        for (int c = 0; c < 4; ++c) {
          const int x0 = x / kBlock * kBlock, y0 = y / kBlock * kBlock;
          double value = what == 0 ? 0 : source.get(x0, y0, c);
          for (int v = y0; v < std::min(y0 + kBlock, source.size.height); ++v)
            for (int u = x0; u < std::min(x0 + kBlock, source.size.width); ++u) {
              const double texel = source.get(u, v, c);
              value = what == 0 ? value + texel : what == 1 ? std::max(value, texel) : std::min(value, texel);
            }
          out.at(x, y, c) = value;
        }
    return out;
  }

  /// A box by workgroups, and a pixel pass behind it that shares its kernel.
  Graph box(Size size, double gain = 0.25) {
    GraphBuilder b(size);
    const ImageId boxed = b.sample("box", "box", size, {{"source", b.source()}}, {{"gain", number(gain)}});
    const ImageId more = b.pixel("more", "half_more", boxed);
    Graph graph = b.finish(b.filter("copy", more, size, {.interpolation = Interpolation::nearest}));
    graph.passes[0].kind = PassKind::compute;
    return graph;
  }

  static Picture64 expected_box(const Picture64& source, double gain = 0.25) {
    Picture64 out(source.size);
    for (int y = 0; y < source.size.height; ++y)
      for (int x = 0; x < source.size.width; ++x)
        for (int c = 0; c < 4; ++c)
          out.at(x, y, c) = 1.5 * gain * (source.get(x - 1, y, c) + source.get(x, y, c) + source.get(x + 1, y, c));
    return out;
  }
};

TEST_F(Compute, WorkgroupsFindSumsAndExtremes) {
  for (const Size size : kSizes) {
    const auto pixels = noise(size, 5);
    for (const int what : {0, 1, 2})
      for (const bool rows : {false, true}) {
        ProgramOptions options;
        if (rows) options.config = {.storage_reads = true, .rows = 8};
        options.worth = {0, 0};
        const auto out = run(blocks(size, what), {{"source", {pixels.data(), size, 4}}}, options);
        expect_near(out.pixels, expected_blocks(Picture64::of(size, pixels), what), what == 0 ? 1e-6 : 1e-12,
                    "reduction " + std::to_string(what));
      }
  }
}

TEST_F(Compute, TheSamePictureGivesTheSameBits) {
  const Size size{101, 57};
  const auto pixels = noise(size, 9);
  const auto first = run(blocks(size, 0), {{"source", {pixels.data(), size, 4}}});
  for (int again = 0; again < 8; ++again) {
    const auto out = run(blocks(size, 0), {{"source", {pixels.data(), size, 4}}});
    EXPECT_EQ(std::memcmp(out.pixels.data(), first.pixels.data(), out.pixels.size() * sizeof(float)), 0);
  }
}

TEST_F(Compute, SharedMemoryStandsInForReadsAndStagesFollow) {
  for (const Size size : kSizes) {
    const auto pixels = noise(size, 6);
    const Picture64 expected = expected_box(Picture64::of(size, pixels));
    for (const Storage storage : {Storage::fp32, Storage::fp16}) {
      const ProgramOptions options{.config = {.storage = storage}};
      const auto made = program(box(size), options);
      ASSERT_TRUE(made);
      ASSERT_EQ(made->plan().kernels.size(), 2u);
      EXPECT_TRUE(made->plan().kernels[0].workgroups);
      EXPECT_EQ(made->plan().kernels[0].name, "box+more");
      expect_near(run(box(size), {{"source", {pixels.data(), size, 4}}}, options).pixels, expected,
                  storage == Storage::fp32 ? 1e-6 : 2e-3, "box");
    }
    expect_near(run(box(size), {{"source", {pixels.data(), size, 4}}}, {.reference = true}).pixels, expected, 1e-6,
                "every pass on its own");
  }
}

TEST_F(Compute, ADeviceChoosesOneOfTwoWays) {
  const Size size{101, 57};
  const auto pixels = noise(size, 7);
  for (const int what : {0, 1}) {
    const Graph graph = blocks(size, what, "one_by_one", PassKind::sample, "reduce");
    const auto drawn = program(graph), computed = program(graph, {.config = {.compute = true}});
    ASSERT_TRUE(drawn && computed);
    EXPECT_FALSE(drawn->plan().kernels[0].workgroups);
    EXPECT_TRUE(computed->plan().kernels[0].workgroups);
    EXPECT_FALSE(program(graph, {.config = {.compute = true}, .reference = true})->plan().kernels[0].workgroups);
    const Picture64 expected = expected_blocks(Picture64::of(size, pixels), what);
    for (const bool compute : {false, true})
      expect_near(run(graph, {{"source", {pixels.data(), size, 4}}}, {.config = {.compute = compute}}).pixels, expected,
                  what == 0 ? 2e-6 : 1e-12, "either way");
  }
}

TEST_F(Compute, WhatIsTheCallersIsDrawn) {
  const Size size{32, 32};
  Graph graph = blocks(size, 1, "one_by_one", PassKind::sample, "reduce");
  graph.passes.pop_back();
  graph.images.pop_back();
  graph.images.back().size = graph.images[0].size;
  graph.result = graph.passes[0].output;
  EXPECT_FALSE(make_plan(graph, {.compute = true}).kernels[0].workgroups);
  graph.passes[0].kind = PassKind::compute;
  const auto made = try_program(graph);
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().text(), HasSubstr("a compute pass cannot make the result"));
}

TEST_F(Compute, SharedVariablesBeginAsZerosWhateverMemoryHeld) {
  shader("dirty", R"(layout(local_size_x = 32, pixels_x = 1) in;
uniform sampler2D source;
shared vec4 left[32];
shared uint once;
vec4 compute_at(ivec2 pixel) {
  vec4 found = left[gl_LocalInvocationIndex] + vec4(once);
  barrier();
  left[gl_LocalInvocationIndex] = fetch(source, pixel);
  once = 7u;
  barrier();
  return found + fetch(source, pixel);
}
)");
  const Size size{40, 9};
  const auto pixels = noise(size, 8);
  GraphBuilder b(size);
  const ImageId dirty = b.sample("dirty", "dirty", size, {{"source", b.source()}});
  Graph graph = b.finish(b.filter("copy", dirty, size, {.interpolation = Interpolation::nearest}));
  graph.passes[0].kind = PassKind::compute;
  EXPECT_EQ(run(graph, {{"source", {pixels.data(), size, 4}}}).pixels, pixels);
}

/// Too far in memory that is shared lies something else of the process.
TEST_F(Compute, IndicesStayWithinSharedArrays) {
  shader("test/far", R"(layout(local_size_x = 16, local_size_y = 8) in;
uniform sampler2D source;
shared vec4 kept[16];
shared uint count[4];
vec4 compute_at(ivec2 pixel) {
  int far = int(fetch(source, pixel).r) * 1000003;
  kept[gl_LocalInvocationIndex] = vec4(1.0);
  kept[far] = vec4(1.0);
  kept[-far] = vec4(1.0);
  atomicAdd(count[far], 1u);
  barrier();
  return kept[far * 7] + kept[gl_LocalInvocationIndex];
}
)");
  const Size size{40, 19};
  const std::vector<float> pixels(static_cast<std::size_t>(size.area()) * 4, 5);
  GraphBuilder b(size);
  const ImageId far = b.sample("far", "test/far", size, {{"source", b.source()}});
  Graph graph = b.finish(b.filter("copy", far, size, {.interpolation = Interpolation::nearest}));
  graph.passes[0].kind = PassKind::compute;
  const auto result = run(graph, {{"source", {pixels.data(), size, 4}}}).pixels;
  EXPECT_EQ(result, std::vector<float>(result.size(), 2));
}

TEST_F(Compute, DivisionsByZeroKeepTheirIeeeValues) {
  shader("divide", R"(layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2D source;
uniform float k;
vec4 compute_at(ivec2 pixel) {
  vec4 color = fetch(source, pixel);
  float unset;
  return vec4(color.r * k / 0.0, k / (color.g - color.g), (color.b - color.b) / 0.0, unset + 1.0);
}
)");
  const Size size{13, 11};
  const auto pixels = noise(size, 8);
  GraphBuilder b(size);
  const ImageId divided = b.sample("divide", "divide", size, {{"source", b.source()}}, {{"k", number(2)}});
  Graph graph = b.finish(b.filter("copy", divided, size, {.interpolation = Interpolation::nearest}));
  graph.passes[0].kind = PassKind::compute;
  const auto made = program(graph);
  ASSERT_TRUE(made);
  ASSERT_EQ(made->warnings().size(), 1u);
  EXPECT_THAT(made->warnings()[0], HasSubstr("divide.glsl:6: 'unset' may be read before it has a value"));
  const auto out = run(graph, {{"source", {pixels.data(), size, 4}}});
  for (std::size_t i = 0; i < out.pixels.size(); i += 4) {
    EXPECT_TRUE(std::isinf(out.pixels[i])) << i;
    EXPECT_TRUE(std::isinf(out.pixels[i + 1])) << i;
    EXPECT_TRUE(std::isnan(out.pixels[i + 2])) << i;
    EXPECT_EQ(out.pixels[i + 3], 1) << i;
  }
}

TEST_F(Compute, HistogramsCountWholeNumbers) {
  shader("histogram", R"(#include "lib/histogram.glsl"
layout(local_size_x = 256, pixels_x = 128) in;
uniform sampler2D source;
vec4 compute_at(ivec2 pixel) {
  ivec2 size = image_size(source);
  for (int i = int(gl_LocalInvocationIndex); i < size.x * size.y; i += 256)
    histogram_add(uint(fetch(source, ivec2(i % size.x, i / size.x)).r * 256.0));
  barrier();
  uint bin = 2u * uint(pixel.x);
  return vec4(histogram_count(bin), histogram_count(bin + 1u), 0.0, 1.0);
}
)");
  const Size size{128, 67};
  auto pixels = noise(size, 4);
  std::array<double, 256> counts{};
  for (std::size_t i = 0; i < pixels.size(); i += 4) {
    pixels[i] = std::min(pixels[i] / 4, 2.f);
    ++counts[static_cast<std::size_t>(std::min(255.f, std::floor(pixels[i] * 256)))];
  }
  shader("show", "uniform sampler2D bins;\nvec4 sample_at(ivec2 p) { return fetch(bins, ivec2(p.x, 0)); }\n");
  GraphBuilder b(size);
  const ImageId bins = b.sample("bins", "histogram", {128, 1}, {{"source", b.source()}});
  Graph graph = b.finish(b.sample("show", "show", size, {{"bins", bins}}));
  graph.passes[0].kind = PassKind::compute;
  const auto out = run(graph, {{"source", {pixels.data(), size, 4}}});
  for (std::size_t x = 0; x < 128; ++x) {
    EXPECT_EQ(out.pixels[4 * x], counts[2 * x]) << x;
    EXPECT_EQ(out.pixels[4 * x + 1], counts[2 * x + 1]) << x;
  }
}

TEST_F(Compute, RegionsDispatchWhatTheyNeed) {
  const Size size{101, 57};
  const auto pixels = noise(size, 12);
  Graph graph = box(size);
  graph.passes[0].reach = 1;
  const auto whole = run(graph, {{"source", {pixels.data(), size, 4}}});
  for (const Rect part : {Rect{0, 0, 1, 1}, Rect{37, 21, 30, 9}, Rect{96, 50, 5, 7}}) {
    const auto out = run(graph, {{"source", {pixels.data(), size, 4}}}, {.region = part});
    for (int y = part.y; y < part.y + part.height; ++y)
      for (int x = part.x; x < part.x + part.width; ++x)
        for (std::size_t c = 0; c < 4; ++c) {
          const std::size_t at = (static_cast<std::size_t>(y) * size.width + x) * 4 + c;
          ASSERT_EQ(out.pixels[at], whole.pixels[at]) << x << ' ' << y;
        }
  }
}

TEST_F(Compute, AFrameThatRepeatsRunsNothingAndAnEditRunsTheDispatch) {
  const Size size{64, 64};
  const auto pixels = noise(size, 3);
  const auto made = program(box(size), {.keep_images = true});
  auto runner = FrameRunner::create(device(), 6ull << 30, true);
  ASSERT_TRUE(made && runner);
  HostResult out;
  const HostImage source{.pixels = pixels.data(), .size = size, .content = hash_text("the same")};
  for (const auto& [gain, ran] : std::initializer_list<std::pair<double, int>>{{0.25, 2}, {0.25, 0}, {0.5, 2}}) {
    EXPECT_TRUE(made->set_parameters(box(size, gain)));
    const auto times = (*runner)->run(*made, {{"source", source}}, out, KernelTiming::none);
    ASSERT_TRUE(times) << times.error().text();
    EXPECT_EQ(times->kernels_run, ran);
    expect_near(out.pixels, expected_box(Picture64::of(size, pixels), gain), 1e-6, "box");
  }
}

TEST_F(Compute, KernelsAreTimed) {
  const Size size{64, 64};
  const auto pixels = noise(size, 3);
  const auto made = program(box(size));
  auto runner = FrameRunner::create(device(), 6ull << 30, true);
  ASSERT_TRUE(made && runner);
  HostResult out;
  const auto times = (*runner)->run(*made, {{"source", {pixels.data(), size, 4}}}, out, KernelTiming::submissions);
  ASSERT_TRUE(times) << times.error().text();
  ASSERT_EQ(times->kernels.size(), 2u);
  EXPECT_EQ(times->kernels[0].name, "box+more");
}

TEST_F(Compute, HazardsAroundADispatchAreNamed) {
  const Plan plan = make_plan(box({8, 8}), {});
  const auto image_of = [&](ImageId id) {
    return id == plan.kernels[0].output ? reinterpret_cast<VkImage>(std::uintptr_t{100}) : VkImage{VK_NULL_HANDLE};
  };
  const auto barriers =
      kernel_barriers(plan, {{}, {plan.kernels[0].output}}, image_of, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  ASSERT_EQ(barriers[0].images.size(), 1u);
  EXPECT_EQ(barriers[0].images[0].newLayout, VK_IMAGE_LAYOUT_GENERAL);
  EXPECT_TRUE(barriers[0].images[0].srcStageMask & VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
  EXPECT_TRUE(barriers[0].images[0].srcStageMask & VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
  EXPECT_EQ(barriers[0].images[0].dstStageMask, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
  ASSERT_EQ(barriers[1].images.size(), 1u);
  EXPECT_EQ(barriers[1].images[0].oldLayout, VK_IMAGE_LAYOUT_GENERAL);
  EXPECT_EQ(barriers[1].images[0].srcAccessMask, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
  EXPECT_TRUE(barriers[1].images[0].dstStageMask & VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
}

TEST_F(Compute, WhatTheDeviceCannotDoIsNamed) {
  shader("large",
         "layout(local_size_x = 1024) in;\nshared vec4 all[2048];\nuniform sampler2D source;\n"
         "vec4 compute_at(ivec2 p) { all[gl_LocalInvocationIndex] = fetch(source, p); barrier();\n"
         "  return all[1023u - gl_LocalInvocationIndex]; }\n");
  Graph graph = box({8, 8});
  graph.passes[0].shader = "large";
  graph.passes[0].params.clear();
  const auto made = try_program(graph);
  const auto& limits = device().properties().limits;
  if (limits.maxComputeWorkGroupInvocations >= 1024 && limits.maxComputeSharedMemorySize >= 32768) {
    EXPECT_TRUE(made);
  } else {
    ASSERT_FALSE(made);
    EXPECT_THAT(made.error().text(), HasSubstr("the workgroups of 'box+more' have"));
  }
  EXPECT_THAT(check_workgroup(device(), {1 << 20, 1}, 0, "x").error().text(),
              HasSubstr("the workgroups of 'x' have 1048576×1 invocations, the device allows"));
  EXPECT_THAT(check_workgroup(device(), {1, 1}, 1 << 30, "x").error().text(),
              HasSubstr("the workgroups of 'x' have 1073741824 shared bytes, the device allows"));
  EXPECT_TRUE(check_workgroup(device(), {16, 8}, 16384, "x"));  // what every device has
  shader("large",
         "layout(local_size_x = 64) in;\nshared vec4 all[2049];\nuniform sampler2D source;\n"
         "vec4 compute_at(ivec2 p) { all[0] = fetch(source, p); return all[0]; }\n");
  library_->reload();
  const auto refused = try_program(graph);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().text(),
              HasSubstr("large.glsl:2: error: the workgroup shares 32784 bytes, the largest of them 'all'"));
}

}  // namespace
}  // namespace afterglow
