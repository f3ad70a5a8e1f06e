// SPDX-License-Identifier: MIT
// Programs: structure, memory, parameters, errors, recording into a caller's command buffer.
#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "exec/kernel_timer.h"
#include "exec/program_cache.h"
#include "exec/submit.h"
#include "gpu/image.h"
#include "workshop.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

class ProgramTest : public Workshop {
 protected:
  void SetUp() override {
    Workshop::SetUp();
    shader("gain", "uniform float gain;\nvec4 apply(vec4 color) { return color * gain; }\n");
    shader("add", "vec4 apply(vec4 color, vec4 other) { return color + other; }\n");
    shader("blend", "uniform float t;\nvec4 apply(vec4 color, vec4 other) { return color * (1.0 - t) + other * t; }\n");
  }

  /// A pyramid with a way down, a way up and a final blend: what bloom does, five levels deep.
  Graph pyramid(Size size, double gain = 0.5) {
    GraphBuilder b(size);
    std::vector<ImageId> levels{b.pixel("bright", "gain", b.source(), {}, {{"gain", number(gain)}})};
    Size level = size;
    for (int i = 0; i < 5; ++i) {
      level = {std::max(1, level.width / 2), std::max(1, level.height / 2)};
      Filter wide;
      wide.x = {{-2, 0.25}, {0, 0.5}, {2, 0.25}};
      levels.push_back(b.filter("down" + std::to_string(i), levels.back(), level, wide));
      sizes_.push_back(level);
    }
    ImageId up = levels.back();
    for (int i = 3; i >= 0; --i) {
      const std::string index = std::to_string(i);
      up = b.pixel("mix" + index, "blend", b.filter("up" + index, up, sizes_[i], {}), {{"other", levels[i + 1]}},
                   {{"t", number(0.3)}});
    }
    sizes_.clear();
    const ImageId result = b.pixel("final", "add", b.filter("up", up, size, {}), {{"other", b.source()}});
    return b.finish(result);
  }

  /// Two branches from one image that meet again, one of them longer.
  Graph diamond(Size size) {
    GraphBuilder b(size);
    const ImageId top =
        b.filter("top", b.source(), size, Filter{.interpolation = Interpolation::linear, .x = {{-1, 0.5}, {1, 0.5}}});
    const ImageId left =
        b.filter("left", top, size, Filter{.interpolation = Interpolation::linear, .y = {{-1, 0.5}, {1, 0.5}}});
    const ImageId left2 =
        b.filter("left2", left, size, Filter{.interpolation = Interpolation::linear, .x = {{-3, 0.5}, {3, 0.5}}});
    const ImageId right = b.pixel("right", "gain", top, {}, {{"gain", number(2)}});
    const ImageId fused = b.pixel("join", "add", left2, {{"other", right}});
    return b.finish(b.pixel("again", "add", fused, {{"other", top}}));
  }

 private:
  std::vector<Size> sizes_;
};

