// SPDX-License-Identifier: MIT
// --nan-policy as users see it: values that are not finite in pictures and in what passes make, named and mended.
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "cli_test.h"

namespace afterglow::test {
namespace {

using Json = nlohmann::json;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

class NonFiniteValues : public CliTest {
 protected:
  static constexpr int kWidth = 32, kHeight = 18;
  struct Spot {
    int x, y, channel;
    float value;
  };
  /// A ramp with alpha 1 (and with `channels` 5 a depth of 2) but for those spots. Full floats.
  void make(const std::string& name, const std::vector<Spot>& spots, int channels = 4) const {
    OIIO::ImageSpec spec(kWidth, kHeight, channels, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"R", "G", "B", "A"};
    if (channels == 5) spec.channelnames.push_back("Z");
    std::vector<float> pixels(static_cast<std::size_t>(kWidth * kHeight * channels));
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        for (int c = 0; c < channels; ++c)
          pixels[at(x, y, c, channels)] = c == 3 ? 1.0f : c == 4 ? 2.0f : ramp(x, y, c);
    for (const auto& spot : spots) pixels[at(spot.x, spot.y, spot.channel, channels)] = spot.value;
    fs::create_directories(path(name).parent_path());
    auto out = OIIO::ImageOutput::create(text(name));
    ASSERT_TRUE(out && out->open(text(name), spec) && out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) &&
                out->close())
        << OIIO::geterror();
  }
  static float ramp(int x, int y, int c) { return 0.1f + 0.01f * static_cast<float>(x + 2 * y + c); }
  static std::size_t at(int x, int y, int c, int channels = 4) {
    return static_cast<std::size_t>((y * kWidth + x) * channels + c);
  }
  std::vector<float> load(const std::string& name) const {
    auto in = OIIO::ImageInput::open(text(name));
    if (!in) return {};
    const auto spec = in->spec();
    std::vector<float> all(static_cast<std::size_t>(spec.width * spec.height * spec.nchannels));
    in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, all.data());
    return all;
  }
  /// An effect `broken` of one pass `broken.apply`, and look.lua with it and `more` behind it.
  void make_effect(const std::string& glsl, const std::string& more = "", const std::string& before = "") const {
    write("shaders/broken/apply.glsl", glsl);
    write("effects/broken.lua",
          "local fx = require \"afterglow\"\n"
          "return fx.effect { name = \"broken\", at = \"before_post_process\", settings = {}, build = function(g, s, "
          "source)\n"
          "  return g:pass { shader = \"broken/apply\", source = source, name = \"apply\" }\n"
          "end }\n");
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { " + before + "fx.broken {}" + more + " }\n");
  }
  Json report() const { return Json::parse(read("report.json")); }
  Json non_finite(int frame = 0) const {
    return report()["frames"][static_cast<std::size_t>(frame)].value("non_finite", Json::object());
  }
  Outcome run_look(const std::vector<std::string>& more = {}, const std::string& output = "o.exr") const {
    std::vector<std::string> all{"run", "look.lua", "a.exr", "-o", output, "--report", "report.json", "--type"};
    all.push_back(output.ends_with("exr") ? "float" : "auto");
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  }
};

constexpr const char* kDivide =
    "// 0/0 at x = 5 and 1/0 at x = 6, from row 3 on\n"
    "vec4 apply(vec4 color, ivec2 pixel) {\n"
    "  float zero = color.a - 1.0;\n"
    "  if (pixel.y >= 3 && pixel.x == 5) color.g = zero / zero;\n"
    "  if (pixel.y >= 3 && pixel.x == 6) color.b = color.r / zero;\n"
    "  return color; }\n";
constexpr const char* kSame = "vec4 apply(vec4 color) { return color; }\n";

TEST_F(NonFiniteValues, APassThatDividesByZeroIsNamedAndMended) {
  make("a.exr", {});
  make_effect(kDivide);
  for (const std::string output : {"o.exr", "o.png"}) {
    const Outcome outcome = run_look({}, output);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_THAT(outcome.err,
                HasSubstr("effects/broken.lua:3: pass 'broken.apply' made 15 NaN, 15 +Inf, first at pixel 5,3: "
                          "(0.21, nan, 0.23, 1) of 32x18"));
    EXPECT_THAT(outcome.err, HasSubstr("shaders/broken/apply.glsl"));
    EXPECT_THAT(outcome.err, HasSubstr("replaced by 0, in a.exr"));
    const Json pass = non_finite()["passes"][0];
    EXPECT_EQ(pass["pass"], "broken.apply");
    EXPECT_EQ(pass["effect"], "broken");
    EXPECT_EQ(pass["line"], 3);
    EXPECT_EQ(pass["nan"], 15);
    EXPECT_EQ(pass["plus_infinity"], 15);
    EXPECT_EQ(pass["first"]["x"], 5);
    EXPECT_EQ(pass["first"]["y"], 3);
    EXPECT_EQ(pass["first"]["value"][1], "nan");
    EXPECT_EQ(non_finite()["passes"].size(), 1u);
  }
  const auto made = load("o.exr");
  EXPECT_EQ(made[at(5, 3, 1)], 0);
  EXPECT_EQ(made[at(6, 17, 2)], 0);
  EXPECT_EQ(made[at(5, 2, 1)], ramp(5, 2, 1));
  EXPECT_EQ(made[at(5, 3, 0)], ramp(5, 3, 0));
}

