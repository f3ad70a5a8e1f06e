// SPDX-License-Identifier: MIT
// Stack and Session on the real device with presets and effects written to a folder of the test's own.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "image/encode.h"
#include "session/session.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;

class SessionTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "effects");
    fs::create_directories(folder_ / "shaders" / "gain");
    write("effects/gain.lua", R"(
      local fx = require "afterglow"
      return fx.effect {
        name = "gain", doc = "Multiplies.", at = "post_process", order = 10,
        settings = { amount = fx.float { default = 1, min = 0, max = 1e6, doc = "Factor." } },
        active = function(s) return s.amount ~= 1, "amount is 1" end,
        build = function(g, s, source) return g:pass { shader = "gain/gain", source = source, amount = s.amount } end,
      })");
    write("effects/fog.lua", R"(
      local fx = require "afterglow"
      return fx.effect {
        name = "fog", doc = "Shows depth.", at = "before_post_process", order = 0, needs = { "depth" }, settings = {},
        build = function(g, s, source)
          return g:pass { shader = "gain/fog", source = source, depth = g:input("depth") }
        end,
      })");
    write("shaders/gain/gain.glsl", "uniform float amount;\nvec4 apply(vec4 color) { return color * amount; }\n");
    write("shaders/gain/fog.glsl",
          "uniform sampler2D source;\nuniform sampler2D depth;\n"
          "vec4 sample_at(ivec2 pixel) { return vec4(fetch(source, pixel).rgb, 1) + vec4(vec3(fetch(depth, pixel).r), "
          "0); }\n");
    preset("fx.gain { amount = 2 }");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  void preset(const std::string& entries) {
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { " + entries + " }\n");
  }
  Result<std::unique_ptr<Session>> open(SessionOptions options = {}) {
    options.device.validate = true;
    return Session::open(folder_ / "look.lua", options, diagnostics_);
  }
  static Picture picture(int width, int height) {
    Picture p;
    p.color = Image(width, height, 4);
    for (std::size_t i = 0; i < p.color.pixels.size(); ++i) p.color.pixels[i] = static_cast<float>(i % 97) / 32.f;
    return p;
  }

  fs::path folder_ = fs::temp_directory_path() / ("afterglow_session_" + std::to_string(getpid()));
  Diagnostics diagnostics_;
};

TEST_F(SessionTest, RunsTheStackAndKeepsAlpha) {
  auto session = open();
  ASSERT_TRUE(session) << session.error().text();
  Picture p = picture(13, 7);
  const Picture before = p;
  ASSERT_TRUE((*session)->process(p));
  for (std::size_t i = 0; i < p.color.pixels.size(); ++i)
    EXPECT_FLOAT_EQ(p.color.pixels[i], before.color.pixels[i] * (i % 4 == 3 ? 1 : 2)) << i;
  EXPECT_EQ((*session)->report().kernels, std::vector<std::string>{"gain.gain"});
  EXPECT_EQ((*session)->device().validation_errors(), 0);
}

/// The codes that the writer makes of a picture of linear light, by its own way.
std::vector<std::uint8_t> written_codes(const Picture& picture, const DisplayEncoding& encoding) {
  const int width = picture.color.width, height = picture.color.height;
  std::vector<std::uint8_t> out;
  for (int y = 0; y < height; ++y) {
    std::vector<std::uint8_t> row(static_cast<std::size_t>(width) * 4);
    encode_row({255, true, encoding.dither}, picture.color.at(0, y), width, 0, y, row.data());
    out.insert(out.end(), row.begin(), row.end());
  }
  return out;
}

