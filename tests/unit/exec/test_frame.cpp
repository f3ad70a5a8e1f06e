// SPDX-License-Identifier: MIT
// Frames: reuse, sizes, timing, counts, errors.
#include <gmock/gmock.h>

#include <cmath>

#include "workshop.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

class FrameTest : public Workshop {
 protected:
  void SetUp() override {
    Workshop::SetUp();
    shader("gain", "uniform float gain;\nvec4 apply(vec4 color) { return color * gain; }\n");
  }

  /// Two kernels: the gain and a copy through a filter.
  Graph graph(Size size, double gain = 2) {
    GraphBuilder b(size);
    const ImageId bright = b.pixel("bright", "gain", b.source(), {}, {{"gain", number(gain)}});
    return b.finish(b.filter("copy", bright, size, {}));
  }
  std::unique_ptr<FrameRunner> runner(bool direct = true, std::uint64_t max_memory = 1u << 30) {
    auto made = FrameRunner::create(device(), max_memory, direct);
    EXPECT_TRUE(made);
    return std::move(*made);
  }
};

TEST_F(FrameTest, SteadyFramesMakeNoObjectsAndGiveTheSameBits) {
  const Size size{101, 57};
  const auto pixels = noise(size, 21);
  const std::map<std::string, HostImage> inputs{{"source", {pixels.data(), size, 4}}};
  for (const bool direct : {true, false}) {
    const auto made = program(graph(size));
    const auto frames = runner(direct);
    HostResult first, next;
    ASSERT_TRUE(frames->run(*made, inputs, first, KernelTiming::none));
    const auto program_objects = made->counters();
    const auto objects = frames->counters();
    EXPECT_EQ(objects.images, 2);
    EXPECT_EQ(objects.buffers, direct && device().is_cpu() ? 0 : 4);
    for (int i = 0; i < 3; ++i) {
      const float* before = next.pixels.data();
      ASSERT_TRUE(frames->run(*made, inputs, next, KernelTiming::none));
      EXPECT_EQ(next.pixels, first.pixels);
      if (i > 0) {
        EXPECT_EQ(next.pixels.data(), before);
      }
    }
    EXPECT_EQ(frames->counters().images, objects.images);
    EXPECT_EQ(frames->counters().buffers, objects.buffers);
    EXPECT_EQ(made->counters().pipelines, program_objects.pipelines);
    EXPECT_EQ(made->counters().images, program_objects.images);
    EXPECT_EQ(made->counters().allocations, program_objects.allocations);
    EXPECT_LE(frames->counters().recordings, objects.recordings + 1) << "the second frame finds other layouts";

    // Commands that were recorded before read what is there now.
    const auto other = noise(size, 22);
    const std::map<std::string, HostImage> others{{"source", {other.data(), size, 4}}};
    HostResult again, fresh;
    ASSERT_TRUE(frames->run(*made, others, again, KernelTiming::none));
    EXPECT_LE(frames->counters().recordings, objects.recordings + 1);
    ASSERT_TRUE(runner(direct)->run(*made, others, fresh, KernelTiming::none));
    EXPECT_EQ(again.pixels, fresh.pixels);
    // Another runner has bound its own images meanwhile: these must be recorded anew.
    ASSERT_TRUE(frames->run(*made, inputs, again, KernelTiming::none));
    EXPECT_EQ(again.pixels, first.pixels);
  }
}

TEST_F(FrameTest, InputsReadAsStorageImagesGiveTheSameBits) {
  shader("edges", R"(uniform sampler2D depth;
uniform sampler2D normal;
uniform sampler2D other;
vec4 sample_at(ivec2 pixel) {
  vec4 d = fetch(depth, pixel + ivec2(1, 0)) - fetch(depth, pixel);
  return d + fetch(normal, pixel - 1) * fetch_linear(depth, vec2(pixel)) + fetch(other, pixel);
}
)");
  const Size size{37, 21};
  GraphBuilder b(size);
  const std::map<std::string, ImageId> images{{"depth", b.auxiliary("depth", size)},
                                              {"normal", b.auxiliary("normal", size)},
                                              {"other", b.auxiliary("layer:mask", size)}};
  const ImageId lines = b.sample("lines", "edges", size, images);
  const Graph graph = b.finish(b.filter("copy", lines, size, {}));
  const auto color = noise(size, 41), normal = noise(size, 42, 3), mask = noise(size, 43, 1);
  const ExecutionConfig reads{.storage_reads = true};
  for (const int channels : {1, 4}) {  // a depth with more channels is its first one
    const auto depth = noise(size, 44, channels);
    const std::map<std::string, HostImage> inputs{{"source", {color.data(), size, 4}},
                                                  {"depth", {depth.data(), size, channels}},
                                                  {"normal", {normal.data(), size, 3}},
                                                  {"layer:mask", {mask.data(), size, 1}}};
    const auto sampled = run(graph, inputs).pixels;
    for (const bool direct : {true, false})
      for (const int most : {0, 1, 2, 16})
        EXPECT_EQ(run(graph, inputs, {.config = reads, .inputs_are_storage = true, .most_storage_reads = most}, direct)
                      .pixels,
                  sampled)
            << most;
  }
}