/// Not whatever lay in memory, which changes from run to run and is finite more often than not.
TEST_F(NonFiniteValues, ZerosThatACompilerSeesDivideAsOthersDo) {
  make("a.exr", {});
  for (const auto& [glsl, made] :
       {std::pair("return vec4(color.rgb * 0.5 / 0.0, color.a);", "made 1728 +Inf"),
        std::pair("return vec4(vec3(0.5 / (color.r - color.r)), color.a);", "made 1728 +Inf")}) {
    SCOPED_TRACE(glsl);
    make_effect("vec4 apply(vec4 color) { " + std::string(glsl) + " }\n");
    EXPECT_THAT(run_look().err, HasSubstr(std::string("pass 'broken.apply' ") + made));
    const std::string once = read("o.exr");
    EXPECT_THAT(run_look({}, "o.png").err, HasSubstr(made));
    EXPECT_EQ(run_look({"--reference"}).exit_code, kDone);
    EXPECT_EQ(read("o.exr"), once) << "every run makes the same bytes, fused passes and single ones";
    EXPECT_EQ(run_look({"--nan-policy", "fail"}).exit_code, kScript);
  }
}

TEST_F(NonFiniteValues, VariablesWithoutAValueAreZeroAndTold) {
  make("a.exr", {});
  make_effect(
      "vec4 apply(vec4 color) {\n  float u;\n  if (color.r > 9.0) u = 1.0;\n  return vec4(color.rgb * u, "
      "color.a);\n}\n");
  const std::string warning = "shaders/broken/apply.glsl:2: 'u' may be read before it has a value; it is 0 there";
  for (int again = 0; again < 2; ++again) {  // the second time the kernel comes from the cache
    const Outcome outcome = run_look();
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("warning: "));
    EXPECT_THAT(outcome.err, HasSubstr(warning));
    EXPECT_EQ(outcome.err.find(warning), outcome.err.rfind(warning)) << "once";
    for (const int x : {0, 13}) EXPECT_EQ(load("o.exr")[at(x, 7, 1)], 0);
  }
  const Outcome check = run({"check", "look.lua"});
  EXPECT_EQ(check.exit_code, kDone);
  EXPECT_THAT(check.err, HasSubstr(warning));
}

TEST_F(NonFiniteValues, NeighboursStandIn) {
  make("a.exr", {});
  make_effect(kDivide);
  ASSERT_EQ(run_look({"--nan-policy", "neighbour"}).exit_code, kDone);
  const auto made = load("o.exr");
  // The column left and right of x = 5, and its own pixels above row 3.
  EXPECT_NEAR(made[at(5, 10, 1)],
              (ramp(4, 9, 1) + ramp(4, 10, 1) + ramp(4, 11, 1) + ramp(6, 9, 1) + ramp(6, 10, 1) + ramp(6, 11, 1)) / 6,
              1e-6);
  EXPECT_NEAR(made[at(5, 17, 1)], (ramp(4, 16, 1) + ramp(4, 17, 1) + ramp(6, 16, 1) + ramp(6, 17, 1)) / 4, 1e-6);
}

TEST_F(NonFiniteValues, FailEndsTheRunAndWritesNothing) {
  make("a.exr", {});
  make_effect(kDivide);
  const Outcome outcome = run_look({"--nan-policy", "fail"});
  EXPECT_EQ(outcome.exit_code, kScript);
  EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("broken.lua:3: error: pass 'broken.apply' made 15 NaN, 15 +Inf"));
  EXPECT_FALSE(fs::exists(path("o.exr")));
  make("a.exr", {{7, 4, 2, -kInf}});
  make_effect(kSame);
  const Outcome input = run_look({"--nan-policy", "fail"});
  EXPECT_EQ(input.exit_code, kFiles);
  EXPECT_TRUE(is_one_error_line(input.err)) << input.err;
  EXPECT_THAT(input.err,
              HasSubstr("a.exr: error: the picture has values that are not finite (--nan-policy fail): color: 1 "
                        "-Inf, first at pixel 7,4: (0.25, 0.26, -inf, 1)"));
  EXPECT_FALSE(fs::exists(path("o.exr")));
}

