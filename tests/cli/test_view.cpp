// SPDX-License-Identifier: MIT
// Light that stands for codes of a display's view: every output of integers holds those codes, and none says that they
// are sRGB.
#include <cmath>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class View : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    write("effects/show.lua",
          "local fx = require \"afterglow\"\n"
          "return fx.effect { name = \"show\", doc = \"A view.\", at = \"post_process\", order = 200,\n"
          "  space = { needs = \"scene\", makes = \"display\", view = true }, settings = {},\n"
          "  build = function(g, s, source) return g:pass { shader = \"show/show\", source = source } end }\n");
    write("shaders/show/show.glsl", "vec4 apply(vec4 color) { return vec4(vec3(0.18), color.a); }\n");
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.show {} }\n");
    write("same.lua", "local fx = require \"afterglow\"\nreturn fx.stack {}\n");
    write("curve.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.show {}, fx.tone_mapping {} }\n");
    make_exr("a.exr");
  }
  /// What the codes of an output stand for when they are read as sRGB.
  float light(const std::string& look, const std::string& output, std::vector<std::string> more = {}) {
    std::vector<std::string> words{"run", look, "a.exr", "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome made = run(words);
    EXPECT_EQ(made.exit_code, kDone) << made.err;
    std::vector<std::string> back{"run", "same.lua", output, "-o", "back.exr", "--input-space", "srgb"};
    const Outcome came = run(back);
    EXPECT_EQ(came.exit_code, kDone) << came.err;
    const auto pixels = pixels_of("back.exr");
    return pixels.empty() ? 0 : pixels[0];
  }
};

TEST_F(View, IntegersAreItsCodesInEveryOutput) {
  EXPECT_NEAR(light("look.lua", "a.png", {"--type", "uint16"}), 0.18, 1e-3);
  EXPECT_NEAR(light("look.lua", "a.tif", {"--type", "uint16"}), 0.18, 1e-3);
  EXPECT_NEAR(light("look.lua", "a.dpx"), 0.18, 1e-3);
  EXPECT_NEAR(light("look.lua", "a.mkv", {"--codec", "ffv1", "--pix-fmt", "yuv444p10"}), 0.18, 2e-3);
  EXPECT_NEAR(light("look.lua", "asked.dpx", {"--output-space", "linear"}), std::pow((0.18 + 0.055) / 1.055, 2.4),
              1e-3);
}

TEST_F(View, AnotherSpaceForItsCodesIsWarnedAbout) {
  constexpr const char* kTwice =
      "warning: --output-space pq encodes what are codes of a display already; without it "
      "outputs hold the codes as they are";
  for (const char* output : {"a.png", "a.mkv"}) {
    const Outcome asked = run({"run", "look.lua", "a.exr", "-o", output, "--output-space", "pq"});
    EXPECT_EQ(asked.exit_code, kDone) << asked.err;
    EXPECT_THAT(asked.err, HasSubstr(kTwice)) << output;
    EXPECT_THAT(run({"run", "look.lua", "a.exr", "-o", output}).err, Not(HasSubstr("output-space")));
    EXPECT_THAT(run({"run", "curve.lua", "a.exr", "-o", output, "--output-space", "pq"}).err,
                Not(HasSubstr("output-space")));
  }
}

TEST_F(View, NoPictureSaysThatTheyAreSrgb) {
  EXPECT_EQ(run({"run", "look.lua", "a.exr", "-o", "a.png"}).exit_code, kDone);
  EXPECT_THAT(read("a.png"), Not(HasSubstr("sRGB")));
  EXPECT_THAT(read("a.png"), Not(HasSubstr("gAMA")));
  EXPECT_EQ(run({"run", "curve.lua", "a.exr", "-o", "b.png"}).exit_code, kDone);
  EXPECT_THAT(read("b.png"), HasSubstr("sRGB")) << "the curve behind it makes light of its own";
}

TEST_F(View, AnEntryThatDoesNotRunShowsNone) {
  EXPECT_EQ(run({"run", "look.lua", "a.exr", "-o", "a.png", "--set", "show.enabled=false"}).exit_code, kDone);
  EXPECT_THAT(read("a.png"), HasSubstr("sRGB"));
}

}  // namespace
}  // namespace afterglow::test