TEST_F(SessionTest, DisplayCodesAreThoseOfTheWriter) {
  SessionOptions options;
  for (const bool reference : {false, true})
    for (const bool straight : {false, true})
      for (const bool dither : {false, true})
        for (const Size size : {Size{13, 7}, Size{1031, 517}}) {  // the larger one is made several rows at a time
          SCOPED_TRACE(testing::Message() << straight << dither << reference << " " << size.width);
          preset("fx.gain { amount = 0.4 }");
          options.stack.reference = reference;
          options.stack.max_error = 1e-5;  // full floats on every device
          auto session = open(options);
          ASSERT_TRUE(session) << session.error().text();
          Picture p = picture(size.width, size.height);
          for (std::size_t i = 3; i < p.color.pixels.size(); i += 4)
            p.color.pixels[i] = straight ? static_cast<float>(i % 5) / 4 : 1.0f;
          Picture light = p;
          const DisplayEncoding encoding{straight, dither};
          ASSERT_TRUE((*session)->process(light));
          ASSERT_TRUE((*session)->process(p, {}, encoding));
          EXPECT_EQ((*session)->device().validation_errors(), 0);
          if (reference) {
            EXPECT_TRUE(p.unorm8.empty()) << "the slow truth is encoded in double precision";
            EXPECT_EQ(p.color.pixels, light.color.pixels);
            continue;
          }
          const auto expected = written_codes(light, encoding);
          ASSERT_EQ(p.unorm8.size(), expected.size());
          std::size_t different = 0;
          for (std::size_t i = 0; i < expected.size(); ++i) {
            different += p.unorm8[i] != expected[i];
            ASSERT_LE(std::abs(p.unorm8[i] - expected[i]), 1) << i;
          }
          EXPECT_LE(different, expected.size() / 300 + 1);  // within 0.0004 of the border between two codes
          EXPECT_EQ((*session)->report().kernels, std::vector<std::string>{"gain.gain+output.display"});
        }
}

/// A picture that came as half floats gives the bits that the same light in floats gives; it stays so only where it is
/// not replaced.
TEST_F(SessionTest, HalvesAreTheirLight) {
  for (const bool runs : {true, false})
    for (const bool codes : {true, false}) {
      SCOPED_TRACE(testing::Message() << runs << codes);
      preset(runs ? "fx.gain { amount = 0.4 }" : "fx.gain { amount = 1 }");
      auto session = open();
      ASSERT_TRUE(session) << session.error().text();
      Picture floats = picture(301, 17), halves = floats;
      for (std::size_t i = 3; i < floats.color.pixels.size(); i += 4) floats.color.pixels[i] = (i % 20 == 3) ? 0 : 1;
      halves.halves.resize(floats.color.pixels.size());
      to_half(floats.color.pixels.data(), halves.halves.data(), halves.halves.size());
      halves.color.pixels.clear();
      const std::optional<DisplayEncoding> encoding =
          codes ? std::optional(DisplayEncoding{false, true}) : std::nullopt;
      const bool flagged = [&] {
        EXPECT_TRUE((*session)->process(floats, {}, encoding));
        return (*session)->report().flagged;
      }();
      ASSERT_TRUE((*session)->process(halves, {}, encoding));
      EXPECT_EQ(halves.unorm8, floats.unorm8);
      EXPECT_EQ((*session)->report().flagged, flagged);
      EXPECT_EQ(halves.halves.empty(), runs && !codes);
      open_color(halves);
      EXPECT_EQ(halves.color.pixels, floats.color.pixels);
      EXPECT_EQ((*session)->device().validation_errors(), 0);
    }
}

TEST_F(SessionTest, NothingToDoLeavesThePictureAndSaysWhy) {
  preset("fx.gain { amount = 1 }");
  auto session = open();
  ASSERT_TRUE(session) << session.error().text();
  Picture p = picture(4, 4);
  const auto before = p.color.pixels;
  ASSERT_TRUE((*session)->process(p));
  EXPECT_EQ(p.color.pixels, before);
  const auto report = (*session)->report();
  EXPECT_TRUE(report.kernels.empty());
  ASSERT_EQ(report.skipped.size(), 1u);
  EXPECT_EQ(report.skipped[0].name, "gain");
  EXPECT_EQ(report.skipped[0].reason, "amount is 1");
}

