// SPDX-License-Identifier: MIT
// Pixels that a look brings along may be others in each frame: the same program runs, and reads what the frame has.
#include <fmt/format.h>

#include "renderer_test.h"

namespace afterglow {
namespace {

class BroughtAlong : public RendererTest {
 protected:
  void SetUp() override {
    RendererTest::SetUp();
    shader("test/add", "vec4 apply(vec4 color, vec4 other) { return vec4(color.rgb + other.rgb, color.a); }\n");
  }

  static std::shared_ptr<const ImageData> brought(float value, Size size = kSize) {
    ImageData data{.size = size, .pixels = {}, .hash = {}, .file = {}};
    data.pixels.assign(static_cast<std::size_t>(size.area()) * 4, value);
    data.hash = Hasher().add(fmt::format("{} {}", value, size.width)).finish();
    return std::make_shared<const ImageData>(std::move(data));
  }
  /// The picture and what is brought along, added up; `once`: by way of a filter that reads nothing of the frame.
  static Graph graph(std::shared_ptr<const ImageData> data, bool once = false) {
    GraphBuilder builder(kSize);
    const Size size = data->size;
    const ImageId image = builder.auxiliary("brought", size);
    ImageId other = image;
    if (once || size != kSize)
      other = builder.filter("blur", image, kSize, {Interpolation::nearest, {{-1, 0.5}, {1, 0.5}}, {{0, 1}}, {}});
    Graph out = builder.finish(builder.pixel("sum", "test/add", builder.source(), {{"other", other}}));
    out.auxiliary.clear();  // no host gives it
    out.images[static_cast<std::size_t>(image)].data = std::move(data);
    return out;
  }
  static void expect_sum(const HostResult& out, const std::vector<float>& source, float value) {
    ASSERT_EQ(out.pixels.size(), source.size());
    for (std::size_t i = 0; i < source.size(); ++i)
      ASSERT_FLOAT_EQ(out.pixels[i], i % 4 == 3 ? source[i] : source[i] + value);
  }
};

TEST_F(BroughtAlong, FramesWithOtherPixelsRunTheSameProgram) {
  constexpr int kFrames = 7;
  const auto value_of = [](int frame) { return static_cast<float>(frame / 2 + 1); };  // two frames each
  std::vector<std::vector<float>> sources;
  for (int i = 0; i < kFrames; ++i) sources.push_back(noise(kSize, static_cast<unsigned>(i)));
  for (const bool once : {false, true})
    for (const bool storage : {false, true})
      for (const bool keep : {false, true})
        for (const int frames : {0, 1, 2, 3}) {  // 0: in the images themselves
          SCOPED_TRACE(fmt::format("once {}, storage {}, kept {}, in flight {}", once, storage, keep, frames));
          const auto programs = cache({.config = {.storage_reads = storage}, .own_images = true, .keep_images = keep});
          const auto ring = renderer(std::max(frames, 1), frames == 0);
          int collected = 0;
          std::uint64_t program = 0;
          const auto collect = [&] {
            HostResult out;
            const auto report = ring->collect(out);
            ASSERT_TRUE(report) << report.error().text();
            if (collected > 0) {
              EXPECT_EQ(report->program, program);
            }
            program = report->program;
            expect_sum(out, sources[static_cast<std::size_t>(collected)], value_of(collected));
            ++collected;
          };
          for (int i = 0; i < kFrames; ++i) {
            if (ring->in_flight() == ring->frames()) collect();
            const auto submitted = ring->submit(
                request(*programs, graph(brought(value_of(i)), once), sources[static_cast<std::size_t>(i)]));
            ASSERT_TRUE(submitted) << submitted.error().text();
          }
          while (ring->in_flight() > 0) collect();
          EXPECT_EQ(collected, kFrames);
        }
}

/// A source that stays is no reason to keep a result that was made with other pixels.
TEST_F(BroughtAlong, KernelsRunAgainForOtherPixelsAlone) {
  const auto pixels = noise(kSize, 3);
  const auto programs = cache({.own_images = true, .keep_images = true});
  const auto ring = renderer(1, true);
  const auto kept = [&](float value) {
    RenderRequest one = request(*programs, graph(brought(value), true), pixels);
    one.inputs["source"].content = Hash{1, 1};
    HostResult out;
    const auto report = ring->render(std::move(one), out);
    EXPECT_TRUE(report) << report.error().text();
    if (!report) return -1;
    expect_sum(out, pixels, value);
    return report->times.kernels_kept;
  };
  EXPECT_EQ(kept(1), 0);
  EXPECT_GT(kept(1), 0);
  EXPECT_EQ(kept(2), 0);
  EXPECT_GT(kept(2), 0);
  EXPECT_EQ(kept(1), 0);
}

TEST_F(BroughtAlong, AnotherSizeIsAnotherProgram) {
  const auto pixels = noise(kSize, 4);
  const auto programs = cache({.own_images = true});
  const auto ring = renderer(1, true);
  std::vector<std::uint64_t> seen;
  for (const auto& data : {brought(1, {8, 8}), brought(2, {8, 8}), brought(3, {9, 9})}) {
    HostResult out;
    const auto report = ring->render(request(*programs, graph(data), pixels), out);
    ASSERT_TRUE(report) << report.error().text();
    expect_sum(out, pixels, data->pixels.front());
    seen.push_back(report->program);
  }
  EXPECT_EQ(seen[0], seen[1]);
  EXPECT_NE(seen[1], seen[2]);
}

/// Whoever records must bind again: the pixels are brought to the device there.
TEST_F(BroughtAlong, OtherPixelsUnbindTheProgram) {
  const auto made = program(graph(brought(1)));
  ASSERT_TRUE(made);
  const ImageDesc desc{.name = "",
                       .size = kSize,
                       .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                       .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};
  const auto source = GpuImage::create(device(), desc), result = GpuImage::create(device(), desc);
  ASSERT_TRUE(source);
  ASSERT_TRUE(result);
  const auto binding = [](const GpuImage& image) {
    return ImageBinding{image.get(), image.view(), image.desc().format, image.desc().size};
  };
  const auto bind = [&] { return made->bind({{"source", binding(*source)}}, binding(*result)).ok(); };
  EXPECT_FALSE(made->bound());
  ASSERT_TRUE(bind());
  EXPECT_TRUE(made->bound());
  const int before = made->bindings();
  ASSERT_TRUE(made->set_parameters(graph(brought(1))));
  EXPECT_TRUE(made->bound()) << "the same pixels";
  EXPECT_EQ(made->bindings(), before);
  ASSERT_TRUE(made->set_parameters(graph(brought(2))));
  EXPECT_FALSE(made->bound());
  EXPECT_NE(made->bindings(), before);
  ASSERT_TRUE(bind());
  EXPECT_TRUE(made->bound());
}

}  // namespace
}  // namespace afterglow
