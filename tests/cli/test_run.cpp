// SPDX-License-Identifier: MIT
// `afterglow run` on single pictures: what it writes and reports.
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <nlohmann/json.hpp>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class Run : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    make_preset("look.lua");
    make_exr("a.exr");
  }

  OIIO::ImageSpec spec_of(const std::string& name) const {
    auto in = OIIO::ImageInput::open(text(name));
    EXPECT_TRUE(in) << OIIO::geterror();
    return in ? in->spec() : OIIO::ImageSpec();
  }
};

TEST_F(Run, WritesThePictureAndSaysNothing) {
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "a.png"});
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_EQ(files(), (std::vector<std::string>{"a.exr", "a.png", "look.lua"}));
  const auto spec = spec_of("a.png");
  EXPECT_EQ(spec.width, 64);
  EXPECT_EQ(spec.height, 36);
}

TEST_F(Run, APassMayHaveTheNameOfTheLastOne) {
  write("effects/output.lua",
        "local fx = require \"afterglow\"\nreturn fx.effect { name = \"output\", doc = \"Halves.\", at = "
        "\"post_process\", build = function(g, s, source)\n  return g:pass { shader = \"half\", source = source, name "
        "= \"display\" }\nend }\n");
  write("shaders/half.glsl", "vec4 apply(vec4 color) { return color * 0.5; }\n");
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.output {} }\n");
  for (const char* to : {"o.png", "o.jpg", "o.exr"}) {
    const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", to, "--dither", "blue"});
    EXPECT_EQ(outcome.exit_code, kDone) << to << outcome.err;
  }
}

TEST_F(Run, TypeAndCompressionAreTakenOver) {
  ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", "f.exr", "--type", "float", "--compression", "piz"}).exit_code,
            kDone);
  EXPECT_EQ(spec_of("f.exr").format, OIIO::TypeDesc::FLOAT);
  EXPECT_EQ(spec_of("f.exr").get_string_attribute("compression"), "piz");
  ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", "h.exr"}).exit_code, kDone);
  EXPECT_EQ(spec_of("h.exr").format, OIIO::TypeDesc::HALF);
  ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", "u.png", "--type", "uint16"}).exit_code, kDone);
  EXPECT_EQ(spec_of("u.png").format, OIIO::TypeDesc::UINT16);
}

TEST_F(Run, SizeScalesThePictureFirst) {
  ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", "small.exr", "--size", "32x18"}).exit_code, kDone);
  EXPECT_EQ(spec_of("small.exr").width, 32);
  EXPECT_EQ(spec_of("small.exr").height, 18);
}

TEST_F(Run, PreviewsOfDetailAreMadeAtTwiceTheirSize) {
  write("detail.lua", R"(local fx = require "afterglow"
return fx.stack { fx.edge_detection { intensity = 20, threshold = 0 }, fx.tone_mapping { mode = "neutral" } })");
  const std::vector<std::string> exact{"--type", "float", "--compression", "none"};
  const auto made = [&](const std::string& file, std::vector<std::string> more) {
    std::vector<std::string> words{"run", "detail.lua", "a.exr", "-o", file};
    words.insert(words.end(), exact.begin(), exact.end());
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return OIIO::ImageBuf(text(file));
  };
  const OIIO::ImageBuf whole = made("whole.exr", {}),
                       half = made("half.exr", {"--size", "50%", "--report", "half.json"}),
                       part = made("part.exr", {"--size", "50%", "--region", "5,3,12,9"}),
                       most = made("most.exr", {"--size", "60%"});
  ASSERT_EQ(half.spec().width, 32);
  ASSERT_EQ(half.spec().height, 18);
  EXPECT_EQ(nlohmann::json::parse(read("half.json")).at("frames").at(0).at("width"), 32) << "as it is delivered";
  const OIIO::ImageBuf wanted = OIIO::ImageBufAlgo::resize(whole, "box", 0, half.roi());
  const auto difference = OIIO::ImageBufAlgo::compare(wanted, half, 0, 0);
  EXPECT_LT(difference.maxerror, 1e-5);
  const auto cut = OIIO::ImageBufAlgo::cut(half, OIIO::ROI(5, 17, 3, 12));
  EXPECT_EQ(OIIO::ImageBufAlgo::compare(cut, part, 0, 0).maxerror, 0);
  EXPECT_EQ(most.spec().width, 38);  // more than half: made at its own size
}

TEST_F(Run, OverridesChangePixelsAndPrecisionHardly) {
  ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", "1.png"}).exit_code, kDone);
  ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", "2.png", "--set", "tone_mapping.mode=neutral"}).exit_code, kDone);
  ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", "3.png", "--reference"}).exit_code, kDone);
  EXPECT_NE(read("1.png"), read("2.png"));
  EXPECT_EQ(read("1.png"), read("3.png"));
  const Outcome both = run({"run", "look.lua", "a.exr", "-o", "4.png", "--reference", "--precision", "fp16"});
  EXPECT_EQ(both.exit_code, kUsage);
  EXPECT_THAT(both.err, HasSubstr("--reference stores full floats"));
}