TEST_F(FrameTest, WhatStaysOnTheDeviceIsWhatWouldBeReadBack) {
  const Size size{101, 57};
  const auto pixels = noise(size, 31);
  const std::map<std::string, HostImage> inputs{{"source", {pixels.data(), size, 4}}};
  for (const bool direct : {true, false}) {
    const auto made = program(graph(size));
    HostResult expected, got;
    ASSERT_TRUE(runner(direct)->run(*made, inputs, expected, KernelTiming::none));
    const auto frames = runner(direct);
    EXPECT_FALSE(frames->read_result(got)) << "nothing has run";
    int recordings = 0;
    for (int i = 0; i < 4; ++i) {
      ASSERT_TRUE(frames->run_on_device(made.get(), inputs, KernelTiming::none));
      const DeviceImages left = frames->images();
      EXPECT_TRUE(left.ran);
      EXPECT_NE(left.source.binding.image, left.result.binding.image);
      EXPECT_EQ(left.result.binding.size, size);
      EXPECT_EQ(left.result.layout,
                direct && device().is_cpu() ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
      if (i == 1) recordings = frames->counters().recordings;
    }
    EXPECT_EQ(frames->counters().recordings, recordings) << "steady frames record nothing";
    ASSERT_TRUE(frames->read_result(got));
    EXPECT_EQ(got.pixels, expected.pixels);
    ASSERT_TRUE(frames->read_result(got, Rect{3, 5, 2, 1}));
    const std::size_t at = (5 * 101 + 3) * 4;
    EXPECT_EQ(got.pixels[at], expected.pixels[at]);

    // Nothing to run: the source is there by itself, and what was read before still works afterwards.
    ASSERT_TRUE(frames->run_on_device(nullptr, inputs, KernelTiming::none));
    EXPECT_FALSE(frames->images().ran);
    EXPECT_EQ(frames->images().result.binding.image, frames->images().source.binding.image);
    EXPECT_FALSE(frames->read_result(got));
    ASSERT_TRUE(frames->run_on_device(made.get(), inputs, KernelTiming::none));
    ASSERT_TRUE(frames->read_result(got));
    EXPECT_EQ(got.pixels, expected.pixels);
    const auto fresh = runner(direct);
    ASSERT_TRUE(fresh->run_on_device(nullptr, inputs, KernelTiming::none));
    EXPECT_NE(fresh->images().source.layout, VK_IMAGE_LAYOUT_PREINITIALIZED);
    EXPECT_NE(fresh->images().source.layout, VK_IMAGE_LAYOUT_UNDEFINED);
  }
}

TEST_F(FrameTest, OneRunnerServesChangingSizesStoragesAndPrograms) {
  const auto frames = runner();
  for (const Storage storage : {Storage::fp32, Storage::fp16, Storage::fp32}) {
    for (const Size size : {Size{64, 64}, Size{7, 1}, Size{101, 57}, Size{64, 64}}) {
      const auto pixels = noise(size, 22);
      const auto made = program(graph(size, 0.5), {.config = {.storage = storage}});
      HostResult out;
      ASSERT_TRUE(frames->run(*made, {{"source", {pixels.data(), size, 4}}}, out, KernelTiming::none));
      Picture64 expected = Picture64::of(size, pixels);
      for (auto& value : expected.pixels) value *= 0.5;
      expect_near(out.pixels, expected, storage == Storage::fp32 ? 1e-5 : 2e-3, "gain");
    }
  }
}

TEST_F(FrameTest, ANewFrameReplacesThePicture) {
  const Size size{64, 64};
  const auto made = program(graph(size, 1));
  for (const bool direct : {true, false}) {
    const auto frames = runner(direct);
    for (unsigned seed = 0; seed < 3; ++seed) {
      const auto pixels = noise(size, seed);
      HostResult out;
      ASSERT_TRUE(frames->run(*made, {{"source", {pixels.data(), size, 4}}}, out, KernelTiming::none));
      EXPECT_EQ(out.pixels, pixels);
    }
  }
}

TEST_F(FrameTest, StagingGoesInBands) {
  // Three bands and a rest of rows each way.
  const Size size{1024, 1601};
  const auto pixels = noise(size, 23);
  const auto made = program(graph(size, 1));
  HostResult out;
  const auto frames = runner(false);
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(frames->run(*made, {{"source", {pixels.data(), size, 4}}}, out, KernelTiming::none));
    EXPECT_EQ(out.pixels, pixels);
  }
}

