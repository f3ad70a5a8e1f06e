// SPDX-License-Identifier: MIT
// Sequences with frames that are missing or fail: what is told, and the length and times of videos.
#include "video_out_test.h"

namespace afterglow::test {
namespace {

using ::testing::ElementsAre;

class MissingFrames : public VideoOut {
 protected:
  void SetUp() override {
    VideoOut::SetUp();
    make_frames(6);
  }
  void remove(std::initializer_list<int> frames) const {
    for (const int frame : frames) fs::remove(path("in/" + std::to_string(1000 + frame) + ".ppm"));
  }
  Outcome make_exact(const std::string& name, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"--codec", "ffv1", "--dither", "none"};
    all.insert(all.end(), more.begin(), more.end());
    return make_video(name, all);
  }
  /// Place and number of each frame of a video of 24 frames a second.
  std::vector<std::pair<int, int>> places_of(const std::string& name) const {
    const auto times = probe(name, "-show_frames -show_entries frame=pts_time");
    std::vector<std::pair<int, int>> places;
    for (const std::string& frame : frames_of(name)) {
      const double time = std::stod(times.at("frames").at(places.size()).at("pts_time").get<std::string>());
      places.emplace_back(static_cast<int>(std::lround(time * 24)), number_of(frame));
    }
    return places;
  }
};
using Place = std::pair<int, int>;

TEST_F(MissingFrames, AVideoHoldsThePlacesOfThoseThatAreNotThere) {
  remove({3});
  const Outcome outcome = make_exact("a.mkv");
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_EQ(outcome.err, "warning: in/####.ppm: frame 1003 is missing; the one before is held\n");
  EXPECT_THAT(places_of("a.mkv"), ElementsAre(Place{0, 1}, Place{1, 2}, Place{3, 4}, Place{4, 5}, Place{5, 6}));
  const Outcome raw = make_video("-", {"--format", "raw", "--dither", "none"});
  EXPECT_EQ(raw.exit_code, kDone);
  EXPECT_THAT(raw.err, HasSubstr("frame 1003 is missing; the one before is held"));
  EXPECT_EQ(raw.out, codes_of(1) + codes_of(2) + codes_of(2) + codes_of(4) + codes_of(5) + codes_of(6));
}

TEST_F(MissingFrames, LooksThatLookBackHoldThemToo) {
  remove({2, 3, 5});
  write("effects/back.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.effect { name = \"back\", settings = {}, build = function(g, s, source)\n"
        "  local before = g:history { size = { 1, 1 }, pre_roll = 1 }\n"
        "  g:keep(before, g:pass { shader = \"back/keep\", before = before, size = { 1, 1 } })\n"
        "  return g:pass { shader = \"back/show\", source = source, before = before }\nend }\n");
  write("shaders/back/keep.glsl",
        "uniform sampler2D before;\nvec4 sample_at(ivec2 p) { return fetch(before, p) * 0.5; }\n");
  write("shaders/back/show.glsl",
        "uniform sampler2D before;\n"
        "vec4 apply(vec4 color) { return color + 1e-9 * fetch(before, ivec2(0)); }\n");
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.back {} }\n");
  const Outcome outcome = make_exact("a.mkv");
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("in/####.ppm: frames 1002-1003, 1005 are missing; those before are held"));
  EXPECT_THAT(places_of("a.mkv"), ElementsAre(Place{0, 1}, Place{3, 4}, Place{5, 6}));
}

TEST_F(MissingFrames, PicturesAreNamedAlone) {
  remove({3, 4});
  fs::create_directory(path("out"));
  const Outcome outcome = run({"run", "look.lua", "in/####.ppm", "-o", "out/####.png"});
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_EQ(outcome.err, "warning: in/####.ppm: frames 1003-1004 are missing\n");
  const Outcome asked = run({"run", "look.lua", "in/####.ppm", "-o", "out/####.png", "--frames", "1002,1005"});
  EXPECT_EQ(asked.exit_code, kDone);
  EXPECT_THAT(asked.err, IsEmpty());
}

TEST_F(MissingFrames, NumbersThatAreNoneOfAVideo) {
  write("in/9000001.ppm", read("in/1001.ppm"));
  const Outcome outcome = make_exact("a.mkv");
  EXPECT_EQ(outcome.exit_code, kUsage);
  EXPECT_THAT(outcome.err, HasSubstr("frames 1001 to 9000001 are more than 1000000 places of a video; allowed: those "
                                     "that --frames names"));
  EXPECT_EQ(make_exact("a.mkv", {"--frames", "1001-1006"}).exit_code, kDone);
}

TEST_F(MissingFrames, AFirstOrLastOneThatFailsIsHeld) {
  write("in/1001.ppm", "P6\n96 64\n255\n");
  write("in/1006.ppm", "P6\n96 64\n255\n");
  const Outcome outcome = make_exact("a.mkv");
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("2 of 6 frames failed"));
  EXPECT_THAT(places_of("a.mkv"), ElementsAre(Place{0, 2}, Place{2, 3}, Place{3, 4}, Place{4, 5}, Place{5, 5}));
}

}  // namespace
}  // namespace afterglow::test
