// SPDX-License-Identifier: MIT
// Images that frames hand on to the next: what follows what, and that nothing else reaches a picture.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "session/session.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;

constexpr int kWidth = 24, kHeight = 16;

// `trail`: its picture is half of the one before and the present one, and is kept; `fresh` begins with 8 · the picture.
// Sums of the values used here are exact in floats, so that every way of execution has to give the same bits.
constexpr const char* kTrail = R"(
local fx = require "afterglow"
return fx.effect {
  name = "trail", at = "post_process", order = 100,
  settings = { keep = fx.float { min = 0, max = 1, default = 0.5, doc = "k" },
               image = fx.bool { default = false, doc = "begin with an image" },
               more = fx.bool { default = false, doc = "another structure" } },
  idle = function(s, source) return s.keep == 0 and { brightest = 1000 } or nil end,
  build = function(g, s, source)
    local bright = g:pass { shader = "t/times", source = source, factor = 8, name = "bright" }
    local before = g:history { name = "before", size = source, first = s.image and bright or { 16, 0, 0, 1 } }
    local now = g:pass { shader = "t/add", source = source, before = before, keep = s.keep,
                         more = s.more, name = "now" }
    g:keep(before, now)
    if s.keep == 0 then return g:pass { shader = "t/times", source = source, factor = 1, name = "same" } end
    return now
  end,
})";
constexpr const char* kOther = R"(
local fx = require "afterglow"
return fx.effect {
  name = "other", at = "post_process", order = 200, settings = { factor = fx.float { default = 1, doc = "f" } },
  active = function(s) return s.factor ~= 1 end,
  build = function(g, s, source)
    return g:pass { shader = "t/times", source = source, factor = s.factor, name = "times" }
  end,
})";
// `sized`: the same sum, kept at one of two sizes.
constexpr const char* kSized = R"(
local fx = require "afterglow"
return fx.effect {
  name = "sized", at = "post_process", order = 100,
  settings = { small = fx.bool { default = false, doc = "keep less" },
               broken = fx.bool { default = false, doc = "with a shader that does not compile" } },
  build = function(g, s, source)
    local size = s.small and { 8, 8 } or source
    local before = g:history { name = "before", size = size, first = { 16, 0, 0, 1 } }
    local now = g:pass { shader = "t/half", source = source, before = before, size = size }
    g:keep(before, now)
    return g:pass { shader = s.broken and "t/broken" or "t/corner", source = source, now = now }
  end,
})";

class HistoriesOfFrames : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "effects");
    fs::create_directories(folder_ / "shaders" / "t");
    write("effects/trail.lua", kTrail);
    write("effects/other.lua", kOther);
    write("effects/sized.lua", kSized);
    write("shaders/t/half.glsl",
          "uniform sampler2D source;\nuniform sampler2D before;\n"
          "vec4 sample_at(ivec2 p) { return fetch(source, p) + 0.5 * fetch(before, p); }\n");
    const std::string corner =
        "uniform sampler2D source;\nuniform sampler2D now;\n"
        "vec4 sample_at(ivec2 p) { return vec4(fetch(now, ivec2(0)).rgb, fetch(source, p).a); }\n";
    write("shaders/t/corner.glsl", corner);
    write("shaders/t/broken.glsl", corner + "float nothing() { return nowhere; }\n");
    write("shaders/t/times.glsl",
          "uniform float factor;\nvec4 apply(vec4 color) { return vec4(color.rgb * factor, color.a); }\n");
    write("shaders/t/add.glsl",
          "uniform sampler2D source;\nuniform sampler2D before;\nuniform float keep;\n"
          "layout(constant_id = 0) const bool more = false;\n"
          "vec4 sample_at(ivec2 p) { vec4 c = fetch(source, p);\n"
          "  return vec4(c.rgb + keep * fetch(before, p).rgb + (more ? 64.0 : 0.0), c.a); }\n");
    look("fx.trail {}");
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  void look(const std::string& entries) {
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { " + entries + " }\n");
  }
  std::unique_ptr<Session> open(const StackOptions& stack = {}) {
    SessionOptions options;
    options.device.validate = true;
    options.stack = stack;
    auto session = Session::open(folder_ / "look.lua", options, diagnostics_);
    EXPECT_TRUE(session) << session.error().text();
    return std::move(*session);
  }
  static Picture picture(float red, bool known = true) {
    Picture p;
    p.color = Image(kWidth, kHeight, 4);
    for (std::size_t i = 0; i < p.color.pixels.size(); i += 4) {
      p.color.pixels[i] = red;
      p.color.pixels[i + 1] = static_cast<float>(i / 4 % kWidth);
      p.color.pixels[i + 3] = 1;
    }
    if (known) note_content(p);
    return p;
  }
  /// The red of all pixels of a frame, which must be the same.
  float run(Session& session, double frame, float red, const BuildContext& more = {},
            const std::optional<Rect>& region = {}) {
    BuildContext context = more;
    context.frame = frame;
    Picture p = picture(red);
    const auto done = session.process(p, context, {}, region);
    EXPECT_TRUE(done) << done.error().text();
    EXPECT_EQ(session.device().validation_errors(), 0) << session.device().validation_messages().front();
    const Rect part = region.value_or(Rect{0, 0, kWidth, kHeight});
    const auto at = [&](int x, int y) { return p.color.pixels[static_cast<std::size_t>(y * kWidth + x) * 4]; };
    for (int y = part.y; y < part.y + part.height; ++y)
      for (int x = part.x; x < part.x + part.width; ++x) EXPECT_EQ(at(x, y), at(part.x, part.y)) << x << ' ' << y;
    return at(part.x, part.y);
  }

  /// The red of a frame that was made just before, as its trace makes it once more.
  static float traced(Session& session, double frame, float red) {
    BuildContext context{.size = {kWidth, kHeight}};
    context.frame = frame;
    auto build = session.evaluate(context);
    EXPECT_TRUE(build);
    const auto trace = session.trace(picture(red), request_for(std::move(*build)), NanPolicy::zero);
    EXPECT_TRUE(trace) << trace.error().text();
    EXPECT_EQ(session.device().validation_errors(), 0) << session.device().validation_messages().front();
    return trace ? trace->result.pixels[0] : -1;
  }

  fs::path folder_ = fs::temp_directory_path() / ("afterglow_histories_" + std::to_string(getpid()));
  Diagnostics diagnostics_;
};