TEST_F(FrameTest, AResultThatIsTheSourceRunsNothing) {
  const Size size{7, 3};
  GraphBuilder b(size);
  const auto made = program(b.finish(b.source()));
  EXPECT_TRUE(made->plan().kernels.empty());
  EXPECT_EQ(made->counters().pipelines, 0);
  EXPECT_EQ(made->memory().arena, 0u);
  auto pixels = noise(size, 24);
  pixels[0] = 1e9f;
  HostResult out;
  const auto frames = runner();
  ASSERT_TRUE(frames->run(*made, {{"source", {pixels.data(), size, 4}}}, out, KernelTiming::submissions));
  EXPECT_EQ(out.pixels, pixels);
  EXPECT_EQ(frames->counters().images, 0);
  made->record(VK_NULL_HANDLE);  // records nothing, and so needs no command buffer
  EXPECT_TRUE(made->bind({}, {}));
}

TEST_F(FrameTest, TimesOfKernelsAloneAreMarkedAndChangeNoPixel) {
  const Size size{64, 64};
  const auto pixels = noise(size, 25);
  const std::map<std::string, HostImage> inputs{{"source", {pixels.data(), size, 4}}};
  const auto made = program(graph(size));
  for (const bool direct : {true, false}) {
    const auto frames = runner(direct);
    HostResult plain, timed, after;
    const auto none = frames->run(*made, inputs, plain, KernelTiming::none);
    ASSERT_TRUE(none);
    EXPECT_TRUE(none->kernels.empty());
    EXPECT_FALSE(none->separate_submissions);
    EXPECT_GT(none->execute, 0);
    const auto times = frames->run(*made, inputs, timed, KernelTiming::submissions);
    ASSERT_TRUE(times);
    EXPECT_TRUE(times->separate_submissions);
    ASSERT_EQ(times->kernels.size(), 2u);
    EXPECT_EQ(times->kernels[0].name, "bright");
    EXPECT_EQ(times->kernels[1].name, "copy");
    EXPECT_GT(times->kernels[0].milliseconds, 0);
    ASSERT_TRUE(frames->run(*made, inputs, after, KernelTiming::none));
    EXPECT_EQ(plain.pixels, timed.pixels);
    EXPECT_EQ(plain.pixels, after.pixels);
  }
}

TEST_F(FrameTest, NoKernelIsTimedThatReadsAnImageThatIsGone) {
  const Size size{24, 18}, other{31, 9};
  const auto pixels = noise(size, 5), next = noise(other, 6);
  const auto made = program(graph(size), {.keep_images = true});
  const auto frames = runner();
  ASSERT_TRUE(frames->run_on_device(made.get(), {{"source", {pixels.data(), size, 4}}}, KernelTiming::none));
  auto milliseconds = frames->time_kernel(*made, 0);
  ASSERT_TRUE(milliseconds);
  EXPECT_TRUE(milliseconds->has_value());
  ASSERT_TRUE(frames->run_on_device(nullptr, {{"source", {next.data(), other, 4}}}, KernelTiming::none));
  milliseconds = frames->time_kernel(*made, 0);
  ASSERT_TRUE(milliseconds);
  EXPECT_FALSE(milliseconds->has_value());
}

TEST_F(FrameTest, TimestampsAreOnlyGivenWhereTheyMeanSomething) {
  const Size size{64, 64};
  const auto pixels = noise(size, 26);
  const auto made = program(graph(size));
  HostResult out;
  const auto times = runner()->run(*made, {{"source", {pixels.data(), size, 4}}}, out, KernelTiming::timestamps);
  ASSERT_TRUE(times);
  EXPECT_EQ(times->kernels.size(), device().timestamps_mean_draws() ? 2u : 0u);
  EXPECT_FALSE(times->separate_submissions);
}

TEST_F(FrameTest, HalfStorageCountsHeldValuesAndStaysFinite) {
  const Size size{7, 5};
  std::vector<float> pixels(35 * 4, 1.0f);
  pixels[0] = 1e6f;   // held when it is stored
  pixels[5] = 60000;  // held when it is doubled
  for (const bool direct : {true, false}) {
    const auto made = program(graph(size, 2), {.config = {.storage = Storage::fp16}});
    HostResult out;
    ASSERT_TRUE(runner(direct)->run(*made, {{"source", {pixels.data(), size, 4}}}, out, KernelTiming::none));
    EXPECT_EQ(out.clamped, 3u);  // one of the source, two of the result
    EXPECT_EQ(out.pixels[0], 65504.0f);
    EXPECT_EQ(out.pixels[5], 65504.0f);
    EXPECT_EQ(out.pixels[1], 2.0f);
  }
}

