// SPDX-License-Identifier: MIT
// What newcomers read where a command does something else than they mean.
#include "cli_test.h"

namespace afterglow::test {
namespace {

class CliHints : public CliTest {};

TEST_F(CliHints, ANameDoesNotMeanAFileOfThisFolder) {
  fs::copy_file(preset("neon_night.lua"), path("neon_night.lua"));
  make_exr("a.exr");
  const std::string told = "neon_night.lua of this folder is another one: write neon_night.lua for it\n";
  for (const auto& arguments : {std::vector<std::string>{"check", "neon_night"},
                                {"explain", "neon_night", "bloom.intensity"},
                                {"graph", "neon_night"},
                                {"run", "neon_night", "a.exr", "-o", "a.png"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    const auto first = outcome.err.find(told);
    EXPECT_THAT(outcome.err, HasSubstr("warning: 'neon_night' is /")) << arguments[0];
    EXPECT_NE(first, std::string::npos) << arguments[0] << ": " << outcome.err;
    EXPECT_EQ(outcome.err.find(told, first + 1), std::string::npos) << "once";
  }
  for (const auto& arguments : {std::vector<std::string>{"check", "neon_night.lua"},
                                {"check", "./neon_night.lua"},
                                {"check", "plain_aces"},
                                {"check", "neon_night", "--path", "."}})
    EXPECT_THAT(run(arguments).err, IsEmpty()) << arguments[1];
}

TEST_F(CliHints, FramesThatAreNotThereAreOneMessage) {
  make_preset("look.lua");
  for (const char* name : {"s.0001.exr", "s.0002.exr", "s.0011.exr"}) make_exr(name);
  const Outcome outcome = run({"run", "look.lua", "s.####.exr", "-o", "g/", "--frames", "1-12,20-30x5,99"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  const auto end = outcome.err.find("s.0099.exr: error: no such file\n");
  EXPECT_NE(end, std::string::npos);
  EXPECT_THAT(outcome.err,
              ::testing::StartsWith("s.0003.exr: error: no such file, and 7 more up to s.0010.exr are not there\n"
                                    "s.0012.exr: error: no such file, and 1 more up to s.0020.exr are not there\n"))
      << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("s.0025.exr: error: no such file, and 1 more up to s.0030.exr are not there\n"));
  EXPECT_TRUE(fs::exists(path("g/s.0011.png")) || fs::exists(path("g/s.0011.exr")));
}

TEST_F(CliHints, OutputsWithoutAnExtension) {
  make_preset("look.lua");
  make_exr("a.exr");
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "graded"});
  EXPECT_EQ(outcome.exit_code, kUsage);
  EXPECT_THAT(outcome.err, HasSubstr("graded: error: has no extension that tells its format; allowed: .exr"));
  EXPECT_THAT(outcome.err, HasSubstr("; a folder is written graded/"));
  EXPECT_THAT(run({"run", "look.lua", "a.exr", "-o", "a.xyz"}).err, Not(HasSubstr("a folder")));
}

TEST_F(CliHints, PatternsWithOtherDigits) {
  make_preset("look.lua");
  make_exr("s.0001.exr");
  const Outcome outcome = run({"run", "look.lua", "s.###.exr", "-o", "g/"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_EQ(outcome.err,
            "s.###.exr: error: no file matches this pattern: it has 3 digits, and s.0001.exr has 4; did you mean "
            "'s.####.exr'?\n");
}

TEST_F(CliHints, PatternsInAnotherCase) {
  make_preset("look.lua");
  make_exr("SHOT_0001.EXR");
  const Outcome outcome = run({"run", "look.lua", "shot_###.exr", "-o", "g/"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_EQ(outcome.err, "shot_###.exr: error: no file matches this pattern; did you mean 'SHOT_####.EXR'?\n");
}

TEST_F(CliHints, FramesThatAreNoNumbers) {
  for (const char* command : {"check", "explain", "graph"}) {
    const Outcome outcome = run({command, "plain_aces", "--frame", "abc"});
    EXPECT_EQ(outcome.exit_code, kUsage);
    EXPECT_THAT(outcome.err, HasSubstr("abc is no number of a frame")) << command;
    EXPECT_THAT(outcome.err, Not(HasSubstr("FLOAT")));
  }
  EXPECT_THAT(run({"bake", "plain_aces", "-o", "a.cube", "--frame", "abc"}).err, HasSubstr("no number of a frame"));
  EXPECT_EQ(run({"check", "plain_aces", "--frame", "-12"}).exit_code, kDone);
}

TEST_F(CliHints, EffectsOfThisFolderTakeAPath) {
  for (const auto& arguments :
       {std::vector<std::string>{"effects", "dim_corners"}, {"stress", "--effect", "dim_corners"}})
    EXPECT_THAT(run(arguments).err, HasSubstr("; effects of yours with --path FOLDER (--path . for this one's)"));
}

class ShaderHints : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    write("effects/mine.lua",
          "return require(\"afterglow\").effect { name = \"mine\", build = function(g, s, image)\n"
          "return g:pass { shader = \"mine/mine\", source = image } end }");
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.mine {} }");
  }
  std::string error(const std::string& include, const std::string& value) const {
    write("shaders/mine/mine.glsl",
          "#include \"lib/" + include + ".glsl\"\nvec4 apply(vec4 color) { return color * " + value + "; }\n");
    return run({"check", "look.lua"}).err;
  }
};

TEST_F(ShaderHints, FunctionsOfTheLibraryAreToldAsTheyAre) {
  EXPECT_THAT(error("color", "lerp(0.1, 0.2, 0.5)"),
              HasSubstr("mine.glsl:2: error: 'lerp': no matching overloaded function found; it is lerp(vec3 a, vec3 b, "
                        "float t)\n"));
  EXPECT_THAT(error("finite", "float(not_finite(color.rgb))"), HasSubstr("; it is not_finite(vec4 "));
  EXPECT_THAT(error("alpha", "straight(1.0)"),
              HasSubstr("; it is straight(vec3 light, float alpha) or straight(vec4 color)"));
  EXPECT_THAT(error("color", "float4(1.0)"), HasSubstr("; write vec4"));
}

TEST_F(ShaderHints, WhatStandsInAWrongPlaceIsTold) {
  const auto told = [&](const std::string& shader) {
    write("shaders/mine/mine.glsl", shader);
    return run({"check", "look.lua"}).err;
  };
  EXPECT_THAT(told("vec4 apply(vec4 color) { return color * twice(0.5); }\nfloat twice(float x) { return 2.0 * x; }\n"),
              HasSubstr("mine.glsl:1: error: 'twice': no matching overloaded function found: it stands below, at line "
                        "2, and GLSL knows what stands above alone: move it up\n"));
  EXPECT_THAT(told("#if QUALITY > 1\nvec4 apply(vec4 color) { return color; }\n#endif\n"),
              HasSubstr("mine.glsl:2: error: 'apply' stands in an #if that is not taken here\n"));
  EXPECT_THAT(told("// nothing\n"), HasSubstr("mine/mine.glsl defines none of apply, sample_at, compute_at"));
  EXPECT_THAT(told("vec4 sample_at(ivec2 pixel) { return fetch(source, pixel); }\n"),
              HasSubstr("; it declares one by: uniform sampler2D source;"));
  EXPECT_THAT(told("vec4 apply(vec4 color) { return color * sin(iTime); }\n"),
              HasSubstr("'iTime': undeclared identifier; write a uniform float, to which the script gives g.time"));
}

TEST_F(ShaderHints, SharedVariablesWithoutABarrierAreWarnedAbout) {
  const std::string head =
      "layout(local_size_x = 8, local_size_y = 8) in;\nuniform sampler2D source;\n"
      "shared float t[64];\nvec4 compute_at(ivec2 pixel) {\n"
      "  t[gl_LocalInvocationIndex] = fetch(source, pixel).r;\n";
  const std::string tail = "  return vec4(t[63u - gl_LocalInvocationIndex]);\n}\n";
  write("shaders/mine/mine.glsl", head + tail);
  const Outcome without = run({"check", "look.lua"});
  EXPECT_EQ(without.exit_code, kDone);
  EXPECT_THAT(without.err,
              HasSubstr("mine.glsl:3: 't' is shared, and no barrier() stands between writing and reading"));
  write("shaders/mine/mine.glsl", head + "  barrier();\n" + tail);
  EXPECT_EQ(run({"check", "look.lua"}).err, "");
}

TEST_F(ShaderHints, AShaderThatIsMissingIsNamedWithItsFile) {
  EXPECT_THAT(run({"check", "look.lua"}).err,
              HasSubstr("unknown shader 'mine/mine'; allowed: shaders/mine/mine.glsl beside the preset, or on the "
                        "search path"));
}

}  // namespace
}  // namespace afterglow::test