TEST_F(Run, StatsNameEveryStep) {
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "a.png", "--stats"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  for (const char* step :
       {"start-up", "script", "compile", "read", "upload", "execute", "read-back", "write", "wall", "memory"})
    EXPECT_THAT(outcome.out, HasSubstr(step));
  EXPECT_THAT(outcome.out, Not(HasSubstr("tone_mapping")));
}

TEST_F(Run, StatsOfPassesNameThePasses) {
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "a.png", "--stats=passes"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("tone_mapping.aces"));
}

TEST_F(Run, ReportSaysWhatRanAndWhatWasSkipped) {
  write("look.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.stack { name = \"Two\", fx.tone_mapping { mode = \"aces\" }, fx.bloom { intensity = 0 } }\n");
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "a.png", "--report", "report.json"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  const auto report = nlohmann::json::parse(read("report.json"));
  EXPECT_EQ(report.at("frames").at(0).at("state"), "done");
  EXPECT_EQ(report.at("frames").at(0).at("width"), 64);
  EXPECT_EQ(report.at("session").at("kernels").size(), 1u);
  const auto& skipped = report.at("session").at("skipped");
  ASSERT_EQ(skipped.size(), 1u);
  EXPECT_EQ(skipped.at(0).at("name"), "bloom");
  EXPECT_THAT(skipped.at(0).at("reason").get<std::string>(), Not(IsEmpty()));
}

TEST_F(Run, MissingDepthIsAWarningAndQuietHidesIt) {
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.outline {}, fx.tone_mapping {} }\n");
  Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "a.png"});
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_THAT(outcome.err, ::testing::StartsWith("warning: "));
  EXPECT_THAT(outcome.err, HasSubstr("outline"));
  outcome = run({"run", "look.lua", "a.exr", "-o", "a.png", "-q"});
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_THAT(outcome.err, IsEmpty());
}

TEST_F(Run, MissingDepthOfARequiredEffectIsAnError) {
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.outline { required = true } }\n");
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "a.png"});
  EXPECT_EQ(outcome.exit_code, kScript);
  EXPECT_TRUE(is_one_error_line(outcome.err));
  EXPECT_FALSE(fs::exists(path("a.png")));
}

TEST_F(Run, DepthFromAnotherFile) {
  write("look.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.outline { source = \"depth\", required = true } }\n");
  // The red channel of a picture of the same size stands in for depth.
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "a.png", "--depth", "a.exr:R"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
}

TEST_F(Run, EffectsBesideThePresetAndOnThePath) {
  const std::string effect =
      "local fx = require \"afterglow\"\n"
      "return fx.effect { name = \"halve\", doc = \"Half the light.\", at = \"post_process\", order = 1, settings = "
      "{},\n"
      "  build = function(g, s, source) return g:pass { shader = \"halve/halve\", source = source } end }\n";
  const std::string shader = "vec4 apply(vec4 color) { return vec4(color.rgb * 0.5, color.a); }\n";
  write("mine/effects/halve.lua", effect);
  write("mine/shaders/halve/halve.glsl", shader);
  const std::string look = "local fx = require \"afterglow\"\nreturn fx.stack { fx.halve {} }\n";
  write("mine/look.lua", look);
  write("other.lua", look);
  EXPECT_EQ(run({"run", "mine/look.lua", "a.exr", "-o", "1.exr"}).exit_code, kDone);
  EXPECT_EQ(run({"run", "other.lua", "a.exr", "-o", "2.exr"}).exit_code, kScript);
  EXPECT_EQ(run({"run", "other.lua", "a.exr", "-o", "2.exr", "--path", "mine"}).exit_code, kDone);
  RunOptions options;
  options.environment["AFTERGLOW_PATH"] = text("mine");
  EXPECT_EQ(run({"run", "other.lua", "a.exr", "-o", "3.exr"}, options).exit_code, kDone);
  auto in = OIIO::ImageInput::open(text("1.exr"));
  ASSERT_TRUE(in);
  std::vector<float> pixels(64 * 36 * 4);
  ASSERT_TRUE(in->read_image(0, 0, 0, 4, OIIO::TypeDesc::FLOAT, pixels.data()));
  EXPECT_NEAR(pixels[0], 0.05, 1e-4);
  EXPECT_NEAR(pixels[3], 1.0, 0);
}