TEST_F(HistoriesOfFrames, AFrameReadsWhatTheOneBeforeItMade) {
  StackOptions plain, kept, reference, half, rows, dispatched, all;
  kept.keep_images = true;
  reference.reference = true;
  half.choice = ExecutionConfig{.storage = Storage::fp16};
  rows.choice = ExecutionConfig{.storage_reads = true, .rows = 4};
  dispatched.choice = ExecutionConfig{.dispatched = true};
  all.choice = ExecutionConfig{.storage = Storage::fp16, .storage_reads = true, .dispatched = true, .rows = 4};
  for (const auto& options : {plain, kept, reference, half, rows, dispatched, all}) {
    const auto session = open(options);
    EXPECT_EQ(run(*session, 1, 1), 9);  // 16 / 2 + 1
    EXPECT_EQ(run(*session, 2, 1), 5.5f) << "the same picture again, in another frame";
    EXPECT_EQ(run(*session, 3, 2), 4.75f);
    EXPECT_EQ(run(*session, 4, 2), 4.375f);
    EXPECT_EQ(run(*session, 5, 2), 4.1875f);
  }
}

/// All four channels of what is read, whatever is kept: those that are not read as 0 and an alpha of 1.
TEST_F(HistoriesOfFrames, FewerChannelsMayBeKept) {
  write("shaders/t/keep.glsl", "vec4 apply(vec4 color) { return vec4(2.0 * color.r, color.r + 1.0, 9.0, 9.0); }\n");
  write("shaders/t/sum.glsl",
        "uniform sampler2D source;\nuniform sampler2D before;\n"
        "vec4 sample_at(ivec2 p) { vec4 c = fetch(source, p), b = fetch(before, p);\n"
        "  return vec4(c.r + dot(b, vec4(2.0, 4.0, 8.0, 16.0)), c.gba); }\n");
  look("fx.few {}");
  StackOptions plain, reference, half, read, four;
  reference.reference = true;
  half.choice = ExecutionConfig{.storage = Storage::fp16};
  read.choice = ExecutionConfig{.storage = Storage::fp16, .storage_reads = true, .rows = 4};
  four.choice = ExecutionConfig{.four_channels = true};
  for (const int channels : {1, 2, 4})
    for (const bool precise : {true, false}) {
      write("effects/few.lua", fmt::format(R"(
local fx = require "afterglow"
return fx.effect {{
  name = "few", at = "post_process", order = 100,
  build = function(g, s, source)
    local before = g:history {{ name = "before", size = source, first = {{ 16, 3, 5, 7 }}, channels = {}, precise = {} }}
    g:keep(before, g:pass {{ shader = "t/keep", source = source, channels = {} }})
    return g:pass {{ shader = "t/sum", source = source, before = before }}
  end,
}})",
                                           channels, precise, channels));
      const float of_first = channels == 1   ? 48
                             : channels == 2 ? 60
                                             : 196,
                  of_two = channels == 1   ? 24
                           : channels == 2 ? 36
                                           : 236;
      for (const auto& options : {plain, reference, half, read, four}) {
        const auto session = open(options);
        EXPECT_EQ(run(*session, 1, 2), 2 + of_first) << channels << ' ' << precise;
        EXPECT_EQ(run(*session, 2, 5), 5 + of_two) << channels << ' ' << precise;
        EXPECT_EQ(traced(*session, 2, 5), 5 + of_two) << channels << ' ' << precise;
        EXPECT_EQ(run(*session, 9, 1), 1 + of_first) << "a seek";
      }
    }
}

