// SPDX-License-Identifier: MIT
// Frames of a sequence, devices that go before their stacks, stacks on several threads.
#include <functional>
#include <limits>
#include <thread>

#include "fixture.h"

namespace afterglow::test {
namespace {

class FrameTest : public ApiTest {
 protected:
  void SetUp() override {
    ApiTest::SetUp();
    // Adds half of what the frame before was.
    write("effects/trail.lua", R"(
      local fx = require "afterglow"
      return fx.effect {
        name = "trail", doc = "Leaves a trail.", at = "post_process", order = 20, settings = {},
        build = function(g, s, source)
          local before = g:history { name = "before", size = source, first = { 0, 0, 0, 0 } }
          local now = g:pass { shader = "gain/trail", source = source, before = before, name = "now" }
          g:keep(before, now)
          return now
        end,
      })");
    write("shaders/gain/trail.glsl",
          "uniform sampler2D source;\nuniform sampler2D before;\n"
          "vec4 sample_at(ivec2 p) { vec4 c = fetch(source, p); return vec4(c.rgb + 0.5 * fetch(before, p).rgb, c.a); "
          "}\n");
  }
};

/// Runs one pixel of 1 as that frame.
float run_frame(afterglow_stack* stack, double number, bool restart = false) {
  float source[4] = {1, 1, 1, 1}, result[4] = {};
  afterglow_frame frame = afterglow_frame_default();
  frame.number = number;
  frame.restart = restart;
  afterglow_run_info info = afterglow_run_info_default();
  info.frame = &frame;
  info.source = {source, 1, 1, 4, AFTERGLOW_FLOAT, 0, 0};
  info.result = {result, 1, 1, 4, AFTERGLOW_FLOAT, 0, 0};
  EXPECT_TRUE(fine(afterglow_stack_run(stack, &info)));
  return result[0];
}

TEST_F(FrameTest, SettingsFollowTheFrame) {
  look("fx.gain { amount = fx.curve { { 1, 2 }, { 3, 6 } } }");
  const StackPtr stack = this->stack();
  EXPECT_FLOAT_EQ(run_frame(stack.get(), 1), 2);
  EXPECT_FLOAT_EQ(run_frame(stack.get(), 3), 6);
  double amount = 0;
  ASSERT_TRUE(fine(afterglow_stack_get_number(stack.get(), str("gain.amount"), &amount)));
  EXPECT_EQ(amount, 6);
}

TEST_F(FrameTest, NumbersThatNoFrameHasAreRefused) {
  const StackPtr stack = this->stack();
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const auto told = [&](const std::function<void(afterglow_frame&)>& change) {
    afterglow_frame frame = afterglow_frame_default();
    change(frame);
    afterglow_shape shape = afterglow_shape_default();
    shape.width = shape.height = 4;
    const ErrorPtr error(afterglow_stack_prepare(stack.get(), &shape, &frame));
    EXPECT_EQ(afterglow_error_get_kind(error.get()), AFTERGLOW_ERROR_USAGE);
    return text_of(error.get());
  };
  EXPECT_EQ(told([&](auto& frame) { frame.number = nan; }),
            "error: afterglow_frame: number is nan; allowed: finite numbers");
  EXPECT_THAT(told([&](auto& frame) { frame.time = -infinite; }), HasSubstr("time is -inf"));
  EXPECT_EQ(told([&](auto& frame) { frame.fps = 0; }),
            "error: afterglow_frame: fps is 0; allowed: finite numbers above 0");
  EXPECT_THAT(told([&](auto& frame) { frame.fps = -24; }), HasSubstr("fps is -24"));
  EXPECT_THAT(told([&](auto& frame) { frame.step = 0; }), HasSubstr("step is 0"));
  EXPECT_THAT(told([&](auto& frame) { frame.step = nan; }), HasSubstr("step is nan"));
  EXPECT_THAT(told([&](auto& frame) { frame.has_position = true, frame.position[2] = nan; }),
              HasSubstr("position is nan"));
}

TEST_F(FrameTest, EffectsLookBackAtTheFrameBefore) {
  look("fx.trail {}");
  const StackPtr stack = this->stack();
  EXPECT_EQ(run_frame(stack.get(), 1), 1);
  EXPECT_EQ(run_frame(stack.get(), 2), 1.5f);
  EXPECT_EQ(run_frame(stack.get(), 3), 1.75f);
  EXPECT_EQ(run_frame(stack.get(), 3), 1.75f);  // the same frame once more
  EXPECT_EQ(run_frame(stack.get(), 9), 1);      // another place in the sequence
  EXPECT_EQ(run_frame(stack.get(), 10), 1.5f);
  EXPECT_EQ(run_frame(stack.get(), 11, true), 1);  // told to begin anew
  afterglow_stack_reset_history(stack.get());
  EXPECT_EQ(run_frame(stack.get(), 12), 1);
}

TEST_F(FrameTest, PassesThatComeAndGoAreMadeOnce) {
  look("fx.trail {}, fx.gain { amount = 2, opacity = function(t) return t.frame % 2 end }");
  const StackPtr stack = this->stack();
  const auto compiled = [&] { return json_of(afterglow_stack_report, stack.get())["milliseconds"]["compile"]; };
  EXPECT_EQ(run_frame(stack.get(), 1), 2);
  EXPECT_EQ(run_frame(stack.get(), 2), 2);
  const auto both = compiled();
  EXPECT_EQ(run_frame(stack.get(), 3), 3) << "what is handed on stays";
  EXPECT_EQ(run_frame(stack.get(), 4), 2.5f);
  EXPECT_EQ(compiled(), both);
}

TEST_F(FrameTest, SizesInTurnAreMadeOnce) {
  look("fx.trail {}, fx.gain { amount = 2 }");
  const StackPtr stack = this->stack();
  double number = 0;
  const auto run = [&](int width) {
    std::vector<float> source(static_cast<std::size_t>(width) * 4, 1), result(source.size());
    afterglow_frame frame = afterglow_frame_default();
    frame.number = ++number;
    afterglow_run_info info = afterglow_run_info_default();
    info.frame = &frame;
    info.source = image(source, width, 1);
    info.result = image(result, width, 1);
    EXPECT_TRUE(fine(afterglow_stack_run(stack.get(), &info)));
    return result[0];
  };
  const auto compiled = [&] { return json_of(afterglow_stack_report, stack.get())["milliseconds"]["compile"]; };
  for (const int width : {3, 5, 8}) EXPECT_EQ(run(width), 2);
  const auto all = compiled();
  for (const int width : {3, 5, 8, 3}) EXPECT_EQ(run(width), 2) << "another size has no frame before it";
  EXPECT_EQ(run(3), 3);
  EXPECT_EQ(compiled(), all);
  EXPECT_EQ(run(4), 2);  // a fourth takes the place of the one that has waited longest
  EXPECT_GT(compiled(), all);
}

TEST_F(FrameTest, FramesGoOnWhereHalfFloatsAreLeftOut) {
  // The device takes half floats, which a frame with a history promises nothing in.
  write("devices.json", R"({ "devices": [ { "kind": "cpu", "choices": [
      { "max_error": 0, "choice": "fused fp32" }, { "max_error": 0.002, "choice": "fused fp16" } ] } ] })");
  look("fx.trail {}, fx.gain { amount = 1 }");
  afterglow_stack_options options = afterglow_stack_options_default();
  const std::string table = file("devices.json");
  options.calibration = str(table);
  const StackPtr stack = this->stack(options);
  EXPECT_EQ(run_frame(stack.get(), 1), 1);
  EXPECT_EQ(run_frame(stack.get(), 2), 1.5f);
  ASSERT_TRUE(fine(afterglow_stack_set_number(stack.get(), str("gain.amount"), 2)));
  EXPECT_EQ(run_frame(stack.get(), 3), 2.75f);
  EXPECT_EQ(json_of(afterglow_stack_report, stack.get())["milliseconds"]["compile"], 0) << "programs are taken over";
  // Executed in another way from here on: its programs are made anew, and go on from the same frames.
  write("look.lua", "local fx = require 'afterglow'\nreturn fx.stack { max_error = 0.001, fx.trail {}, fx.gain {} }");
  ASSERT_TRUE(fine(afterglow_stack_reload(stack.get(), afterglow_str(nullptr))));
  EXPECT_EQ(run_frame(stack.get(), 4), 3.375f);
}