/// Each keeps the limits of what a shader may hold, and both together do not.
TEST_F(ProgramTest, PassesThatAreTooMuchTogetherRunApart) {
  shader("holds",
         "uniform float gain;\nvec4 apply(vec4 color) {\n  float a[250], b[250], c[250];\n"
         "  for (int i = 0; i < 250; ++i) a[i] = b[i] = c[i] = color.r * gain;\n"
         "  int at = int(color.g * 249.0);\n  return vec4(a[at], b[at], c[at], 1.0);\n}\n");
  shader("holds_more",
         "vec4 apply(vec4 color) {\n  float a[250], b[250], c[250], d[250], e[250];\n"
         "  for (int i = 0; i < 250; ++i) a[i] = b[i] = c[i] = d[i] = e[i] = color.r;\n"
         "  int at = int(color.g * 249.0);\n  return vec4(a[at], b[at], c[at], d[at] + e[at]);\n}\n");
  const Size size{17, 5};
  const std::vector<float> source = noise(size, 3);
  const std::map<std::string, HostImage> inputs{{"source", {.pixels = source.data(), .size = size}}};
  GraphBuilder b(size);
  const ImageId once = b.pixel("once", "holds", b.source(), {}, {{"gain", number(0.5)}});
  const Graph graph = b.finish(b.pixel("twice", "holds", once, {}, {{"gain", number(3)}}));
  const auto made = try_program(graph);
  ASSERT_TRUE(made) << made.error().text();
  EXPECT_EQ((*made)->plan().kernels.size(), 2u);
  EXPECT_EQ(run(graph, inputs).pixels, run(graph, inputs, {.config = {.fusion = Fusion::none}}).pixels);

  CheckedKernels checked;
  EXPECT_TRUE(check_kernels(*library_, *compiler_, {.graph = graph}, {}, checked).errors.empty());
  GraphBuilder heavy(size);
  const ImageId light = heavy.pixel("light", "holds", heavy.source(), {}, {{"gain", number(0.5)}});
  const Graph bad = heavy.finish(heavy.pixel("heavy", "holds_more", light));
  const auto errors = check_kernels(*library_, *compiler_, {.graph = bad}, {}, checked).errors;
  ASSERT_EQ(errors.size(), 1u);
  for (const Error& error : {errors[0], try_program(bad).error()}) {
    EXPECT_THAT(error.text(), HasSubstr("holds_more.glsl:2: error: the shader holds 5000 bytes in arrays"));
  }
}

TEST_F(ProgramTest, DiamondsGiveTheRightPixels) {
  const Filter horizontal{.interpolation = Interpolation::linear, .x = {{-1, 0.5}, {1, 0.5}}};
  const Filter vertical{.interpolation = Interpolation::linear, .y = {{-1, 0.5}, {1, 0.5}}};
  const Filter wide{.interpolation = Interpolation::linear, .x = {{-3, 0.5}, {3, 0.5}}};
  for (const Size size : kSizes) {
    const auto pixels = noise(size, 11);
    const Picture64 top = filter64(Picture64::of(size, pixels), horizontal, size);
    Picture64 expected = filter64(filter64(top, vertical, size), wide, size);
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) expected.pixels[i] += 3 * top.pixels[i];
    for (const bool reference : {false, true}) {
      const auto out = run(diamond(size), {{"source", {pixels.data(), size, 4}}}, {.reference = reference});
      expect_near(out.pixels, expected, 1e-5, "diamond");
    }
  }
}

TEST_F(ProgramTest, SharedMemoryChangesNoBit) {
  for (const Size size : {Size{64, 64}, Size{101, 57}, Size{7, 1}}) {
    const auto pixels = noise(size, 12);
    const std::map<std::string, HostImage> inputs{{"source", {pixels.data(), size, 4}}};
    for (const auto& graph : {pyramid(size), diamond(size)}) {
      const auto shared = run(graph, inputs, {.config = {.share_memory = true}});
      const auto apart = run(graph, inputs, {.config = {.share_memory = false}});
      EXPECT_EQ(shared.pixels, apart.pixels);
    }
  }
}

TEST_F(ProgramTest, SharingSavesMemoryAndReferenceDoesNotShare) {
  const Size size{256, 128};
  const auto shared = program(pyramid(size));
  const auto apart = program(pyramid(size), {.config = {.share_memory = false}});
  const auto reference = program(pyramid(size), {.reference = true});
  EXPECT_LT(shared->memory().arena, shared->memory().sum);
  EXPECT_GE(shared->memory().arena, shared->memory().lower_bound);
  EXPECT_EQ(apart->memory().arena, apart->memory().sum);
  EXPECT_GE(reference->memory().arena, reference->memory().sum);
  EXPECT_EQ(shared->counters().allocations, 2);  // the images, the parameters
  // The result is the caller's image: one image fewer than kernels.
  EXPECT_EQ(shared->counters().images, static_cast<int>(shared->plan().kernels.size()) - 1);
  const auto half = program(pyramid(size), {.config = {.storage = Storage::fp16}});
  EXPECT_EQ(half->storage_format(), VK_FORMAT_R16G16B16A16_SFLOAT);
  EXPECT_LT(half->memory().arena, shared->memory().arena);
}

