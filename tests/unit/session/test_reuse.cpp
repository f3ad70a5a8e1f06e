// SPDX-License-Identifier: MIT
// Frames and kernels that need not run again: counted, and bit for bit what a fresh run makes.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "session/session.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;

class Reuse : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "effects");
    fs::create_directories(folder_ / "shaders" / "t");
    // blur → lift (both kernels of their own) → fog, which reads depth and whose gain follows the number of the frame.
    write("effects/t.lua", R"(
      local fx = require "afterglow"
      return fx.effect {
        name = "t", settings = {},
        build = function(g, s, source)
          local small = g:filter { source = source, size = { 8, 8 }, filter = fx.filters.tent(), name = "small" }
          local large = g:filter { source = small, size = source, filter = fx.filters.bilinear(), name = "large" }
          local depth = g:input("depth")
          return g:pass { shader = "t/fog", source = large, picture = source, depth = depth or source, gain = g.frame, name = "fog" }
        end,
        optional = { "depth" },
      })");
    write("shaders/t/fog.glsl",
          "uniform sampler2D source;\nuniform sampler2D picture;\nuniform sampler2D depth;\nuniform float gain;\n"
          "vec4 sample_at(ivec2 p) { return vec4(fetch(source, p).rgb * gain + fetch(picture, p).bgr + fetch(depth, "
          "p).rrr, 1); }\n");
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.t { } }\n");
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }

  std::unique_ptr<Session> open(bool keep_images) {
    SessionOptions options;
    options.device.validate = true;
    options.stack.keep_images = keep_images;
    auto session = Session::open(folder_ / "look.lua", options, diagnostics_);
    EXPECT_TRUE(session) << session.error().text();
    return std::move(*session);
  }

  struct Frame {
    int color, depth;  ///< seeds
    double gain;
    bool known = true;  ///< the content is
  };
  static Picture picture(const Frame& frame) {
    Picture p;
    p.color = Image(24, 16, 4);
    p.auxiliary["depth"] = Image(24, 16, 1);
    for (std::size_t i = 0; i < p.color.pixels.size(); ++i)
      p.color.pixels[i] = static_cast<float>((i * 7 + static_cast<std::size_t>(frame.color) * 13) % 97) / 32.f;
    for (std::size_t i = 0; i < p.auxiliary["depth"].pixels.size(); ++i)
      p.auxiliary["depth"].pixels[i] = static_cast<float>((i * 3 + static_cast<std::size_t>(frame.depth)) % 31);
    if (frame.known) note_content(p);
    return p;
  }

  /// Kernels that ran in this frame, which must be what a session of its own makes of it.
  int run(Session& session, const Frame& frame) {
    Picture here = picture(frame), alone = picture(frame);
    BuildContext context;
    context.frame = frame.gain;
    EXPECT_TRUE(session.process(here, context));
    EXPECT_TRUE(open(false)->process(alone, context));
    EXPECT_EQ(here.color.pixels, alone.color.pixels);
    EXPECT_EQ(session.device().validation_errors(), 0);
    return session.report().times.frame.kernels_run;
  }

  fs::path folder_ = fs::temp_directory_path() / ("afterglow_reuse_" + std::to_string(getpid()));
  Diagnostics diagnostics_;
};

TEST_F(Reuse, AHeldFrameIsNotRunAgain) {
  const auto session = open(false);
  EXPECT_EQ(run(*session, {1, 1, 1}), 3);
  EXPECT_TRUE(session->report().skipped_now.empty());
  EXPECT_EQ(run(*session, {1, 1, 1}), 0);
  ASSERT_EQ(session->report().skipped_now.size(), 1u);
  EXPECT_EQ(session->report().skipped_now[0].name, "frame");
  EXPECT_EQ(session->report().skipped_now[0].reason, "its picture and settings are those of an earlier frame");
  EXPECT_EQ(run(*session, {2, 1, 1}), 3);
  EXPECT_EQ(run(*session, {1, 1, 1}), 3);  // the one before last is not remembered
}

TEST_F(Reuse, WithoutKnownContentEveryFrameRuns) {
  const auto session = open(false);
  EXPECT_EQ(run(*session, {1, 1, 1, false}), 3);
  EXPECT_EQ(run(*session, {1, 1, 1, false}), 3);
  EXPECT_EQ(run(*session, {1, 1, 1, true}), 3);
  EXPECT_EQ(run(*session, {1, 1, 1, true}), 0);
}

TEST_F(Reuse, ImagesThatShareMemoryRunWhole) {
  const auto session = open(false);
  EXPECT_EQ(run(*session, {1, 1, 1}), 3);
  EXPECT_EQ(run(*session, {1, 1, 2}), 3);
}

TEST_F(Reuse, AnEditRunsWhatIsDownstreamOfIt) {
  const auto session = open(true);
  EXPECT_EQ(run(*session, {1, 1, 1}), 3);
  EXPECT_EQ(run(*session, {1, 1, 2}), 1);
  ASSERT_EQ(session->report().skipped_now.size(), 1u);
  EXPECT_EQ(session->report().skipped_now[0].name, "2 of 3 kernels");
  EXPECT_EQ(session->report().skipped_now[0].reason, "nothing that they read has changed");
  EXPECT_EQ(run(*session, {1, 1, 2}), 0);
  EXPECT_EQ(run(*session, {1, 5, 2}), 1);  // depth is read by the last alone
  EXPECT_EQ(run(*session, {3, 5, 2}), 3);
  EXPECT_EQ(run(*session, {3, 5, 1}), 1);
}

TEST_F(Reuse, KeptImagesMakeNothingNew) {
  const auto session = open(true);
  EXPECT_EQ(run(*session, {1, 1, 1}), 3);
  const auto before = session->report().counters;
  const auto objects = session->stack().program()->counters();
  for (int i = 2; i < 5; ++i) EXPECT_EQ(run(*session, {1, 1, static_cast<double>(i)}), 1);
  EXPECT_EQ(session->report().counters.images, before.images);
  EXPECT_EQ(session->report().counters.programs, before.programs);
  EXPECT_EQ(session->stack().program()->counters().allocations, objects.allocations);
  EXPECT_EQ(session->stack().program()->counters().pipelines, objects.pipelines);
}

TEST_F(Reuse, AChangeOfSizeRunsEverything) {
  const auto session = open(true);
  EXPECT_EQ(run(*session, {1, 1, 1}), 3);
  Picture other = picture({1, 1, 1});
  other.color = Image(12, 12, 4);
  other.auxiliary["depth"] = Image(12, 12, 1);
  other.content.clear();
  EXPECT_TRUE(session->process(other));
  EXPECT_EQ(run(*session, {1, 1, 1}), 3);
}

}  // namespace
}  // namespace afterglow
