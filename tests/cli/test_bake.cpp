// SPDX-License-Identifier: MIT
// bake: a look as a table, its error, and what cannot be one.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <regex>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class Bake : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    write("look.lua",
          "local fx = require \"afterglow\"\nreturn fx.stack { name = \"Warm & soft\",\n"
          "  fx.color_adjustments { post_exposure = 0.4, contrast = 10, saturation = 12 },\n"
          "  fx.white_balance { temperature = 15 }, fx.tone_mapping { mode = \"agx\" } }\n");
  }
  double largest_difference(const std::string& a, const std::string& b) const {
    const OIIO::ImageBuf one(text(a)), other(text(b));
    return OIIO::ImageBufAlgo::compare(one, other, 0, 0).maxerror;
  }
};

TEST_F(Bake, TheTableDoesWhatTheLookDoes) {
  make_exr("a.exr");
  ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", "direct.png", "--dither", "none"}).exit_code, kDone);
  for (const std::string file : {"log.cube", "log.clf"}) {
    const Outcome outcome = run({"bake", "look.lua", "-o", file, "--size", "33", "--shaper", "log"});
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_THAT(outcome.err, IsEmpty());
    std::smatch found, loading;
    ASSERT_TRUE(std::regex_search(outcome.out, found, std::regex("at most ([0-9.]+), on average ([0-9.]+) of 255")))
        << outcome.out;
    EXPECT_LT(std::stod(found[2]), 0.3);
    // A .clf takes scene-linear light itself, a .cube ACEScct.
    ASSERT_TRUE(std::regex_search(outcome.out, loading, std::regex("\nin a look: (fx\\.lut \\{.*\\})\n")))
        << outcome.out;
    write("table.lua", "local fx = require \"afterglow\"\nreturn fx.stack { " + loading[1].str() + " }\n");
    const Outcome applied = run({"run", "table.lua", "a.exr", "-o", "table.png", "--dither", "none"});
    ASSERT_EQ(applied.exit_code, kDone) << applied.err;
    EXPECT_LE(largest_difference("direct.png", "table.png"), (std::stod(found[1]) + 1) / 255) << file;
  }
}

TEST_F(Bake, NamesWithQuotationMarksAndOtherCases) {
  write("named.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { name = 'My \"best\" look', fx.exposure { ev = 1 } }");
  ASSERT_EQ(run({"bake", "named.lua", "-o", "named.CUBE", "--size", "4"}).exit_code, kDone);
  EXPECT_THAT(read("named.CUBE"), HasSubstr("\nTITLE \"My 'best' look\"\n"));
  const Outcome wrong = run({"bake", "nowhere.lua", "-o", "named.xyz"});
  EXPECT_EQ(wrong.exit_code, kUsage) << "before anything else";
  EXPECT_THAT(wrong.err,
              HasSubstr("named.xyz: error: '.xyz' is no format of tables that can be written; allowed: .cube"));
}

/// Of ACEScct's colours, which lie outside of Rec.709: no clipping on the way where the look says so.
TEST_F(Bake, ALookThatKeepsColoursGetsThemAll) {
  const auto green = [&](const std::string& gamut) {
    write("view.lua", "local fx = require \"afterglow\"\nreturn fx.stack { " + gamut +
                          "fx.ocio_display { config = \"ocio/aces.ocio\", display = \"P3-D65 - Display\" } }\n");
    const Outcome outcome = run({"bake", "view.lua", "-o", "view.cube", "--size", "9", "--shaper", "log"});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("ACEScct to the codes of the look's view"));
    std::istringstream lines(read("view.cube"));
    std::string line;
    for (int i = -3; i <= 4 * 9 + 1; ++i) std::getline(lines, line);  // red 1, green 4, blue 0 of 8
    return std::stod(line);
  };
  EXPECT_GT(green(""), 0.3);
  EXPECT_LT(green("gamut = \"keep\", "), 0.05);
}

TEST_F(Bake, PicturesAndCodes) {
  const Outcome outcome = run({"bake", "look.lua", "-o", "strip.png", "--size", "16"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  const OIIO::ImageBuf strip(text("strip.png"));
  EXPECT_EQ(strip.spec().width, 256);
  EXPECT_EQ(strip.spec().height, 16);
  const Outcome codes = run({"bake", "look.lua", "-o", "codes.cube"});
  ASSERT_EQ(codes.exit_code, kDone);
  EXPECT_THAT(codes.err, HasSubstr("the table cuts off what is above 1; --shaper log takes it"));
  EXPECT_THAT(codes.out,
              HasSubstr("\nin a look: fx.lut { file = \"codes.cube\", input = \"srgb\", output = \"srgb\" }\n"));
  EXPECT_THAT(read("codes.cube"),
              HasSubstr("# sRGB codes to sRGB codes of a display\nTITLE \"Warm & soft\"\nLUT_3D_SIZE 33\n"));
}

TEST_F(Bake, ATableIsOfOneFrame) {
  write(
      "moves.lua",
      "local fx = require \"afterglow\"\nreturn fx.stack { fx.exposure { ev = fx.curve { { 1, 0 }, { 24, -2 } } } }\n");
  const Outcome first = run({"bake", "moves.lua", "-o", "first.cube", "--size", "2"});
  ASSERT_EQ(first.exit_code, kDone) << first.err;
  EXPECT_THAT(first.err, HasSubstr("it is that of frame 1"));
  const Outcome last = run({"bake", "moves.lua", "-o", "last.cube", "--size", "2", "--frame", "24"});
  ASSERT_EQ(last.exit_code, kDone) << last.err;
  EXPECT_THAT(last.err, IsEmpty());
  EXPECT_THAT(read("first.cube"), HasSubstr("1.0000000 1.0000000 1.0000000"));
  EXPECT_THAT(read("last.cube"), HasSubstr("0.5370987 0.5370987 0.5370987"));  // sRGB of a quarter
}

TEST_F(Bake, EffectsThatLookAroundAreRefusedByName) {
  write("wide.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.bloom {}, fx.vignette {}, fx.tone_mapping {}, "
        "fx.film_grain {},\n"
        "  fx.auto_exposure {} }\n");
  const Outcome outcome = run({"bake", "wide.lua", "-o", "wide.cube"});
  EXPECT_EQ(outcome.exit_code, kScript);
  EXPECT_THAT(outcome.err, HasSubstr("a table knows a pixel's colour alone; these effects need more: "));
  for (const char* name : {"bloom (reads around)", "vignette (", "film_grain (", "auto_exposure ("})
    EXPECT_THAT(outcome.err, HasSubstr(name));
  EXPECT_THAT(outcome.err, Not(HasSubstr("tone_mapping (")));
  EXPECT_FALSE(fs::exists(path("wide.cube")));
  EXPECT_THAT(run({"bake", "look.lua", "-o", "look.jpg"}).err, HasSubstr("allowed: .cube, .clf, .png"));
}

}  // namespace
}  // namespace afterglow::test