TEST_F(HistoriesOfFrames, TheSameFrameOnceMoreIsTheSame) {
  for (const bool keep : {false, true}) {
    StackOptions options;
    options.keep_images = keep;
    const auto session = open(options);
    EXPECT_EQ(run(*session, 1, 1), 9);
    EXPECT_EQ(run(*session, 1, 1), 9);
    EXPECT_EQ(session->report().times.frame.kernels_run, 0) << "and nothing has to run";
    EXPECT_EQ(run(*session, 2, 1), 5.5f);
    EXPECT_EQ(run(*session, 2, 4), 8.5f) << "with another picture: the frame before is the same";
    EXPECT_EQ(run(*session, 2, 4), 8.5f);
    EXPECT_EQ(run(*session, 3, 1), 5.25f) << "what counts is the picture it had last";
  }
}

TEST_F(HistoriesOfFrames, ASeekBeginsAnew) {
  const auto session = open();
  EXPECT_EQ(run(*session, 1, 1), 9);
  EXPECT_EQ(run(*session, 2, 1), 5.5f);
  EXPECT_EQ(run(*session, 4, 1), 9) << "3 is missing";
  EXPECT_EQ(run(*session, 5, 1), 5.5f);
  EXPECT_EQ(run(*session, 4, 1), 9) << "backwards";
  EXPECT_EQ(run(*session, 6, 1, {.step = 2}), 5.5f) << "frames on twos";
  EXPECT_EQ(run(*session, 7, 1, {.restart = true}), 9) << "on demand";
  EXPECT_EQ(run(*session, 8, 1), 5.5f);
  session->stack().reset_histories();
  EXPECT_EQ(run(*session, 9, 1), 9);
}

TEST_F(HistoriesOfFrames, AFirstImageStandsForTheFrameBefore) {
  look("fx.trail { image = true }");
  StackOptions plain, rows, half;
  rows.choice = ExecutionConfig{.storage_reads = true, .rows = 4};
  half.choice = ExecutionConfig{.storage = Storage::fp16, .storage_reads = true};
  for (const auto& options : {plain, rows, half}) {
    const auto session = open(options);
    EXPECT_EQ(run(*session, 1, 1), 5);
    EXPECT_EQ(run(*session, 2, 1), 3.5f);
    EXPECT_EQ(run(*session, 9, 2), 10);
    EXPECT_EQ(run(*session, 10, 2), 7);
  }
}

TEST_F(HistoriesOfFrames, TheyOutliveChangesOfOtherEffectsAndOfValues) {
  look(
      "fx.trail { keep = function(t) return t.frame == 3 and 0.25 or 0.5 end }, "
      "fx.other { factor = function(t) return t.frame == 3 and 2 or 1 end }");
  const auto session = open();
  EXPECT_EQ(run(*session, 1, 1), 9);
  EXPECT_EQ(run(*session, 2, 1), 5.5f);
  EXPECT_EQ(run(*session, 3, 1), 2 * 2.375f);
  EXPECT_EQ(run(*session, 4, 1), 2.1875f);
}

TEST_F(HistoriesOfFrames, TheyBeginAnewWhenTheirOwnPartChanges) {
  look("fx.trail { more = function(t) return t.frame >= 3 end }");
  const auto session = open();
  EXPECT_EQ(run(*session, 1, 1), 9);
  EXPECT_EQ(run(*session, 2, 1), 5.5f);
  EXPECT_EQ(run(*session, 3, 1), 64 + 9);
  EXPECT_EQ(run(*session, 4, 1), 64 + 1 + 73 / 2.0f);
}

