// SPDX-License-Identifier: MIT
// Presets whose passes come and go with the frame, built beside the drawing thread; kernels timed one by one; kernels
// drawn with before they are needed.
#include <fmt/format.h>

#include "exec/cpu/warm_up.h"
#include "live_fixture.h"

namespace afterglow {
namespace {

/// In frame n the picture is doubled n times, each by a pass of its own; then a tint that looks back, if it is asked
/// to.
class LiveFrames : public LiveTest {
 protected:
  void SetUp() override {
    LiveTest::SetUp();
    effect_of_frames();
    write(
        "shaders/t/double.glsl",
        "uniform sampler2D source;\nuniform float gain;\nvec4 sample_at(ivec2 p) { return vec4(fetch(source, p).rgb * "
        "gain, 1); }\n");
    write("shaders/t/mix.glsl",
          "uniform sampler2D source;\nuniform sampler2D before;\nvec4 sample_at(ivec2 p) { return vec4(fetch(source, "
          "p).rgb + 0.5 * fetch(before, p).rgb, 1); }\n");
    LiveOptions options;
    options.follow = false;
    options.stack.spare_programs = 3;
    options.warm_up = true;
    live_options_ = options;
  }
  void effect_of_frames(bool history = false) {
    write("effects/t.lua", R"(local fx = require "afterglow"
return fx.effect {
  name = "t", at = "post_process", settings = { gain = fx.float { default = 2 } },
  build = function(g, s, source)
    local at = source
    for i = 1, g.frame do at = g:pass { shader = "t/double", source = at, gain = s.gain, name = "double" .. i } end
    return g:pass { shader = "t/double", source = at, gain = 1, name = "last" }
  end,
})");
    if (!history) return;
    write("effects/trail.lua", R"(local fx = require "afterglow"
return fx.effect {
  name = "trail", at = "post_process", order = 500, settings = {},
  build = function(g, s, source)
    local before = g:history { name = "before", size = source }
    local now = g:pass { shader = "t/mix", source = source, before = before, name = "mix" }
    g:keep(before, now)
    return g:pass { shader = "t/double", source = now, gain = 1, name = "end" }
  end,
})");
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.t { gain = 2 }, fx.trail {} }\n");
  }
  /// The red of all pixels; the picture's is 0.5.
  float frame(int number) {
    BuildContext context;
    context.frame = number;
    static const Picture kPicture = picture();
    const auto done = session_->process(kPicture, context);
    EXPECT_TRUE(done) << done.error().text();
    HostResult out;
    EXPECT_TRUE(session_->read_result(out));
    return out.pixels.empty() ? -1 : out.pixels[0];
  }
  LiveOptions live_options_;
};

TEST_F(LiveFrames, AnotherStructureIsBuiltBesideAndThenKept) {
  open(live_options_);
  EXPECT_EQ(frame(1), 1.f);
  session_->build_aside(true);
  EXPECT_EQ(frame(2), 1.f) << "the frame before stays";
  EXPECT_TRUE(session_->waits());
  live().settle();
  EXPECT_EQ(frame(2), 2.f);
  EXPECT_FALSE(session_->waits());
  EXPECT_EQ(live().counters().for_frames, 1u);
  EXPECT_EQ(live().status().times.kind, BuildTimes::Kind::frame);
  const auto builds = live().counters().builds;
  for (int turn = 0; turn < 3; ++turn) {
    EXPECT_EQ(frame(1), 1.f);
    EXPECT_FALSE(session_->waits());
    EXPECT_EQ(frame(2), 2.f);
    EXPECT_FALSE(session_->waits());
  }
  live().settle();
  EXPECT_EQ(live().counters().builds, builds) << "both are there";
}

TEST_F(LiveFrames, WhereEveryFrameCountsItIsBuiltAtOnce) {
  open(live_options_);
  for (int n = 0; n < 5; ++n) {
    EXPECT_EQ(frame(n), 0.5f * static_cast<float>(1 << n));
    EXPECT_FALSE(session_->waits());
  }
  EXPECT_EQ(live().counters().for_frames, 0u);
}

TEST_F(LiveFrames, StructuresThatMoveFasterThanBuildsAreSeenAllTheSame) {
  open(live_options_);
  EXPECT_EQ(frame(0), 0.5f);
  live().settle();  // a build that is under way still would not count as late
  session_->build_aside(true);
  for (int n = 1; n <= 3; ++n) {
    EXPECT_EQ(frame(n), 0.5f) << n;
    EXPECT_TRUE(session_->waits());
    live().settle();
  }
  EXPECT_EQ(frame(4), 8.f);
  EXPECT_FALSE(session_->waits());
}

TEST_F(LiveFrames, EditsReachSparePrograms) {
  open(live_options_);
  EXPECT_EQ(frame(1), 1.f);
  EXPECT_EQ(frame(2), 2.f);
  save(3);  // a value
  live().settle();
  EXPECT_EQ(frame(2), 4.5f);
  EXPECT_EQ(frame(1), 1.5f);
  write("shaders/t/double.glsl",
        "uniform sampler2D source;\nuniform float gain;\nvec4 sample_at(ivec2 p) { return vec4(fetch(source, p).rgb * "
        "gain + 1.0, 1); }\n");
  live().settle();
  EXPECT_EQ(frame(1), 3.5f);  // (0.5 · 3 + 1) + 1
  EXPECT_EQ(frame(2), 9.5f);  // ((0.5 · 3 + 1) · 3 + 1) + 1
  EXPECT_EQ(frame(1), 3.5f);
}

TEST_F(LiveFrames, HistoriesGoOnOverStructures) {
  effect_of_frames(true);
  open(live_options_);
  float before = 0;
  for (int n = 0; n < 4; ++n) {
    before = 0.5f * static_cast<float>(1 << n) + 0.5f * before;
    EXPECT_EQ(frame(n), before) << n;
  }
}

TEST_F(LiveFrames, KernelsAreTimedOneByOneAndNoPixelChanges) {
  for (const bool history : {false, true}) {
    effect_of_frames(history);
    open(live_options_);
    EXPECT_EQ(*session_->time_a_kernel(), false) << "nothing ran yet";
    frame(0);
    const float shown = frame(3);
    EXPECT_FALSE(session_->all_timed());
    while (!session_->all_timed()) ASSERT_TRUE(*session_->time_a_kernel());
    const auto times = session_->kernel_times();
    ASSERT_EQ(times.size(), history ? 6u : 4u);
    EXPECT_EQ(times[0].name, "t.double1");
    for (const auto& time : times) EXPECT_GT(time.milliseconds, 0);
    HostResult out;
    ASSERT_TRUE(session_->read_result(out));
    EXPECT_EQ(out.pixels[0], shown);
    EXPECT_EQ(frame(3), shown);
    EXPECT_EQ(session_->times().kernels_run, 0);
  }
}

TEST_F(LiveFrames, NewKernelsAreDrawnWithBeforeTheyAreTaken) {
  open(live_options_);
  EXPECT_EQ(frame(1), 1.f);
  EXPECT_EQ(live().status().times.warm_up, 0) << "the first frame is waited for anyway";
  write("shaders/t/double.glsl",
        "uniform sampler2D source;\nuniform float gain;\nvec4 sample_at(ivec2 p) { return vec4(fetch(source, p).rgb * "
        "gain + 0.25, 1); }\n");
  live().settle();
  EXPECT_EQ(frame(1), 1.5f);
  EXPECT_EQ(live().status().times.warm_up > 0, WarmUp::helps(*device_));
}

/// Every kind of image that a kernel reads and draws, under validation.
TEST_F(LiveFrames, WarmingUpIsCleanVulkan) {
  effect_of_frames(true);
  auto warm_up = WarmUp::create(*device_, true);
  ASSERT_TRUE(warm_up) << warm_up.error().text();
  for (const ExecutionConfig choice : {ExecutionConfig{}, ExecutionConfig{.storage = Storage::fp16},
                                       ExecutionConfig{.storage_reads = true, .rows = 4}}) {
    StackOptions options;
    options.choice = choice;
    auto stack = Stack::load(folder_ / "look.lua", options, diagnostics_);
    ASSERT_TRUE(stack) << stack.error().text();
    (*stack)->use(*device_, true);
    BuildContext context;
    context.size = {1024, 640};
    context.frame = 2;
    ASSERT_TRUE((*stack)->prepare(context));
    const ProgramCache& programs = *(*stack)->programs();
    KernelCompiler compiler({});
    for (int times = 0; times < 2; ++times) {
      const auto drawn =
          (*warm_up)->draw((*stack)->shaders(), compiler, programs.work()->graph, programs.program_options());
      EXPECT_TRUE(drawn) << drawn.error().text();
    }
  }
  EXPECT_EQ((*warm_up)->validation_errors(), 0);
}

}  // namespace
}  // namespace afterglow