TEST_F(FrameTest, AStackKeepsItsDevice) {
  afterglow_device* device = nullptr;
  ASSERT_TRUE(fine(afterglow_device_open(nullptr, &device)));
  afterglow_stack_options options = afterglow_stack_options_default();
  const std::string look = file("look.lua");
  options.preset_file = str(look);
  afterglow_stack* out = nullptr;
  ASSERT_TRUE(fine(afterglow_stack_create(device, &options, &out)));
  const StackPtr stack(out);
  afterglow_device_free(device);
  EXPECT_FLOAT_EQ(run_frame(stack.get(), 1), 2);
}

TEST_F(FrameTest, StacksRunOnSeveralThreads) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([this, i] {
      const StackPtr stack = this->stack();
      for (int frame = 1; frame <= 3; ++frame) {
        EXPECT_TRUE(fine(afterglow_stack_set_number(stack.get(), str("gain.amount"), i + frame)));
        EXPECT_FLOAT_EQ(run_frame(stack.get(), frame), static_cast<float>(i + frame));
      }
    });
  for (auto& thread : threads) thread.join();
}

TEST_F(FrameTest, KernelsAreTimedWhenAsked) {
  afterglow_stack_options options = afterglow_stack_options_default();
  options.time_kernels = true;
  const StackPtr stack = this->stack(options);
  run_frame(stack.get(), 1);
  const auto times = json_of(afterglow_stack_report, stack.get())["milliseconds"]["kernels"];
  ASSERT_EQ(times.size(), 1u);
  EXPECT_EQ(times[0]["name"], "gain.gain");
}

}  // namespace
}  // namespace afterglow::test
