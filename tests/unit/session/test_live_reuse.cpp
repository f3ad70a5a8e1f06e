// SPDX-License-Identifier: MIT
// What an edit leaves alone while a frame stands still: counted, and bit for bit what a fresh run makes.
#include <fmt/format.h>

#include <random>

#include "live_fixture.h"

namespace afterglow {
namespace {

/// Four kernels in a row, each with a shader and a value of its own; all read the source too. Between the second and
/// the third there may be one more. The last but one may look back.
class LiveReuse : public LiveTest {
 protected:
  static constexpr int kKernels = 4;

  void SetUp() override {
    LiveTest::SetUp();
    for (int k = 0; k <= kKernels; ++k) shader(k, k);
    chain();
    look();
  }
  void shader(int k, int constant) {
    write(fmt::format("shaders/t/c{}.glsl", k),
          fmt::format("uniform sampler2D source;\nuniform sampler2D picture;\nuniform sampler2D before;\n"
                      "uniform float gain;\nvec4 sample_at(ivec2 p) {{\n  return vec4(fetch(source, p).rgb * gain + "
                      "fetch(picture, p).bgr + 0.5 * fetch(before, p).rgb + {}.0, 1);\n}}\n",
                      constant));
  }
  void chain(bool history = false) {
    write("effects/t.lua", fmt::format(R"(local fx = require "afterglow"
return fx.effect {{
  name = "t", at = "post_process",
  settings = {{ g0 = fx.float {{ default = 1 }}, g1 = fx.float {{ default = 1 }}, g2 = fx.float {{ default = 1 }},
               g3 = fx.float {{ default = 1 }}, more = fx.bool {{ default = false }} }},
  build = function(g, s, source)
    local function pass(k, from, before)
      return g:pass {{ shader = "t/c" .. k, source = from, picture = source, before = before or source,
                      gain = k < 4 and s["g" .. k] or 3, name = "c" .. k }}
    end
    local at = pass(1, pass(0, source))
    if s.more then at = pass(4, at) end
    {}
    return pass(3, at)
  end,
}})",
                                       history ? "local before = g:history { name = \"before\", size = source }\n"
                                                 "    at = pass(2, at, before)\n    g:keep(before, at)"
                                               : "at = pass(2, at)"));
  }
  void look() {
    write("look.lua", fmt::format("local fx = require \"afterglow\"\nreturn fx.stack {{\n  fx.t {{ g0 = {}, g1 = {}, "
                                  "g2 = {}, g3 = {}, more = {} }},\n}}\n",
                                  gains_[0], gains_[1], gains_[2], gains_[3], more_));
  }
  static Picture pattern(int seed = 1) {
    Picture p;
    p.color = Image(24, 16, 4);
    for (std::size_t i = 0; i < p.color.pixels.size(); ++i)
      p.color.pixels[i] = static_cast<float>((i * 7 + static_cast<std::size_t>(seed)) % 97) / 32.f;
    note_content(p);
    return p;
  }
  static std::vector<float> pixels(LiveSession& session, double frame = 0, int seed = 1) {
    BuildContext context;
    context.frame = frame;
    const auto done = session.process(pattern(seed), context);
    EXPECT_TRUE(done) << done.error().text();
    HostResult out;
    EXPECT_TRUE(session.read_result(out));
    return out.pixels;
  }
  std::unique_ptr<LiveSession> fresh() {
    LiveOptions options;
    options.follow = false;
    auto session = LiveSession::open(*device_, folder_ / "look.lua", options, diagnostics_);
    EXPECT_TRUE(session) << session.error().text();
    return std::move(*session);
  }
  /// Kernels that ran for what was edited, which must be what a session of its own makes.
  int ran() {
    live().settle();
    const auto here = pixels(*session_);
    EXPECT_FALSE(live().status().error) << live().status().error_text();
    const auto alone = fresh();
    EXPECT_EQ(here, pixels(*alone));
    return session_->times().kernels_run;
  }