TEST_F(NonFiniteValues, WhatLaterPassesHideIsSeen) {
  make("a.exr", {});
  // In the same kernel: a tone curve clamps, which turns a NaN into a number.
  make_effect(kDivide, ", fx.tone_mapping {}, fx.color_adjustments { contrast = 20 }");
  for (const std::string output : {"o.exr", "o.png"})
    EXPECT_THAT(run_look({}, output).err, HasSubstr("pass 'broken.apply' made 15 NaN")) << output;
  // In an earlier kernel, before one that reads around its pixel.
  make_effect(kDivide, ", fx.tone_mapping {}, fx.fxaa {}");
  EXPECT_THAT(run_look({}).err, HasSubstr("pass 'broken.apply' made 15 NaN"));
  // Behind a bloom, which spreads it: the pass is named all the same, and nothing is spread.
  make_effect(kDivide, ", fx.bloom { threshold = 0.1, downscale_limit = 1 }, fx.tone_mapping {}");
  EXPECT_THAT(run_look({}).err, HasSubstr("pass 'broken.apply' made 15 NaN, 15 +Inf"));
  EXPECT_EQ(non_finite()["passes"].size(), 1u);
  for (const float value : load("o.exr")) ASSERT_TRUE(std::isfinite(value));
}

TEST_F(NonFiniteValues, WhatAnotherKernelSwallowsIsSeenByFail) {
  make("a.exr", {});
  make_effect(
      "uniform sampler2D source;\n"
      "vec4 sample_at(ivec2 p) { vec4 c = fetch(source, p);\n"
      "  return p.x == 9 ? log(-c) : c; }\n");
  write("shaders/broken/swallow.glsl",
        "uniform sampler2D source;\n"
        "vec4 sample_at(ivec2 p) { vec4 c = fetch(source, p);\n"
        "  return c.r < 100.0 ? c : vec4(0.5, 0.5, 0.5, 1.0); }\n");
  write("effects/broken.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.effect { name = \"broken\", settings = {}, build = function(g, s, source)\n"
        "  local made = g:pass { shader = \"broken/apply\", source = source, name = \"log\" }\n"
        "  return g:pass { shader = \"broken/swallow\", source = made, name = \"swallow\" }\n"
        "end }\n");
  const Outcome quiet = run_look();
  EXPECT_EQ(quiet.exit_code, kDone);
  EXPECT_THAT(quiet.err, IsEmpty());
  const Outcome outcome = run_look({"--nan-policy", "fail"});
  EXPECT_EQ(outcome.exit_code, kScript);
  EXPECT_THAT(outcome.err, HasSubstr("pass 'broken.log' made"));
  EXPECT_THAT(outcome.err, HasSubstr("pixel 9,0: (nan, nan, nan, nan)"));
}

TEST_F(NonFiniteValues, PicturesSayWhatAndWhere) {
  make_effect(kSame);
  make("a.exr", {{0, 0, 0, kNan}, {31, 9, 1, kInf}, {12, 8, 2, -kInf}, {31, 17, 3, kNan}});
  const Outcome outcome = run_look();
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_THAT(outcome.err, HasSubstr("color: 2 NaN, 1 +Inf, 1 -Inf, first at pixel 0,0: (nan, 0.11, 0.12, 1)"));
  const Json color = non_finite()["input"][0];
  EXPECT_EQ(color["layer"], "color");
  EXPECT_EQ(color["nan"], 2);
  EXPECT_EQ(color["plus_infinity"], 1);
  EXPECT_EQ(color["minus_infinity"], 1);
  const auto zero = load("o.exr");
  EXPECT_EQ(zero[at(0, 0, 0)], 0);
  EXPECT_EQ(zero[at(31, 9, 1)], 1e30f);
  EXPECT_EQ(zero[at(12, 8, 2)], 0);
  EXPECT_EQ(zero[at(31, 17, 3)], 1);
  ASSERT_EQ(run_look({"--nan-policy", "neighbour"}).exit_code, kDone);
  const auto mean = load("o.exr");
  EXPECT_NEAR(mean[at(0, 0, 0)], (ramp(1, 0, 0) + ramp(0, 1, 0) + ramp(1, 1, 0)) / 3, 1e-6);
  EXPECT_NEAR(mean[at(31, 9, 1)],
              (ramp(31, 8, 1) + ramp(31, 10, 1) + ramp(30, 8, 1) + ramp(30, 9, 1) + ramp(30, 10, 1)) / 5, 1e-6);
  EXPECT_NEAR(mean[at(12, 8, 2)], ramp(12, 8, 2), 1e-6);
  EXPECT_EQ(mean[at(31, 17, 3)], 1);
}

