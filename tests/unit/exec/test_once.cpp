// SPDX-License-Identifier: MIT
// What depends on settings and sizes alone is made once, and stays right whatever the frames after it bring.
#include "workshop.h"

namespace afterglow {
namespace {

class Once : public Workshop {
 protected:
  void SetUp() override {
    Workshop::SetUp();
    shader("spots", R"(uniform float seed;
vec4 sample_at(ivec2 pixel) { return vec4(fract(sin(dot(vec2(pixel) + seed, vec2(12.9898, 78.233))) * 43.7), 0.5, 0.25, 1.0); }
)");
    shader("gain", "vec4 apply(vec4 color) { return color * 1.5; }\n");
    shader("lit", "vec4 apply(vec4 color, vec4 dirt) { return color + dirt; }\n");
  }

  /// Nine kernels, the first two of them of settings alone; images of the others take turns in the memory.
  static Graph graph(Size size, double seed = 1) {
    const Filter blur{Interpolation::cubic_bspline};
    GraphBuilder b(size);
    const Size half{(size.width + 1) / 2, (size.height + 1) / 2};
    const ImageId spots = b.sample("spots", "spots", half, {}, {{"seed", number(seed)}});
    const ImageId dirt = b.filter("dirt", spots, size, blur);
    ImageId image = b.source();
    for (const char* name : {"a", "b", "c"}) image = b.filter(name, image, size, blur);
    image = b.pixel("lit", "lit", image, {{"dirt", dirt}});
    for (const char* name : {"d", "e", "f"}) image = b.filter(name, image, size, blur);
    return b.finish(b.filter("again", image, size, blur));
  }

  FrameTimes run(FrameRunner& frames, Program& program, Size size, const std::vector<float>& pixels, HostResult& out,
                 KernelTiming timing = KernelTiming::none) {
    auto times = frames.run(program, {{"source", {pixels.data(), size, 4}}}, out, timing);
    EXPECT_TRUE(times) << times.error().text();
    return times ? *times : FrameTimes{};
  }
  std::unique_ptr<FrameRunner> runner(bool direct) {
    auto made = FrameRunner::create(device(), 1u << 30, direct);
    EXPECT_TRUE(made);
    return std::move(*made);
  }
  /// Everything made anew by a program of its own.
  std::vector<float> alone(const Graph& graph, const ProgramOptions& options, Size size,
                           const std::vector<float>& pixels, bool direct) {
    HostResult out;
    run(*runner(direct), *program(graph, options), size, pixels, out);
    return out.pixels;
  }
};

TEST_F(Once, FramesAreTheSameAndDoNotMakeItAgain) {
  const Size size{101, 57};
  for (const bool direct : {true, false})
    for (const auto& config : {ExecutionConfig{}, ExecutionConfig{.storage_reads = true, .rows = 4},
                               ExecutionConfig{.fusion = Fusion::none, .storage = Storage::fp16}}) {
      const ProgramOptions options{.config = config, .worth = {0, 0}};
      const auto made = program(graph(size), options);
      ASSERT_LT(made->memory().arena, made->memory().sum) << "images share memory";
      const int kernels = static_cast<int>(made->plan().kernels.size());
      const auto frames = runner(direct);
      HostResult out;
      for (int frame = 0; frame < 4; ++frame) {
        const auto pixels = noise(size, 50 + frame);
        const auto times = run(*frames, *made, size, pixels, out);
        EXPECT_EQ(times.kernels_kept, frame == 0 ? 0 : 2);
        EXPECT_EQ(times.kernels_run, kernels - times.kernels_kept);
        EXPECT_EQ(out.pixels, alone(graph(size), options, size, pixels, direct)) << frame;
      }
      const int recordings = frames->counters().recordings;
      run(*frames, *made, size, noise(size, 60), out);
      EXPECT_EQ(frames->counters().recordings, recordings) << "steady frames record nothing";
    }
}

TEST_F(Once, OtherSettingsMakeItAgain) {
  const Size size{64, 64};
  const auto pixels = noise(size, 61);
  const auto made = program(graph(size));
  const auto frames = runner(true);
  HostResult out;
  run(*frames, *made, size, pixels, out);
  for (const double seed : {2.0, 2.0, 3.0}) {
    EXPECT_TRUE(made->set_parameters(graph(size, seed)));
    run(*frames, *made, size, noise(size, 62), out);
    const auto times = run(*frames, *made, size, pixels, out);
    EXPECT_EQ(times.kernels_kept, 2);
    EXPECT_EQ(out.pixels, alone(graph(size, seed), {}, size, pixels, true)) << seed;
  }
  EXPECT_TRUE(made->set_parameters(graph(size, 4)));
  EXPECT_EQ(run(*frames, *made, size, pixels, out).kernels_kept, 0);
}

TEST_F(Once, TimedFramesAndOtherRunnersFindItToo) {
  const Size size{64, 64};
  const auto pixels = noise(size, 63), other = noise(size, 64);
  const auto made = program(graph(size));
  const auto frames = runner(true);
  HostResult out;
  run(*frames, *made, size, pixels, out);
  const auto times = run(*frames, *made, size, other, out, KernelTiming::submissions);
  EXPECT_EQ(times.kernels.size(), made->plan().kernels.size() - 2) << "those that ran";
  EXPECT_EQ(out.pixels, alone(graph(size), {}, size, other, true));
  HostResult there;
  EXPECT_EQ(run(*runner(false), *made, size, pixels, there).kernels_kept, 2);
  EXPECT_EQ(there.pixels, alone(graph(size), {}, size, pixels, false));
}

}  // namespace
}  // namespace afterglow
