// SPDX-License-Identifier: MIT
// What no picture flows into is made once, and made anew where a picture of another size or a reload asks for it.
#include <fmt/format.h>

#include "live_fixture.h"

namespace afterglow {
namespace {

/// Two kernels of settings and sizes alone, `spots` at half the size and `dirt`; behind three that blur the picture,
/// one that adds both. Every frame has other pixels, so that only what is made once is kept.
class MadeOnce : public LiveTest {
 protected:
  static constexpr int kOnce = 2, kKernels = 6;

  void SetUp() override {
    LiveTest::SetUp();
    write("effects/t.lua", R"(local fx = require "afterglow"
return fx.effect {
  name = "t", at = "post_process",
  settings = { seed = fx.float { default = 1 }, gain = fx.float { default = 1 } },
  build = function(g, s, source)
    local half = { (source.width + 1) // 2, (source.height + 1) // 2 }
    local spots = g:pass { shader = "t/spots", size = half, seed = s.seed, name = "spots" }
    local dirt = g:filter { source = spots, size = source, filter = fx.filters.tent(), name = "dirt" }
    local image = source
    for _, name in ipairs { "a", "b", "c" } do
      image = g:filter { source = image, size = source, filter = fx.filters.tent(), name = name }
    end
    return g:pass { shader = "t/lit", source = image, dirt = dirt, gain = s.gain, name = "lit" }
  end,
})");
    spots(12.9898);
    lit("+");
    look(1, 1);
  }
  void spots(double by) {
    write("shaders/t/spots.glsl",
          fmt::format("uniform float seed;\nvec4 sample_at(ivec2 p) {{ return vec4(fract(sin(dot(vec2(p) + seed, "
                      "vec2({}, 78.233))) * 43.7), 0.5, 0.25, 1.0); }}\n",
                      by));
  }
  void lit(const char* sign) {
    write(
        "shaders/t/lit.glsl",
        fmt::format("uniform sampler2D source;\nuniform sampler2D dirt;\nuniform float gain;\nvec4 sample_at(ivec2 p) "
                    "{{ return fetch(source, p) * gain {} fetch(dirt, p); }}\n",
                    sign));
  }
  void look(double seed, double gain) {
    write("look.lua",
          fmt::format("local fx = require \"afterglow\"\nreturn fx.stack {{\n  fx.t {{ seed = {}, gain = {} "
                      "}},\n}}\n",
                      seed, gain));
  }
  std::unique_ptr<LiveSession> opened(bool keep_images) {
    LiveOptions options;
    options.follow = false;
    options.stack.keep_images = keep_images;
    auto session = LiveSession::open(*device_, folder_ / "look.lua", options, diagnostics_);
    EXPECT_TRUE(session) << session.error().text();
    return std::move(*session);
  }
  static std::vector<float> pixels(LiveSession& session, Size size, int picture) {
    Picture p;
    p.color = Image(size.width, size.height, 4);
    for (std::size_t i = 0; i < p.color.pixels.size(); ++i)
      p.color.pixels[i] = static_cast<float>((i * 7 + static_cast<std::size_t>(picture) * 13) % 97) / 32.f;
    note_content(p);
    const auto done = session.process(p);
    EXPECT_TRUE(done) << done.error().text();
    HostResult out;
    EXPECT_TRUE(session.read_result(out));
    return out.pixels;
  }
  /// Kernels kept in the next frame, whose pixels must be those of a session that saw nothing else.
  int kept(LiveSession& session, Size size) {
    session.live().settle();
    ++picture_;
    const auto here = pixels(session, size, picture_);
    EXPECT_FALSE(session.live().status().error) << session.live().status().error_text();
    EXPECT_EQ(here, pixels(*opened(false), size, picture_)) << "picture " << picture_;
    EXPECT_EQ(session.times().kernels_run + session.times().kernels_kept, kKernels);
    return session.times().kernels_kept;
  }

  int picture_ = 0;
};

TEST_F(MadeOnce, PicturesOfAnotherSizeHaveTheirOwn) {
  for (const bool keep_images : {false, true}) {
    const auto session = opened(keep_images);
    // 23 × 15 has the half of 24 × 16: its spots are the same, its dirt is not.
    for (const Size size : {Size{24, 16}, Size{40, 25}, Size{23, 15}, Size{24, 16}}) {
      EXPECT_LE(kept(*session, size), kOnce);
      EXPECT_EQ(kept(*session, size), kOnce) << size.width;
      EXPECT_EQ(kept(*session, size), kOnce) << size.width;
    }
    for (int i = 0; i < 3; ++i)
      for (const Size size : {Size{24, 16}, Size{23, 15}}) EXPECT_LE(kept(*session, size), kOnce);
  }
}

TEST_F(MadeOnce, ReloadsMakeAnewWhatTheyChange) {
  const Size size{24, 16};
  for (const bool keep_images : {false, true}) {
    spots(12.9898);
    lit("+");
    look(1, 1);
    const auto session = opened(keep_images);
    EXPECT_EQ(kept(*session, size), 0);
    EXPECT_EQ(kept(*session, size), kOnce);
    look(1, 2);
    EXPECT_EQ(kept(*session, size), kOnce) << "a value that nothing made once reads";
    look(5, 2);
    EXPECT_EQ(kept(*session, size), 0) << "a value that it reads";
    EXPECT_EQ(kept(*session, size), kOnce);
    spots(3.7);
    EXPECT_EQ(kept(*session, size), 0) << "its shader";
    EXPECT_EQ(kept(*session, size), kOnce);
    lit("-");
    EXPECT_EQ(kept(*session, size), keep_images ? kOnce : 0) << "a shader behind it: another program";
    EXPECT_EQ(kept(*session, size), kOnce);
    lit("+");
    spots(12.9898);
    look(1, 1);
    EXPECT_LE(kept(*session, size), kOnce) << "all of it back again";
    EXPECT_EQ(kept(*session, size), kOnce);
  }
}

}  // namespace
}  // namespace afterglow