TEST_F(HistoriesOfFrames, AnIdleEffectStillHandsOnItsImages) {
  look("fx.trail { keep = 0 }, fx.trail { name = \"second\" }");
  const auto session = open();
  EXPECT_EQ(run(*session, 1, 1), 9);
  EXPECT_EQ(run(*session, 2, 2000), 2004.5f) << "too bright to be idle: another program";
  EXPECT_EQ(run(*session, 3, 1), 1003.25f);
}

/// It does not keep its promise: its source is gone with the history that nothing reads.
TEST_F(HistoriesOfFrames, AnIdleEffectMayLeaveItsSourceUnread) {
  write("effects/blank.lua",
        "local fx = require \"afterglow\"\nreturn fx.effect { name = \"blank\", at = \"post_process\", order = 300,\n"
        "  settings = {}, idle = function(s, source) return { brightest = 1 } end,\n"
        "  build = function(g, s, source) return g:pass { shader = \"t/blank\", size = source } end }\n");
  write("shaders/t/blank.glsl", "vec4 sample_at(ivec2 p) { return vec4(3.0, 2.0, 1.0, 1.0); }\n");
  look("fx.trail {}, fx.blank {}");
  const auto session = open();
  EXPECT_EQ(run(*session, 1, 1), 3);
  EXPECT_EQ(run(*session, 2, 0), 3);
}

TEST_F(HistoriesOfFrames, AnImageThatIsKeptCanBeShown) {
  look("fx.trail {}, fx.other { factor = 4 }");
  const auto session = open();
  session->stack().show("trail.now");
  EXPECT_EQ(run(*session, 1, 1), 9);
  EXPECT_EQ(run(*session, 2, 1), 5.5f);
  session->stack().show("source");
  EXPECT_EQ(run(*session, 3, 1), 1);
  session->stack().show("");
  EXPECT_EQ(run(*session, 4, 1), 4 * (1 + (1 + 5.5f / 2) / 2)) << "histories went on while the source was shown";
}

TEST_F(HistoriesOfFrames, AnImageThatAHistoryIsMadeOfCanBeShown) {
  look("fx.trail { image = true }");
  const auto session = open();
  session->stack().show("trail.bright");
  EXPECT_EQ(run(*session, 1, 1), 8);
  EXPECT_EQ(run(*session, 2, 2), 16);
  session->stack().show("");
  EXPECT_EQ(run(*session, 3, 1), 1 + (2 + (1 + 8 / 2.0f) / 2) / 2);
}

TEST_F(HistoriesOfFrames, ARegionIsTheCropOfTheWhole) {
  const auto session = open();
  const Rect left{2, 3, 4, 5}, right{12, 1, 8, 8};
  EXPECT_EQ(run(*session, 1, 1, {}, left), 9);
  EXPECT_EQ(run(*session, 2, 1, {}, left), 5.5f);
  EXPECT_EQ(run(*session, 3, 2, {}, right), 4.75f) << "what was not shown was kept too";
}

TEST_F(HistoriesOfFrames, AStackThatTakesAnothersPlaceGoesOn) {
  const auto session = open();
  EXPECT_EQ(run(*session, 1, 1), 9);
  EXPECT_EQ(run(*session, 2, 1), 5.5f);
  SessionOptions options;
  const auto made = Stack::load(folder_ / "look.lua", {}, diagnostics_);
  ASSERT_TRUE(made);
  Stack& next = **made;
  next.use(session->device(), true);
  BuildContext context{.size = {kWidth, kHeight}};
  context.frame = 2;
  ASSERT_TRUE(next.prepare(context));
  next.take_over(session->stack(), false);
  context.frame = 3;
  ASSERT_TRUE(next.prepare(context));
  auto renderer = Renderer::create(session->device(), {});
  ASSERT_TRUE(renderer);
  const Picture p = picture(2);
  HostResult out;
  auto request = next.request(request_for(next.build()));
  ASSERT_TRUE(request);
  request->inputs = {{"source", {p.color.pixels.data(), p.color.size(), 4}}};
  ASSERT_TRUE((*renderer)->render(std::move(*request), out));
  EXPECT_EQ(out.pixels[0], 4.75f);
}