TEST_F(ProgramTest, EqualKernelsShareAPipeline) {
  const auto made = program(pyramid({256, 256}));
  EXPECT_EQ(made->plan().kernels.size(), 11u);
  // bright; down (all halve exactly); up+mix; up+final.
  EXPECT_EQ(made->counters().pipelines, 4);
}

TEST_F(ProgramTest, ParametersAreRewrittenWithoutNewObjects) {
  const Size size{64, 64};
  const auto pixels = noise(size, 13);
  const std::map<std::string, HostImage> inputs{{"source", {pixels.data(), size, 4}}};
  const auto made = program(pyramid(size, 0.5));
  auto runner = FrameRunner::create(device(), 1u << 30);
  ASSERT_TRUE(runner);
  HostResult first, changed, again;
  ASSERT_TRUE((*runner)->run(*made, inputs, first, KernelTiming::none));
  const auto objects = made->counters();
  const auto frame_objects = (*runner)->counters();
  const auto compiled = compiler_->counters().compiled;

  EXPECT_TRUE(made->set_parameters(pyramid(size, 4.0)));
  ASSERT_TRUE((*runner)->run(*made, inputs, changed, KernelTiming::none));
  EXPECT_NE(first.pixels, changed.pixels);
  EXPECT_EQ(changed.pixels, run(pyramid(size, 4.0), inputs).pixels);
  EXPECT_TRUE(made->set_parameters(pyramid(size, 0.5)));
  ASSERT_TRUE((*runner)->run(*made, inputs, again, KernelTiming::none));
  EXPECT_EQ(first.pixels, again.pixels);

  EXPECT_EQ(made->counters().pipelines, objects.pipelines);
  EXPECT_EQ(made->counters().images, objects.images);
  EXPECT_EQ(made->counters().allocations, objects.allocations);
  EXPECT_EQ((*runner)->counters().images, frame_objects.images);
  EXPECT_EQ((*runner)->counters().buffers, frame_objects.buffers);
  EXPECT_EQ(compiler_->counters().compiled, compiled);
}

TEST_F(ProgramTest, ParametersOfAnotherStructureAreIgnored) {
  const Size size{7, 5};
  const auto pixels = noise(size, 16);
  const std::map<std::string, HostImage> inputs{{"source", {pixels.data(), size, 4}}};
  const auto made = program(pyramid(size));
  auto runner = FrameRunner::create(device(), 1u << 30);
  ASSERT_TRUE(runner);
  HostResult before, after;
  ASSERT_TRUE((*runner)->run(*made, inputs, before, KernelTiming::none));
  GraphBuilder empty(size);
  EXPECT_TRUE(made->set_parameters(empty.finish(empty.source())));
  EXPECT_TRUE(made->set_parameters(diamond(size)));
  ASSERT_TRUE((*runner)->run(*made, inputs, after, KernelTiming::none));
  EXPECT_EQ(before.pixels, after.pixels);
}

TEST_F(ProgramTest, MissingParametersAndInputsNameThePass) {
  GraphBuilder b({4, 4});
  auto result = try_program(b.finish(b.pixel("dim", "gain", b.source())));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::script);
  EXPECT_THAT(result.error().message, HasSubstr("pass 'dim' lacks the parameter 'gain'"));
  GraphBuilder c({4, 4});
  result = try_program(c.finish(c.pixel("sum", "add", c.source())));
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message, HasSubstr("pass 'sum' lacks the input 'other'"));
  GraphBuilder d({4, 4});
  result = try_program(d.finish(d.pixel("none", "no_such_shader", d.source())));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::script);
}