TEST_F(NonFiniteValues, APictureOfNothingElseAndDepth) {
  make_effect(kSame);
  std::vector<Spot> all;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) all.push_back({x, y, c, kNan});
  make("a.exr", all);
  for (const std::string policy : {"zero", "neighbour"}) {
    ASSERT_EQ(run_look({"--nan-policy", policy}).exit_code, kDone);
    for (std::size_t i = 0; i < load("o.exr").size(); i += 97) EXPECT_EQ(load("o.exr")[i], i % 4 == 3 ? 1 : 0);
  }
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.outline { source = \"depth\" } }\n");
  make("a.exr", {{3, 2, 4, kNan}}, 5);
  const Outcome far = run_look();
  EXPECT_THAT(far.err, HasSubstr("depth: 1 NaN, first at pixel 3,2: (nan)"));
  const auto with_hole = load("o.exr");
  ASSERT_EQ(run_look({"--nan-policy", "neighbour"}).exit_code, kDone);
  const auto mended = load("o.exr");
  EXPECT_EQ(with_hole[at(2, 2, 0)], 0) << "the hole is far away: an outline";
  EXPECT_EQ(mended[at(2, 2, 0)], ramp(2, 2, 0)) << "its neighbours are as near as it is";
}

TEST_F(NonFiniteValues, PlacesHoldInRegionsAndHalfFloats) {
  make("a.exr", {});
  make_effect(kDivide, ", fx.tone_mapping {}");
  const Outcome inside = run_look({"--region", "4,2,10,8"});
  EXPECT_THAT(inside.err, HasSubstr("made 7 NaN, 7 +Inf, first at pixel 5,3"));
  EXPECT_THAT(run_look({"--region", "8,2,10,8"}).err, IsEmpty()) << "nothing there";
  EXPECT_THAT(run_look({"--precision", "fp16"}).err, HasSubstr("made 15 NaN, 15 +Inf, first at pixel 5,3"));
}

TEST_F(NonFiniteValues, OverflowOfHalfFloatsIsNamed) {
  make("a.exr", {});
  make_effect("vec4 apply(vec4 color, ivec2 p) { return p == ivec2(4, 9) ? vec4(70000.0, color.gba) : color; }\n");
  const Outcome outcome = run_look({"--precision", "fp16"});
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_THAT(outcome.err,
              HasSubstr("pass 'broken.apply' overflows half floats: 1 samples above 65504, first at pixel 4,9: "
                        "(70000, 0.33, 0.34, 1)"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("were held"))) << "the file has it";
  EXPECT_EQ(load("o.exr")[at(4, 9, 0)], 70000);
  EXPECT_EQ(report()["session"]["clamped_samples"], 0);
  EXPECT_THAT(run_look({"--precision", "fp32"}).err, IsEmpty());
}

/// Half floats that overflow inside of a stack, where the last pass makes small numbers of them.
TEST_F(NonFiniteValues, OverflowInsideAStackIsNamedAndTheFrameMadeInFullFloats) {
  make("a.exr", {});
  write("shaders/deep/up.glsl",
        "uniform sampler2D source;\nvec4 sample_at(ivec2 p) { vec4 c = fetch(source, p); return p == ivec2(4, 9) ? "
        "vec4(92952.0, c.gba) : c; }\n");
  write("shaders/deep/down.glsl",
        "uniform sampler2D source;\nvec4 sample_at(ivec2 p) { return fetch(source, p) * vec4(vec3(0.5), 1.0); }\n");
  write("effects/deep.lua",
        "local fx = require \"afterglow\"\nreturn fx.effect { name = \"deep\", at = \"post_process\", settings = {}, "
        "build = function(g, s, source)\n  local up = g:pass { shader = \"deep/up\", source = source, name = \"up\" }\n"
        "  return g:pass { shader = \"deep/down\", source = up, name = \"down\" }\nend }\n");
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.deep {} }\n");
  const Outcome half = run_look({"--precision", "fp16", "--max-error", "1"});
  EXPECT_EQ(half.exit_code, kDone);
  EXPECT_THAT(half.err, HasSubstr("pass 'deep.up' overflows half floats: 1 samples above 65504, first at pixel 4,9"));
  EXPECT_EQ(load("o.exr")[at(4, 9, 0)], 46476);
  const Json told = report()["frames"][0]["beyond_half_floats"];
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0]["pass"], "deep.up");
  EXPECT_EQ(told[0]["samples"], 1);
}

