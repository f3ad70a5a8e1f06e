// SPDX-License-Identifier: MIT
// Frames in flight: what comes out is what comes out one at a time, in the same order, whatever overlaps.
#include <fmt/format.h>

#include "exec/calibration.h"
#include "renderer_test.h"

namespace afterglow {
namespace {

/// The pixels, the values and now and then the structure are others in every frame; what one reads or writes too early
/// or too late is a wrong number.
TEST_F(RendererTest, FramesInFlightAreThoseOfOneAtATime) {
  constexpr int kFrames = 24;
  std::vector<std::vector<float>> sources;
  for (int i = 0; i < kFrames; ++i) sources.push_back(noise(kSize, static_cast<unsigned>(i)));
  for (const int frames : {1, 2, 3}) {
    const auto programs = cache();
    const auto ring = renderer(frames);
    ASSERT_EQ(ring->frames(), frames);
    int collected = 0;
    const auto collect = [&] {
      HostResult out;
      const auto report = ring->collect(out);
      ASSERT_TRUE(report) << report.error().text();
      const auto& source = sources[static_cast<std::size_t>(collected)];
      const float offset = collected % 7 == 3 ? 1 : 0;
      ASSERT_EQ(out.pixels.size(), source.size());
      for (std::size_t i = 0; i < source.size(); ++i) {
        const float want = i % 4 == 3 ? source[i] : source[i] * static_cast<float>(collected + 1) + offset;
        ASSERT_FLOAT_EQ(out.pixels[i], want) << "frame " << collected << " of " << frames << " in flight";
      }
      ++collected;
    };
    for (int i = 0; i < kFrames; ++i) {
      if (ring->in_flight() == frames) collect();
      const auto submitted =
          ring->submit(request(*programs, graph(i + 1, i % 7 == 3), sources[static_cast<std::size_t>(i)]));
      ASSERT_TRUE(submitted) << submitted.error().text();
    }
    EXPECT_EQ(ring->in_flight(), frames);
    while (ring->in_flight() > 0) collect();
    EXPECT_EQ(collected, kFrames);
  }
}

TEST_F(RendererTest, ADeviceIsMadeToStage) {
  Diagnostics nowhere;
  for (const auto& [words, frames] : {std::pair("", device().is_cpu() ? 1 : 3), {"staging", 3}, {"unmapped", 3}}) {
    const auto own = Device::create({.forced = parse_forced(words).value()}, nowhere);
    ASSERT_TRUE(own) << own.error().text();
    const auto made = Renderer::create(**own, {.direct = true, .frames = 3});
    ASSERT_TRUE(made) << made.error().text();
    EXPECT_EQ((*made)->frames(), frames) << words;
  }
}

/// The picture times `gain`, and beside it what the frame before showed.
Graph trail(Size size, double gain) {
  GraphBuilder builder(size);
  const ImageId before = builder.auxiliary("before", size);
  const ImageId now = builder.pixel("gain", "test/gain", builder.source(), {}, {{"gain", number(gain)}});
  const ImageId sum = builder.pixel("sum", "test/add", now, {{"other", before}});
  Graph graph = builder.finish(builder.pixel("offset", "test/offset", sum, {}, {{"by", number(0)}}));
  graph.auxiliary.clear();  // no host gives it
  graph.histories.push_back({.name = "past", .effect = "", .previous = before, .next = sum});
  return graph;
}

/// Images, buffers and commands: each frame in flight has its own, which stay good when another frame has run.
TEST_F(RendererTest, SteadyFramesMakeNothingNew) {
  shader("test/add", "vec4 apply(vec4 color, vec4 other) { return vec4(color.rgb + other.rgb, color.a); }\n");
  const auto pixels = noise(kSize, 1);
  for (const bool history : {false, true})
    for (const int frames : {1, 2, 3}) {
      SCOPED_TRACE(fmt::format("history: {}, in flight: {}", history, frames));
      const auto programs = cache();
      const auto ring = renderer(frames);
      int collected = 0;
      float sum = 0;
      const auto collect = [&] {
        HostResult out;
        ASSERT_TRUE(ring->collect(out));
        const auto gain = static_cast<float>(++collected);
        sum = history ? sum + gain * pixels[0] : gain * pixels[0];
        EXPECT_FLOAT_EQ(out.pixels[0], sum) << collected;
      };
      Renderer::Counters steady;
      for (int i = 0; i < 18; ++i) {
        if (ring->in_flight() == frames) collect();
        if (i == 9) steady = ring->counters();
        const double gain = i + 1;
        RenderRequest one = request(*programs, history ? trail(kSize, gain) : graph(gain), pixels);
        one.work.frame = i + 1;
        ASSERT_TRUE(ring->submit(std::move(one)));
      }
      while (ring->in_flight() > 0) collect();
      EXPECT_EQ(ring->counters().images, steady.images);
      EXPECT_EQ(ring->counters().buffers, steady.buffers);
      EXPECT_EQ(ring->counters().recordings, steady.recordings);
      EXPECT_EQ(programs->programs(), 1);
    }
}

/// What fails while a frame is packed is told of that frame, and once.
TEST_F(RendererTest, AFrameThatCannotBePackedFailsAlone) {
  const auto pixels = noise(kSize, 1);
  const auto programs = cache();
  const auto ring = renderer(3);
  for (int round = 0; round < 2; ++round) {
    RenderRequest bad = request(*programs, graph(2), pixels);
    bad.inputs["source"].read_row = [](int, float*) { throw std::bad_alloc(); };
    ASSERT_TRUE(ring->submit(request(*programs, graph(1), pixels)));
    ASSERT_TRUE(ring->submit(std::move(bad)));
    ASSERT_TRUE(ring->submit(request(*programs, graph(3), pixels)));
    HostResult out;
    ASSERT_TRUE(ring->collect(out));
    EXPECT_FLOAT_EQ(out.pixels[0], pixels[0]);
    const auto failed = ring->collect(out);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().message, "out of memory");
    ASSERT_TRUE(ring->collect(out));
    EXPECT_FLOAT_EQ(out.pixels[0], 3 * pixels[0]);
  }
}

/// A look at the surroundings, two kernels of which the first keeps its image; what an earlier frame handed on.
Graph surroundings(Size size, double gain) {
  GraphBuilder builder(size);
  const ImageId half = builder.sample("half", "test/half", {(size.width + 1) / 2, (size.height + 1) / 2},
                                      {{"image", builder.source()}}, {{"gain", number(gain)}});
  return builder.finish(builder.sample("sum", "test/sum", size, {{"image", builder.source()}, {"small", half}},
                                       {{"gain", number(gain)}}));
}

/// Drawn before the first frame or between frames, over images that are kept or not, in one's own memory or over
/// staging: the frames are as without.
TEST_F(RendererTest, WarmingUpChangesNoFrame) {
  shader("test/half",
         "uniform sampler2D image;\nuniform float gain;\n"
         "vec4 sample_at(ivec2 pixel) { return fetch(image, 2 * pixel) * gain; }\n");
  shader("test/sum",
         "uniform sampler2D image;\nuniform sampler2D small;\nuniform float gain;\n"
         "vec4 sample_at(ivec2 pixel) { return fetch(image, pixel) + gain * fetch(small, pixel / 2); }\n");
  const std::vector<float> pictures[] = {noise(kSize, 1), noise(kSize, 2)};
  for (const bool keep : {false, true})
    for (const int frames : {0, 1, 2}) {  // 0: direct
      const auto warmed = cache({.keep_images = keep});
      const auto own = std::make_shared<SharedKernels>(std::filesystem::path());  // and images
      const auto plain = std::make_unique<ProgramCache>(device(), own, ProgramCacheOptions{.keep_images = keep});
      const auto ours = renderer(std::max(frames, 1), frames == 0), theirs = renderer(1);
      for (int i = 0; i < 6; ++i) {
        // Two and two frames are alike; what is drawn between them has other settings.
        const auto which = static_cast<std::size_t>(i / 2 % 2);
        RenderRequest one = request(*warmed, surroundings(kSize, i / 2), pictures[which]);
        RenderRequest other = request(*plain, surroundings(kSize, i / 2), pictures[which]);
        one.inputs["source"].content = other.inputs["source"].content = Hash{1, which};
        if (i != 2) {
          ASSERT_TRUE(warmed->prepare(request(*warmed, surroundings(kSize, 7), pictures[which]).work, *library_));
          const auto program = ours->warm_up(*warmed, *library_);
          ASSERT_TRUE(program) << program.error().text();
          EXPECT_EQ(*program, device().is_cpu() ? warmed->program() : nullptr);
        }
        HostResult got, wanted;
        const auto ran = ours->render(std::move(one), got);
        ASSERT_TRUE(ran) << ran.error().text();
        ASSERT_TRUE(theirs->render(std::move(other), wanted));
        EXPECT_EQ(got.pixels, wanted.pixels) << "frame " << i << ", kept: " << keep << ", " << frames;
      }
    }
}

/// The program for opaque pictures is there before the first of them is.
TEST_F(RendererTest, OpaquePicturesAreWarmedUpFor) {
  const auto programs = cache();
  const auto ring = renderer(1, true);
  Graph straight = graph(2);
  straight.passes.front().straight = true;
  std::vector<float> pixels = noise(kSize, 1);
  for (std::size_t i = 3; i < pixels.size(); i += 4) pixels[i] = 1;
  RenderRequest one = request(*programs, straight, pixels);
  ASSERT_TRUE(programs->prepare(one.work, *library_));
  EXPECT_EQ(programs->programs(), 1);
  const auto usual = ring->warm_up(*programs, *library_);
  ASSERT_TRUE(usual) << usual.error().text();
  if (!device().is_cpu()) return;
  ASSERT_NE(*usual, nullptr);
  EXPECT_NE(*usual, programs->program());
  EXPECT_EQ(programs->programs(), 2);
  HostResult out;
  const auto ran = ring->render(std::move(one), out);
  ASSERT_TRUE(ran) << ran.error().text();
  EXPECT_EQ(ran->program, (*usual)->id());
  EXPECT_EQ(programs->programs(), 2);
  EXPECT_FLOAT_EQ(out.pixels[0], 2 * pixels[0]);
}

/// The same picture and values again and again: no frame is the result of another slot's.
TEST_F(RendererTest, ASlotsOldResultIsNotTakenForTheNewOne) {
  const auto programs = cache({.keep_images = true});
  const auto ring = renderer(2);
  const auto pixels = noise(kSize, 1);
  HostResult out;
  int shown = 0;
  const auto collect = [&](float gain) {
    ASSERT_TRUE(ring->collect(out));
    EXPECT_FLOAT_EQ(out.pixels[0], pixels[0] * gain) << shown;
    ++shown;
  };
  const float gains[] = {2, 3, 3, 3, 2, 2, 3};
  for (int i = 0; i < 7; ++i) {
    if (ring->in_flight() == 2) collect(gains[shown]);
    RenderRequest one = request(*programs, graph(gains[i]), pixels);
    one.inputs["source"].content = Hash{1, 1};
    ASSERT_TRUE(ring->submit(std::move(one)));
  }
  while (ring->in_flight() > 0) collect(gains[shown]);
}

TEST_F(RendererTest, WhatRunsNothingIsItsSourceAndKeepsItsPlace) {
  const auto programs = cache();
  const auto ring = renderer(2);
  const auto first = noise(kSize, 1), second = noise(kSize, 2);
  GraphBuilder nothing(kSize);
  ASSERT_TRUE(ring->submit(request(*programs, graph(2), first)));
  ASSERT_TRUE(ring->submit(request(*programs, nothing.finish(nothing.source()), second)));
  HostResult out;
  const auto ran = ring->collect(out);
  ASSERT_TRUE(ran);
  EXPECT_NE(ran->program, 0u);
  EXPECT_EQ(ran->kernels, std::vector<std::string>{"gain"});
  EXPECT_FLOAT_EQ(out.pixels[0], 2 * first[0]);
  const auto left = ring->collect(out);
  ASSERT_TRUE(left);
  EXPECT_EQ(left->program, 0u);
  EXPECT_EQ(out.pixels, second);
}

TEST_F(RendererTest, TooManyAndTooFewAreTold) {
  const auto programs = cache();
  const auto ring = renderer(1);
  const auto pixels = noise(kSize, 1);
  HostResult out;
  EXPECT_EQ(ring->collect(out).error().message, "no frame is in flight");
  ASSERT_TRUE(ring->submit(request(*programs, graph(2), pixels)));
  const auto second = ring->submit(request(*programs, graph(2), pixels));
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().message, "the frame before has to be collected first");
  EXPECT_TRUE(ring->collect(out)) << "the first one is as it was";
}