TEST_F(ProgramTest, ShaderErrorsComeOutOfTheThreads) {
  shader("good", "vec4 apply(vec4 color) { return color; }\n");
  shader("bad", "vec4 apply(vec4 color) {\n  return colour;\n}\n");
  GraphBuilder b({4, 4});
  const ImageId one = b.filter("one", b.source(), {2, 2}, {});
  const ImageId two = b.pixel("two", "bad", b.filter("up", one, {4, 4}, {}));
  const auto result =
      try_program(b.finish(b.filter("three", two, {4, 4}, {.interpolation = Interpolation::linear, .x = {{1, 1}}})));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::script);
  EXPECT_THAT(result.error().file, HasSubstr("bad.glsl"));
  EXPECT_EQ(result.error().line, 2);
}

TEST_F(ProgramTest, OverTheLimitsIsRefusedBeforeAnythingIsAllocated) {
  shader("flat", "uniform sampler2D image;\nvec4 sample_at(ivec2 pixel) { return fetch(image, pixel); }\n");
  GraphBuilder wide({1 << 20, 1});
  auto result = try_program(wide.finish(wide.filter("wide", wide.source(), {1 << 20, 1}, {})));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::device);
  EXPECT_THAT(result.error().message, HasSubstr("image 'wide' of 1048576×1 pixels: the device allows"));

  const Size large{4096, 4096};
  GraphBuilder b(large);
  const ImageId a = b.filter("a", b.source(), large, {});
  result =
      try_program(b.finish(b.filter("b", b.filter("mid", a, {2048, 2048}, {}), large, {})), {.max_memory = 200u << 20});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::io);
  EXPECT_THAT(result.error().message, HasSubstr("--max-memory"));
}

TEST_F(ProgramTest, AllocationsAreSplitWhenOneWouldBeTooLarge) {
  // Three images of 1 GiB alive at once are more than one allocation of most devices; nothing is drawn, so nothing is
  // touched.
  if (device().max_allocation() > (3ull << 30)) GTEST_SKIP() << "the device allows it in one piece";
  const Size large{8192, 8192};
  GraphBuilder b(large);
  const ImageId x = b.filter("x", b.source(), large, {});
  const ImageId y = b.filter("y", x, large, {.interpolation = Interpolation::linear, .x = {{1, 1}}});
  const ImageId z = b.filter("z", y, large, {.interpolation = Interpolation::linear, .x = {{2, 1}}});
  const auto made = program(b.finish(b.pixel("sum", "add", b.filter("w", z, large, {}), {{"other", x}})));
  ASSERT_TRUE(made);
  EXPECT_GE(made->counters().allocations, 2);
}

TEST_F(ProgramTest, BindChecksWhatItIsGiven) {
  const auto made = program(pyramid({64, 64}));
  const auto no_images = made->bind({}, {});
  ASSERT_FALSE(no_images);
  EXPECT_THAT(no_images.error().message, HasSubstr("the result must be an image of 64×64"));
  auto image =
      GpuImage::create(device(), {.name = "target", .size = {64, 64}, .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT});
  ASSERT_TRUE(image);
  const ImageBinding target{image->get(), image->view(), VK_FORMAT_R32G32B32A32_SFLOAT, {64, 64}};
  const auto no_source = made->bind({}, target);
  ASSERT_FALSE(no_source);
  EXPECT_THAT(no_source.error().message, HasSubstr("no image is bound to 'source'"));
  ImageBinding small = target;
  small.size = {32, 64};
  const auto wrong_size = made->bind({{"source", small}}, target);
  ASSERT_FALSE(wrong_size);
  EXPECT_THAT(wrong_size.error().message, HasSubstr("has 32×64 pixels, not 64×64"));
}