  std::array<int, kKernels> gains_{1, 1, 1, 1};
  bool more_ = false;
};

TEST_F(LiveReuse, AShaderEditRunsWhatIsDownstreamAlone) {
  open_unwatched();
  EXPECT_EQ(ran(), 4);
  for (int k = kKernels - 1; k >= 0; --k) {
    shader(k, 10 + k);
    EXPECT_EQ(ran(), kKernels - k) << k;
    EXPECT_EQ(session_->times().kernels_kept, k);
    EXPECT_EQ(live().status().times.kernels_compiled, 1);
  }
  EXPECT_EQ(ran(), 0);
  pixels(*session_, 0, 2);
  EXPECT_EQ(session_->times().kernels_run, 4) << "another picture";
}

TEST_F(LiveReuse, ValuesAndShadersMayChangeTogether) {
  open_unwatched();
  EXPECT_EQ(ran(), 4);
  shader(3, 20);
  gains_[1] = 5;
  look();
  EXPECT_EQ(ran(), 3);
}

TEST_F(LiveReuse, PassesMayComeAndGo) {
  open_unwatched();
  EXPECT_EQ(ran(), 4);
  more_ = true;
  look();
  EXPECT_EQ(ran(), 3);
  EXPECT_EQ(session_->times().kernels_kept, 2);
  more_ = false;
  look();
  EXPECT_EQ(ran(), 2);
}

TEST_F(LiveReuse, WhatIsBrokenBetweenKeepsWhatWasMade) {
  open_unwatched();
  EXPECT_EQ(ran(), 4);
  write("shaders/t/c3.glsl", "vec4 sample_at(ivec2 p) { return missing; }\n");
  live().settle();
  pixels(*session_);
  EXPECT_TRUE(live().status().error);
  EXPECT_EQ(session_->times().kernels_run, 0);
  shader(3, 33);
  EXPECT_EQ(ran(), 1);
}

/// Images that are drawn several rows at a time, as large ones on CPU devices are, and half floats.
TEST_F(LiveReuse, LinearImagesAndHalvesToo) {
  write("effects/t.lua", effect("t"));
  save(2);
  Picture large;
  large.color = Image(1024, 640, 4);
  for (std::size_t i = 0; i < large.color.pixels.size(); ++i)
    large.color.pixels[i] = static_cast<float>(i * 7 % 1021) / 64.f;
  note_content(large);
  for (const ExecutionConfig choice : {ExecutionConfig{.rows = 4}, ExecutionConfig{.storage = Storage::fp16}}) {
    LiveOptions options;
    options.follow = false;
    options.stack.choice = choice;
    const auto pixels_of = [&](LiveSession& session) {
      EXPECT_TRUE(session.process(large));
      HostResult out;
      EXPECT_TRUE(session.read_result(out));
      return out.pixels;
    };
    open(options);
    pixels_of(*session_);
    const Program& program = *live().stack()->program();
    const auto between = program.transient(program.plan().kernels[0].output);
    EXPECT_EQ(between->layout == VK_IMAGE_LAYOUT_GENERAL, choice.rows > 1 && device_->maps_images());
    write("shaders/t/lib.glsl",
          fmt::format("vec3 tinted(vec3 c, float gain) {{ return c * gain + {}.0; }}\n", choice.rows));
    live().settle();
    const auto here = pixels_of(*session_);
    EXPECT_EQ(session_->times().kernels_run, 1);
    EXPECT_EQ(session_->times().kernels_kept, 1);
    open(options);  // anew
    EXPECT_EQ(here, pixels_of(*session_));
  }
}

TEST_F(LiveReuse, ImagesDoNotPileUp) {
  open_unwatched();
  EXPECT_EQ(ran(), 4);
  const auto images = live().counters().images;
  EXPECT_EQ(images, 3u) << "the last kernel makes the result";
  for (int i = 0; i < 20; ++i) {
    shader(i % kKernels, 100 + i);
    EXPECT_EQ(ran(), kKernels - i % kKernels);
  }
  live().settle();  // the last but one is released
  EXPECT_EQ(live().counters().images, images);
}

/// A frame that looks back goes on from the frame before, whatever is edited meanwhile.
TEST_F(LiveReuse, HistoriesGoOn) {
  chain(true);
  open_unwatched();
  const auto other = [&] { return fresh(); };
  for (int frame = 0; frame < 3; ++frame) pixels(*session_, frame, frame);
  shader(3, 50);
  live().settle();
  const auto here = pixels(*session_, 2, 2);
  EXPECT_EQ(session_->times().kernels_run, 2) << "what looks back, and what was edited";
  const auto alone = other();
  std::vector<float> there;
  for (int frame = 0; frame < 3; ++frame) there = pixels(*alone, frame, frame);
  EXPECT_EQ(here, there);
  EXPECT_EQ(pixels(*session_, 3, 3), pixels(*alone, 3, 3));
  EXPECT_EQ(session_->times().kernels_run, 4);
}

TEST_F(LiveReuse, AnyRowOfEdits) {
  open_unwatched();
  EXPECT_EQ(ran(), 4);
  std::mt19937 random(7);
  for (int i = 0; i < 30; ++i) {
    int first = kKernels;
    for (int edits = 1 + static_cast<int>(random() % 2); edits > 0; --edits) {
      const int k = static_cast<int>(random() % kKernels);
      first = std::min(first, k);
      if (random() % 2 == 0) {
        shader(k, 1000 + i * 4 + edits);
      } else {
        ++gains_[static_cast<std::size_t>(k)];
        look();
      }
    }
    EXPECT_EQ(ran(), kKernels - first) << i;
  }
}

}  // namespace
}  // namespace afterglow