TEST_F(FrameTest, TheResultMayTakeThePlaceOfTheSource) {
  const Size size{101, 57};
  const auto pixels = noise(size, 30);
  for (const bool direct : {true, false}) {
    for (const Storage storage : {Storage::fp32, Storage::fp16}) {
      const auto made = program(graph(size, 2), {.config = {.storage = storage}});
      HostResult apart, in_place{.pixels = pixels, .keep_alpha = true};
      const auto frames = runner(direct);
      ASSERT_TRUE(frames->run(*made, {{"source", {pixels.data(), size, 4}}}, apart, KernelTiming::none));
      const float* memory = in_place.pixels.data();
      ASSERT_TRUE(frames->run(*made, {{"source", {memory, size, 4}}}, in_place, KernelTiming::none));
      EXPECT_EQ(in_place.pixels.data(), memory);
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        ASSERT_EQ(in_place.pixels[i], i % 4 == 3 ? pixels[i] : apart.pixels[i]) << i;
      }
    }
  }
  GraphBuilder b(size);
  const auto nothing = program(b.finish(b.source()));
  HostResult same{.pixels = pixels};
  ASSERT_TRUE(runner()->run(*nothing, {{"source", {same.pixels.data(), size, 4}}}, same, KernelTiming::none));
  EXPECT_EQ(same.pixels, pixels);
}

TEST_F(FrameTest, ReferenceProgramsKeepTheirImages) {
  const Size size{101, 57};
  const auto pixels = noise(size, 27);
  const auto frames = runner();
  const auto kept = program(graph(size, 2), {.reference = true});
  HostResult out;
  ASSERT_TRUE(frames->run(*kept, {{"source", {pixels.data(), size, 4}}}, out, KernelTiming::none));
  const auto bright = frames->read_image(*kept, kept->plan().kernels[0].output);
  ASSERT_TRUE(bright) << bright.error().text();
  std::vector<float> expected = pixels;
  for (auto& value : expected) value *= 2;
  EXPECT_EQ(bright->pixels, expected);
  HostResult again;  // reading left all as it was
  ASSERT_TRUE(frames->run(*kept, {{"source", {pixels.data(), size, 4}}}, again, KernelTiming::none));
  EXPECT_EQ(again.pixels, out.pixels);

  const auto shared = program(graph(size, 2));
  for (const ImageId id : {shared->plan().kernels[0].output, shared->graph().result, shared->graph().source, -5, 99}) {
    const auto refused = frames->read_image(*shared, id);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("are not kept"));
  }
}

TEST_F(FrameTest, WrongInputsAreRefused) {
  shader("fog", "uniform sampler2D depth;\nvec4 sample_at(ivec2 pixel) { return fetch(depth, pixel); }\n");
  const Size size{8, 8};
  const auto pixels = noise(size, 28);
  GraphBuilder b(size);
  const ImageId depth = b.auxiliary("depth", size);
  const auto made = program(b.finish(b.sample("fog", "fog", size, {{"depth", depth}})));
  const auto frames = runner();
  HostResult out;
  const HostImage good{pixels.data(), size, 4};
  auto times = frames->run(*made, {}, out, KernelTiming::none);
  ASSERT_FALSE(times);
  times = frames->run(*made, {{"source", good}}, out, KernelTiming::none);
  ASSERT_FALSE(times);
  EXPECT_THAT(times.error().message, HasSubstr("the frame has no image 'depth'"));
  times = frames->run(*made, {{"source", good}, {"depth", {pixels.data(), {4, 4}, 1}}}, out, KernelTiming::none);
  ASSERT_FALSE(times);
  EXPECT_THAT(times.error().message, HasSubstr("image 'depth' has 4×4 pixels, the stack was built for 8×8"));
  times = frames->run(*made, {{"source", good}, {"depth", {pixels.data(), size, 5}}}, out, KernelTiming::none);
  ASSERT_FALSE(times);
  EXPECT_THAT(times.error().message, HasSubstr("5 channels"));
  EXPECT_TRUE(frames->run(*made, {{"source", good}, {"depth", {pixels.data(), size, 1}}, {"unused", {}}}, out,
                          KernelTiming::none));
}

TEST_F(FrameTest, MoreMemoryThanAllowedIsAnInputErrorBeforeAnythingIsMade) {
  const Size size{512, 512};
  const auto pixels = noise(size, 29);
  const auto made = program(graph(size));
  const auto frames = runner(true, 8u << 20);
  HostResult out;
  const auto times = frames->run(*made, {{"source", {pixels.data(), size, 4}}}, out, KernelTiming::none);
  ASSERT_FALSE(times);
  EXPECT_EQ(times.error().kind, ErrorKind::io);
  const char* need = device().maps_images() ? "the frame needs 12 MiB" : "the frame needs 28 MiB";  // with staging
  EXPECT_THAT(times.error().message, HasSubstr(need));
  EXPECT_EQ(frames->counters().images, 0);
}

}  // namespace
}  // namespace afterglow