TEST_F(SessionTest, FramesOfTheSameSizeMakeNothingNew) {
  auto session = open();
  ASSERT_TRUE(session) << session.error().text();
  Picture first = picture(16, 16);
  ASSERT_TRUE((*session)->process(first));
  const Program* program = (*session)->stack().program();
  const auto before = program->counters();
  for (int i = 0; i < 3; ++i) {
    Picture next = picture(16, 16);
    ASSERT_TRUE((*session)->process(next));
    EXPECT_EQ(next.color.pixels, first.color.pixels);
  }
  EXPECT_EQ((*session)->stack().program(), program);
  EXPECT_EQ(program->counters().pipelines, before.pipelines);
  EXPECT_EQ(program->counters().allocations, before.allocations);
}

TEST_F(SessionTest, SizesMayChangeBetweenFrames) {
  auto session = open();
  ASSERT_TRUE(session) << session.error().text();
  for (const Size size : {Size{8, 8}, Size{1, 1}, Size{31, 5}, Size{8, 8}}) {
    Picture p = picture(size.width, size.height);
    const float before = p.color.pixels[1];
    ASSERT_TRUE((*session)->process(p));
    EXPECT_FLOAT_EQ(p.color.pixels[1], 2 * before);
  }
  EXPECT_EQ((*session)->device().validation_errors(), 0);
}

TEST_F(SessionTest, AuxiliaryInputsReachTheShaders) {
  preset("fx.fog {}");
  auto session = open();
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ((*session)->preset().needs(), std::vector<std::string>{"depth"});
  Picture p = picture(5, 3);
  const auto before = p.color.pixels;
  p.auxiliary["depth"] = Image(5, 3, 1);
  p.auxiliary["depth"].pixels.assign(15, 1e4f);
  ASSERT_TRUE((*session)->process(p));
  EXPECT_FLOAT_EQ(p.color.pixels[4], before[4] + 1e4f);

  Picture without = picture(5, 3);
  ASSERT_TRUE((*session)->process(without));
  EXPECT_EQ(without.color.pixels, before);
  EXPECT_EQ((*session)->report().skipped.at(0).reason, "no depth input");
}

TEST_F(SessionTest, HalfStorageStaysWithinItsTolerance) {
  SessionOptions options;
  options.stack.precision = Precision::fp16;
  auto session = open(options);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ((*session)->report().choice.execution.storage, Storage::fp16);
  Picture p = picture(9, 9);
  const auto before = p.color.pixels;
  ASSERT_TRUE((*session)->process(p));
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_NEAR(p.color.pixels[i], before[i] * (i % 4 == 3 ? 1 : 2), 2e-3 * (2 * before[i] + 0.01));
}

TEST_F(SessionTest, SmallErrorsMeanFullFloats) {
  SessionOptions options;
  options.stack.max_error = 1e-4;
  auto session = open(options);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ((*session)->report().choice.execution.storage, Storage::fp32);
  EXPECT_FALSE((*session)->report().choice.execution.hardware_filter);
}

TEST_F(SessionTest, MemoryIsForeseenWithoutADevice) {
  auto stack = Stack::load(folder_ / "look.lua", {}, diagnostics_);
  ASSERT_TRUE(stack) << stack.error().text();
  const auto build = (*stack)->evaluate({.size = {16384, 16384}, .auxiliary = {}});
  ASSERT_TRUE(build) << build.error().text();
  EXPECT_EQ((*stack)->memory_needed(**build), 2ull * 16384 * 16384 * 16);  // source and result
}

TEST_F(SessionTest, ShaderErrorsNameTheAuthorsFileAndLine) {
  write("shaders/gain/gain.glsl", "uniform float amount;\nvec4 apply(vec4 color) {\n  return colour * amount;\n}\n");
  auto session = open();
  ASSERT_TRUE(session) << session.error().text();
  Picture p = picture(4, 4);
  const auto result = (*session)->process(p);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::script);
  EXPECT_EQ(result.error().file, (folder_ / "shaders/gain/gain.glsl").string());
  EXPECT_EQ(result.error().line, 3);
}

TEST_F(SessionTest, AnUnknownDeviceIsADeviceError) {
  SessionOptions options;
  options.device.device = "no such card";
  const auto session = Session::open(folder_ / "look.lua", options, diagnostics_);
  ASSERT_FALSE(session);
  EXPECT_EQ(session.error().kind, ErrorKind::device);
}