/// The picture of the frame before, and nothing else: a delay.
TEST_F(HistoriesOfFrames, WhatTheFrameBeforeMadeMayBeTheResult) {
  write("effects/delay.lua",
        "local fx = require \"afterglow\"\nreturn fx.effect { name = \"delay\", at = \"post_process\", order = 100, "
        "build = function(g, s, source)\n  local before = g:history { first = source }\n  g:keep(before, source)\n"
        "  return before\nend }\n");
  look("fx.delay {}");
  const auto session = open();
  EXPECT_EQ(run(*session, 1, 1), 1);
  EXPECT_EQ(run(*session, 2, 5), 1);
  EXPECT_EQ(run(*session, 3, 7), 5);
  look("fx.delay {}, fx.other { factor = 4 }");
  const auto more = open();
  EXPECT_EQ(run(*more, 1, 1), 4);
  EXPECT_EQ(run(*more, 2, 5), 4);
  // To an effect behind it, what it looks back at is an image of this frame.
  look("fx.delay {}, fx.delay {}");
  const auto two = open();
  const float given[] = {1, 5, 7, 9}, made[] = {1, 1, 1, 5};
  for (int i = 0; i < 4; ++i) EXPECT_EQ(run(*two, i + 1, given[i]), made[i]) << i;
}

/// The numbers of a filter move with time as values do: what it adds up goes on.
TEST_F(HistoriesOfFrames, TheyGoOnWhereFiltersMove) {
  write("effects/drift.lua",
        "local fx = require \"afterglow\"\nreturn fx.effect { name = \"drift\", at = \"post_process\", order = 100, "
        "settings = { by = fx.float { default = 1, doc = \"b\" } }, build = function(g, s, source)\n"
        "  local before = g:history { first = { 16, 0, 0, 1 }, size = source }\n"
        "  local moved = g:filter { source = before, filter = { taps = { { 0, 0, s.by } } } }\n"
        "  local now = g:pass { shader = \"t/add\", source = source, before = moved, keep = 0.5 }\n"
        "  g:keep(before, now)\n  return now\nend }\n");
  look("fx.drift { by = function(t) return t.frame == 3 and 2 or 1 end }");
  const auto session = open();
  EXPECT_EQ(run(*session, 1, 1), 9);
  EXPECT_EQ(run(*session, 2, 1), 5.5f);
  EXPECT_EQ(run(*session, 3, 1), 6.5f);
  EXPECT_EQ(run(*session, 4, 1), 4.25f);
}

/// A trace has a program of its own, which is used for one frame after the other as long as the graph is the same.
TEST_F(HistoriesOfFrames, ATraceReadsThoseOfItsFrame) {
  look("fx.sized { small = function(t) return t.frame == 2 end }");
  StackOptions options;
  options.spare_programs = 3;
  const auto session = open(options);
  for (const auto& [frame, red] : {std::pair(1, 9.0f), {2, 9}, {3, 9}, {4, 5.5f}, {5, 3.75f}}) {
    EXPECT_EQ(run(*session, frame, 1), red) << frame;
    EXPECT_EQ(traced(*session, frame, 1), red) << frame;
  }
}

/// What the frame that failed would have kept is of another size: the images before it are gone.
TEST_F(HistoriesOfFrames, AFrameThatFailsLeavesNothingBehind) {
  look("fx.sized { small = function(t) return t.frame == 3 end, broken = function(t) return t.frame == 3 end }");
  for (const int spare : {0, 3}) {
    StackOptions options;
    options.spare_programs = spare;
    const auto session = open(options);
    EXPECT_EQ(run(*session, 1, 1), 9);
    EXPECT_EQ(run(*session, 2, 1), 5.5f);
    Picture p = picture(1);
    BuildContext context;
    context.frame = 3;
    EXPECT_FALSE(session->process(p, context));
    EXPECT_EQ(run(*session, 4, 1), 9);
    EXPECT_EQ(run(*session, 5, 1), 5.5f);
  }
}

TEST_F(HistoriesOfFrames, WithoutThemAFrameIsTheSameWhateverWasPlayed) {
  look(
      "fx.other { factor = function(t) return t.frame % 5 == 0 and 1 or 1 + t.frame / 8 end }, "
      "fx.bloom { intensity = fx.curve { { 0, 0.1 }, { 24, 0.9 } } }, fx.film_grain {}, fx.tone_mapping {}");
  const auto straight = open(), jumping = open();
  const auto pixels = [](Session& session, int frame) {
    Picture p = picture(static_cast<float>(frame) / 4);
    BuildContext context;
    context.frame = frame;
    context.time = frame / 24.0;
    EXPECT_TRUE(session.process(p, context));
    return p.color.pixels;
  };
  std::vector<std::vector<float>> expected;
  for (int frame = 0; frame < 24; ++frame) expected.push_back(pixels(*straight, frame));
  std::mt19937 random(5);
  for (int i = 0; i < 60; ++i) {
    const int frame = static_cast<int>(random() % 24);
    EXPECT_EQ(pixels(*jumping, frame), expected[static_cast<std::size_t>(frame)]) << "frame " << frame;
  }
}

}  // namespace
}  // namespace afterglow