TEST_F(ProgramTest, RecordsTwiceIntoACallersCommandBufferWithTimestamps) {
  const Size size{101, 57};
  const auto pixels = noise(size, 14);
  const auto made = program(pyramid(size));
  const VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                  VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  auto source = GpuImage::create(device(), {.name = "in", .size = size, .usage = usage});
  auto result = GpuImage::create(device(), {.name = "out", .size = size, .usage = usage});
  ASSERT_TRUE(source && result);
  const auto format = VK_FORMAT_R32G32B32A32_SFLOAT;
  const ImageBinding input{source->get(), source->view(), format, size};
  const ImageBinding output{result->get(), result->view(), format, size};
  ASSERT_TRUE(made->bind({{"source", input}}, output));

  auto submitter = Submitter::create(device());
  ASSERT_TRUE(submitter);
  KernelTimer timer(device());
  const auto queries = timer.queries(made->plan().kernels.size() + 1);
  ASSERT_TRUE(queries);
  ASSERT_TRUE(submitter->submit([&](VkCommandBuffer commands) {
    const auto to_clear = image_barrier(source->get(), VK_PIPELINE_STAGE_2_NONE, 0, VK_IMAGE_LAYOUT_UNDEFINED,
                                        VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                        VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    record_barriers(device(), commands, &to_clear, 1);
    const VkClearColorValue grey{{0.25f, 0.5f, 1.0f, 1.0f}};
    const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    device().vk().vkCmdClearColorImage(commands, source->get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &grey, 1, &range);
    const VkImageMemoryBarrier2 ready[] = {
        image_barrier(source->get(), VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                      VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                      VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL),
        image_barrier(result->get(), VK_PIPELINE_STAGE_2_NONE, 0, VK_IMAGE_LAYOUT_UNDEFINED,
                      VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                      VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL)};
    record_barriers(device(), commands, ready, 2);
    made->record(commands);
    // The result is drawn a second time: that order is the caller's to keep.
    const auto again = image_barrier(result->get(), VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                     VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                     VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                     VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    record_barriers(device(), commands, &again, 1);
    made->record(commands, *queries);
  }));
  ASSERT_TRUE(submitter->wait());
  const auto times = timer.read(made->plan());
  ASSERT_TRUE(times) << times.error().text();
  ASSERT_EQ(times->size(), made->plan().kernels.size());
  for (std::size_t i = 0; i < times->size(); ++i) {
    EXPECT_EQ((*times)[i].name, made->plan().kernels[i].name);
    EXPECT_GE((*times)[i].milliseconds, 0);
    EXPECT_LT((*times)[i].milliseconds, 60e3);
  }
}

TEST_F(ProgramTest, AnAdoptedDeviceGivesTheSamePixels) {
  const Size size{64, 64};
  const auto pixels = noise(size, 15);
  const std::map<std::string, HostImage> inputs{{"source", {pixels.data(), size, 4}}};
  const auto expected = run(pyramid(size), inputs);
  Diagnostics diagnostics;
  {
    auto adopted = Device::adopt(
        {device().instance(), device().physical(), device().handle(), device().queue(), device().queue_family()},
        diagnostics);
    ASSERT_TRUE(adopted) << adopted.error().text();
    auto made = Program::create(**adopted, *library_, *compiler_, pyramid(size), {});
    auto runner = FrameRunner::create(**adopted, 1u << 30);
    ASSERT_TRUE(made && runner);
    HostResult out;
    ASSERT_TRUE((*runner)->run(**made, inputs, out, KernelTiming::none));
    EXPECT_EQ(out.pixels, expected.pixels);
  }
}

TEST_F(ProgramTest, ALostDeviceNamesKernels) {
  const auto made = program(pyramid({16, 16}));
  const Error error = KernelTimer::blame({ErrorKind::device, "device lost"}, made->plan());
  EXPECT_THAT(error.message, HasSubstr("the last of them 'up+final'"));
}

}  // namespace
}  // namespace afterglow