TEST_F(Run, SmallestPicture) {
  make_exr("one.exr", 1, 1);
  const Outcome outcome = run({"run", preset("neon_night.lua").string(), "one.exr", "-o", "one.png"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
}

/// The driver compiles on two threads there.
TEST_F(Run, AFrameWithEmptyCachesIsThatOfWarmOnes) {
  make_exr("in.exr");
  RunOptions options;
  options.environment["AFTERGLOW_CACHE"] = text("cache");
  options.environment["MESA_SHADER_CACHE_DIR"] = text("driver");
  options.environment["AFTERGLOW_VALIDATE"] = "1";
  for (const char* name : {"cold.exr", "warm.exr"}) {
    const Outcome outcome = run({"run", preset("neon_night.lua").string(), "in.exr", "-o", name}, options);
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  }
  EXPECT_EQ(read("cold.exr"), read("warm.exr"));
}

TEST_F(Run, BrokenCacheIsRebuilt) {
  RunOptions options;
  options.environment["AFTERGLOW_CACHE"] = text("cache");
  ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", "1.png"}, options).exit_code, kDone);
  int broken = 0;
  for (const auto& entry : fs::recursive_directory_iterator(path("cache")))
    if (entry.is_regular_file()) {
      write(fs::relative(entry.path(), path("")).string(), "rubbish");
      ++broken;
    }
  EXPECT_GT(broken, 0);
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "2.png"}, options);
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_EQ(read("1.png"), read("2.png"));
}

/// A filter of both axes with many taps runs one axis after the other: the same sums but for their rounding.
TEST_F(Run, FiltersOfManyTapsRunAxisByAxis) {
  write("effects/wide.lua", R"(
local fx = require "afterglow"
return fx.effect { name = "wide", settings = { taps = fx.int { default = 9, min = 1, max = 15 }, whole = fx.bool { default = false },
    small = fx.bool { default = false } },
  build = function(g, s, source)
    local x, y, taps = {}, {}, {}
    for i = 1, s.taps do
      x[i] = { (i - (s.taps + 1) / 2) * 0.75, i / (s.taps * (s.taps + 1) / 2) }
      y[i] = { (i - (s.taps + 1) / 2) * 1.5, 1 / s.taps }
    end
    for _, a in ipairs(x) do for _, b in ipairs(y) do taps[#taps + 1] = { a[1], b[1], a[2] * b[2] } end end
    local size = s.small and { source.width - 7, math.ceil(source.height / 2) } or source
    local image = g:filter { source = source, size = size, filter = s.whole and { taps = taps } or { x = x, y = y } }
    return s.small and g:filter { source = image, size = source, filter = fx.filters.bilinear() } or image
  end })");
  const auto made = [&](const std::string& settings, const std::string& size) {
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.wide { " + settings + " } }\n");
    const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "b.exr", "--type", "float", "--size", size});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return pixels_of("b.exr");
  };
  make_exr("a.exr");
  for (const char* size : {"64x36", "37x21", "8x3"})
    for (const char* small : {"", ", small = true"}) {
      const auto apart = made(std::string("taps = 9") + small, size),
                 whole = made(std::string("taps = 9, whole = true") + small, size);
      ASSERT_EQ(apart.size(), whole.size());
      for (std::size_t i = 0; i < apart.size(); ++i)
        ASSERT_NEAR(apart[i], whole[i], 4e-6 * std::max(1.0F, whole[i])) << size << small << " at " << i;
    }
  const auto passes = [&](const std::string& settings) {
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.wide { " + settings + " } }\n");
    return run({"graph", "look.lua", "--format", "dot"}).out;
  };
  EXPECT_THAT(passes("taps = 9"), HasSubstr("wide.filter.x"));
  EXPECT_THAT(passes("taps = 5"), Not(HasSubstr("wide.filter.")));
  EXPECT_THAT(passes("taps = 9, whole = true"), Not(HasSubstr("wide.filter.")));
}

/// Once for all frames; a rounding to even sides is none.
TEST_F(Run, ASizeOfAnotherShapeIsTold) {
  make_preset("look.lua");
  for (const char* name : {"in/a.0001.exr", "in/a.0002.exr"}) make_exr(name, 640, 270);
  const auto said = [&](const std::string& size) {
    const Outcome outcome = run({"run", "look.lua", "in/a.####.exr", "-o", "o.####.png", "--size", size});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return outcome.err;
  };
  EXPECT_EQ(said("320x180"),
            "warning: in/a.0001.exr: --size 320x180 changes the shape of the picture, which has 640x270 pixels; --size "
            "320 or --size x180 keeps it\n");
  for (const char* size : {"320x135", "320x136", "322x136", "320", "x136", "50%", "1280x540"})
    EXPECT_EQ(said(size), "") << size;
}

}  // namespace
}  // namespace afterglow::test