/// Planning, preparing, running, tracing and reporting a frame look at one value.
TEST_F(SessionTest, ScriptsRunOnceAFrame) {
  preset("fx.gain { amount = function(t) return 1 + t.frame end }");
  auto opened = open();
  ASSERT_TRUE(opened) << opened.error().text();
  Session& session = **opened;
  const std::uint64_t before = session.report().counters.evaluations;
  for (int frame = 1; frame <= 3; ++frame) {
    BuildContext context{.size = {13, 7}};
    context.frame = frame;
    const auto build = session.evaluate(context);
    ASSERT_TRUE(build) << build.error().text();
    EXPECT_GT(session.stack().memory_needed(**build), 0u);
    ASSERT_TRUE(session.prepare({.build = *build}));
    Picture p = picture(13, 7);
    const float source = p.color.pixels[4];
    ASSERT_TRUE(session.trace(p, {.build = *build}, NanPolicy::fail));
    ASSERT_TRUE(session.process(p, FrameRequest{.build = *build}));
    EXPECT_FLOAT_EQ(p.color.pixels[4], source * static_cast<float>(1 + frame));
    EXPECT_EQ(session.stack().build(), *build);
    EXPECT_EQ(session.report().counters.evaluations, before + static_cast<std::uint64_t>(frame));
  }
}

/// What is asked for a later frame changes nothing of the one that runs.
TEST_F(SessionTest, ALaterFrameMayBeEvaluatedFirst) {
  preset("fx.gain { amount = function(t) return t.frame end }");
  auto opened = open();
  ASSERT_TRUE(opened) << opened.error().text();
  Session& session = **opened;
  const auto at = [&](double frame) {
    BuildContext context{.size = {13, 7}};
    context.frame = frame;
    return session.evaluate(context).value();
  };
  const auto second = at(2), third = at(3);
  Picture p = picture(13, 7);
  const float source = p.color.pixels[4];
  ASSERT_TRUE(session.process(p, FrameRequest{.build = second}));
  EXPECT_FLOAT_EQ(p.color.pixels[4], source * 2);
  EXPECT_EQ(session.stack().build()->entries->at(0).settings.at(0).second.text(), "2");
}

/// Over staging buffers, as on a device with its own memory, with three frames in flight: the same bits.
TEST_F(SessionTest, FramesInFlightAreThoseOfOneAtATime) {
  preset("fx.gain { amount = function(t) return 1 + t.frame end }");
  SessionOptions ahead;
  ahead.direct = false;
  ahead.frames = 3;
  auto ring = open(ahead), one = open();
  ASSERT_TRUE(ring && one);
  Session& session = **ring;
  ASSERT_EQ(session.frames(), 3);
  const auto make = [](int frame) {
    Picture p = picture(13, 7);
    for (auto& value : p.color.pixels) value += static_cast<float>(frame) / 8;
    return p;
  };
  int collected = 0;
  const auto collect = [&] {
    Picture made, expected = make(collected);
    ASSERT_TRUE(session.collect(made));
    BuildContext context;
    context.frame = collected;
    ASSERT_TRUE((*one)->process(expected, context));
    EXPECT_EQ(made.color.pixels, expected.color.pixels) << collected;
    EXPECT_EQ(session.report().kernels.size(), collected == 0 ? 0u : 1u) << "a gain of 1 runs nothing";
    ++collected;
  };
  for (int frame = 0; frame < 12; ++frame) {
    if (session.in_flight() == session.frames()) collect();
    BuildContext context{.size = {13, 7}};
    context.frame = frame;
    const auto build = session.evaluate(context);
    ASSERT_TRUE(build) << build.error().text();
    ASSERT_TRUE(session.submit(make(frame), FrameRequest{.build = *build}));
  }
  Picture alone = make(0);
  EXPECT_FALSE(session.process(alone)) << "others are in flight";
  while (session.in_flight() > 0) collect();
  EXPECT_EQ(collected, 12);
  EXPECT_TRUE(session.process(alone));
  EXPECT_EQ(session.device().validation_errors(), 0);
}

}  // namespace
}  // namespace afterglow