TEST_F(NonFiniteValues, TransparentPicturesTellToo) {
  make("a.exr", {{5, 12, 3, 0.25f}, {20, 4, 3, 0.0f}});
  make_effect(
      "vec4 apply(vec4 color, ivec2 p) { return p == ivec2(5, 12) ? vec4(color.rgb / (color.a - 0.25), color.a) : "
      "color; }\n");
  EXPECT_THAT(run_look({}, "o.png").err, HasSubstr("made 3 +Inf, first at pixel 5,12"));
  make_effect(kSame);
  const Outcome clean = run_look({}, "o.png");
  EXPECT_THAT(clean.err, IsEmpty());
  EXPECT_EQ(non_finite(), Json::object());
}

TEST_F(NonFiniteValues, SequencesTellOnceAndSumUp) {
  for (int frame = 1; frame <= 4; ++frame)
    make("in/a.000" + std::to_string(frame) + ".exr", {{1, 1, 0, frame % 2 ? kNan : 1.0f}});
  make_effect(kDivide);
  fs::create_directory(path("out"));
  const Outcome outcome = run({"run", "look.lua", "in/a.####.exr", "-o", "out/a.####.exr", "--report", "report.json"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_EQ(outcome.err.find("pass 'broken.apply' made"), outcome.err.rfind("pass 'broken.apply' made"));
  EXPECT_THAT(outcome.err,
              HasSubstr("samples that were not finite, in 4 of 4 frames: 2 from input color, 120 from pass "
                        "broken.apply"));
  for (int frame = 0; frame < 4; ++frame) {
    EXPECT_EQ(non_finite(frame)["passes"][0]["nan"], 15);
    EXPECT_EQ(non_finite(frame).contains("input"), frame % 2 == 0);
  }
}

TEST_F(NonFiniteValues, HistoriesGoOnMended) {
  for (int frame = 1; frame <= 3; ++frame) make("in/a.000" + std::to_string(frame) + ".exr", {});
  write("shaders/keeps/add.glsl",
        "uniform float frame;\nuniform sampler2D source, before;\n"
        "vec4 sample_at(ivec2 p) { vec4 c = fetch(source, p) + fetch(before, p);\n"
        "  return frame == 2.0 && p == ivec2(8, 8) ? vec4(c.rgb / (fetch(source, p).a - 1.0), 1.0) : vec4(c.rgb, 1.0); "
        "}\n");
  write("shaders/keeps/show.glsl", "vec4 apply(vec4 color, vec4 kept) { return vec4(kept.rgb, color.a); }\n");
  write("effects/keeps.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.effect { name = \"keeps\", settings = {}, build = function(g, s, source)\n"
        "  local before = g:history { size = source, pre_roll = 1 }\n"
        "  local sum = g:pass { shader = \"keeps/add\", source = source, before = before, frame = g.frame, size = "
        "source, name = \"add\" }\n"
        "  g:keep(before, sum)\n"
        "  return g:pass { shader = \"keeps/show\", source = source, kept = sum, name = \"show\" }\n"
        "end }\n");
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.keeps {} }\n");
  fs::create_directory(path("out"));
  const Outcome outcome =
      run({"run", "look.lua", "in/a.####.exr", "-o", "out/a.####.exr", "--type", "float", "--report", "report.json"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("pass 'keeps.add' made 3 +Inf, first at pixel 8,8"));
  EXPECT_TRUE(non_finite(0).empty());
  EXPECT_FALSE(non_finite(1).empty());
  EXPECT_TRUE(non_finite(2).empty()) << "what was handed on had been mended";
  EXPECT_EQ(load("out/a.0002.exr")[at(8, 8, 0)], 0);
  EXPECT_EQ(load("out/a.0003.exr")[at(8, 8, 0)], ramp(8, 8, 0));
  EXPECT_NEAR(load("out/a.0003.exr")[at(9, 8, 0)], 3 * ramp(9, 8, 0), 1e-6);
}

TEST_F(NonFiniteValues, UnknownPoliciesAreRefused) {
  make("a.exr", {});
  make_effect(kSame);
  const Outcome outcome = run_look({"--nan-policy", "ignore"});
  EXPECT_EQ(outcome.exit_code, kUsage);
  EXPECT_THAT(outcome.err, HasSubstr("zero"));
}

}  // namespace
}  // namespace afterglow::test
