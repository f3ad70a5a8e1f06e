// SPDX-License-Identifier: MIT
// What a run leaves out, as users see it: regions, held frames, frames in which an effect has nothing to do.
#include <OpenImageIO/imageio.h>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class Skip : public CliTest {
 protected:
  struct Pixels {
    int width = 0, height = 0, channels = 0;
    std::vector<float> values;
  };
  Pixels load(const std::string& name) const {
    Pixels out;
    auto in = OIIO::ImageInput::open(text(name));
    if (!in) return out;
    const auto spec = in->spec();
    out = {spec.width, spec.height, spec.nchannels, {}};
    out.values.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                      static_cast<std::size_t>(spec.nchannels));
    in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, out.values.data());
    return out;
  }
  void expect_crop(const std::string& some, const std::string& whole, int x, int y, int width, int height) const {
    const Pixels a = load(some), b = load(whole);
    ASSERT_EQ(a.width, width);
    ASSERT_EQ(a.height, height);
    ASSERT_EQ(a.channels, b.channels);
    int different = 0;
    for (int v = 0; v < height; ++v)
      for (int i = 0; i < width * a.channels; ++i)
        different += a.values[static_cast<std::size_t>(v * width * a.channels + i)] !=
                     b.values[static_cast<std::size_t>(((y + v) * b.width + x) * b.channels + i)];
    EXPECT_EQ(different, 0);
  }
  void ok(const std::vector<std::string>& arguments) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  }
};

TEST_F(Skip, ARegionIsTheCropOfTheResult) {
  const std::string look = preset("neon_night.lua").string(), input = neon().string();
  for (const std::string file : {"a.exr", "a.png"}) {
    std::vector<std::string> whole{"run", look, input, "-o", "whole_" + file};
    std::vector<std::string> some{"run", look, input, "-o", file, "--region", "37,11,50,41"};
    ok(whole);
    ok(some);
    expect_crop(file, "whole_" + file, 37, 11, 50, 41);
  }
  ok({"run", look, input, "-o", "s.png", "--size", "160x90"});
  ok({"run", look, input, "-o", "t.png", "--size", "160x90", "--region", "100,50,60,40"});
  expect_crop("t.png", "s.png", 100, 50, 60, 40);
}

TEST_F(Skip, ARegionSaysWhatItSaved) {
  make_exr("a.exr");
  make_preset("look.lua");
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "a.png", "--region", "0,0,32,18", "--stats"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("skipped [0-9.]+ % of the pixels: the region does not need them"));
  const Outcome graph = run({"graph", "look.lua", "--size", "64x36", "--region", "0,0,32,18"});
  EXPECT_THAT(graph.out, HasSubstr("% of the pixels: the region does not need them"));
}

TEST_F(Skip, RegionsThatCannotBe) {
  make_exr("a.exr", 64, 36);
  make_preset("look.lua");
  const auto before = files();
  for (const std::string region : {"1,2,3", "a,b,c,d", "0,0,0,5", "0,0,5,-1", "-1,0,5,5", "1,2,3,4,5", "0,0,5,5x"}) {
    const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "o.png", "--region=" + region});
    EXPECT_EQ(outcome.exit_code, kUsage) << region;
    EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
  }
  for (const std::string region : {"60,0,5,5", "0,30,5,7", "64,0,1,1", "0,0,65,36"}) {
    const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "o.png", "--region", region});
    EXPECT_EQ(outcome.exit_code, kFiles) << region;
    EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("reaches beyond the picture, which has 64×36 pixels"));
  }
  for (const char* name : {"in/a.0001.exr", "in/a.0002.exr", "in/a.0003.exr"}) make_exr(name, 64, 36);
  const Outcome several = run({"run", "look.lua", "in/a.####.exr", "-o", "o.####.png", "--region", "60,0,5,5"});
  EXPECT_EQ(several.exit_code, kFiles);
  EXPECT_EQ(several.err,
            "in/a.0001.exr: error: the region 60,0,5,5 reaches beyond the picture, which has 64×36 pixels\n");
  fs::remove_all(path("in"));
  const Outcome layers = run({"run", "look.lua", "a.exr", "-o", "o.exr", "--region", "0,0,5,5", "--keep-layers"});
  EXPECT_EQ(layers.exit_code, kUsage);
  EXPECT_THAT(layers.err, HasSubstr("cannot go with --region"));
  EXPECT_EQ(files(), before);
}

TEST_F(Skip, HeldFramesAreWrittenAgainWithoutRunning) {
  make_exr("in/a.1.exr");
  fs::copy_file(path("in/a.1.exr"), path("in/a.2.exr"));
  make_exr("in/a.3.exr", 48, 36);
  make_preset("look.lua");
  fs::create_directories(path("out"));
  const Outcome outcome =
      run({"run", "look.lua", "in/a.#.exr", "-o", "out/a.#.png", "--stats", "--report", "report.json"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("skipped frame in 1 of 3 frames: its picture and settings are those of an earlier"));
  EXPECT_EQ(read("out/a.1.png"), read("out/a.2.png"));
  EXPECT_THAT(read("report.json"), HasSubstr("its picture and settings are those of an earlier frame"));
}

TEST_F(Skip, FramesWithNothingBrightAreRunWithoutTheirGlow) {
  write("look.lua",
        "local fx = require 'afterglow'\nreturn fx.stack { fx.bloom { threshold = 9 }, fx.tone_mapping { } }\n");
  write("bare.lua", "local fx = require 'afterglow'\nreturn fx.stack { fx.tone_mapping { } }\n");
  make_exr("a.exr");
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "a.png", "--stats"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("skipped bloom: nothing is brighter than [0-9.]+"));
  ok({"run", "bare.lua", "a.exr", "-o", "b.png"});
  EXPECT_EQ(read("a.png"), read("b.png"));
  const Outcome graph = run({"graph", "look.lua"});
  EXPECT_THAT(graph.out, ContainsRegex("not run: bloom, when nothing is brighter than [0-9.]+"));
}

}  // namespace
}  // namespace afterglow::test