/// What only the device finds out is told of the frame that it is about, not of the one that is submitted meanwhile.
TEST_F(RendererTest, AFrameThatFailsOnTheDeviceIsTheOneThatIsTold) {
  shader("test/until",
         "vec4 apply(vec4 color) { float sum = 0.0;\n  while (!(sum >= 8.0)) sum += color.r;\n"
         "  return vec4(sum); }\n");
  GraphBuilder builder(kSize);
  const Graph until = builder.finish(builder.pixel("until", "test/until", builder.source()));
  const std::vector<float> ends(noise(kSize, 1).size(), 0.5f), runs_away(ends.size(), 0.0f);
  const auto programs = cache();
  const auto ring = renderer(2);
  HostResult out;
  ASSERT_TRUE(ring->submit(request(*programs, until, runs_away)));
  ASSERT_TRUE(ring->submit(request(*programs, until, ends)));
  const auto first = ring->collect(out);
  ASSERT_FALSE(first);
  EXPECT_NE(first.error().message.find("a loop did not end"), std::string::npos) << first.error().text();
  ASSERT_TRUE(ring->submit(request(*programs, until, ends)));
  for (int i = 0; i < 2; ++i) {
    const auto next = ring->collect(out);
    ASSERT_TRUE(next) << next.error().text();
    EXPECT_EQ(out.pixels[0], 8);
  }
}

/// A frame that fails leaves the ones before it and those after it alone.
TEST_F(RendererTest, AFrameThatFailsIsNotInFlight) {
  const auto programs = cache();
  const auto ring = renderer(2);
  const auto pixels = noise(kSize, 1);
  ASSERT_TRUE(ring->submit(request(*programs, graph(2), pixels)));
  RenderRequest wrong = request(*programs, graph(3), pixels);
  wrong.inputs["source"].size = {3, 3};
  EXPECT_FALSE(ring->submit(std::move(wrong)));
  ASSERT_TRUE(ring->submit(request(*programs, graph(5), pixels)));
  HostResult out;
  ASSERT_TRUE(ring->collect(out));
  EXPECT_FLOAT_EQ(out.pixels[0], 2 * pixels[0]);
  ASSERT_TRUE(ring->collect(out));
  EXPECT_FLOAT_EQ(out.pixels[0], 5 * pixels[0]);
}

}  // namespace
}  // namespace afterglow
