// SPDX-License-Identifier: MIT
// What files that are written say of themselves, as other programs read it.
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class Kept : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { name = \"nothing\" }\n");
  }
  static OIIO::ImageSpec spec(OIIO::TypeDesc type = OIIO::TypeHalf) { return {32, 16, 3, type}; }
  /// A ramp from 0 to 1 in every row.
  void make(const std::string& name, const OIIO::ImageSpec& how) const {
    std::vector<float> pixels(static_cast<std::size_t>(how.width) * how.height * 3);
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<float>(i / 3 % 32) / 31;
    const auto output = OIIO::ImageOutput::create(name);
    ASSERT_TRUE(output && output->open(text(name), how)) << name;
    ASSERT_TRUE(output->write_image(OIIO::TypeFloat, pixels.data()) && output->close()) << name;
  }
  OIIO::ImageSpec said_by(const std::string& name) const {
    const auto input = OIIO::ImageInput::open(text(name));
    EXPECT_TRUE(input) << name;
    return input ? input->spec() : OIIO::ImageSpec();
  }
  void through(const std::vector<std::string>& names, const std::vector<std::string>& more = {}) const {
    for (std::size_t i = 1; i < names.size(); ++i) {
      std::vector<std::string> words{"run", "look.lua", names[i - 1], "-o", names[i]};
      if (i + 1 == names.size()) words.insert(words.end(), more.begin(), more.end());
      const Outcome outcome = run(words);
      ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    }
  }
  /// Of what every format holds: up to 1.
  float furthest(const std::string& a, const std::string& b) const {
    const auto one = pixels_of(a), other = pixels_of(b);
    EXPECT_EQ(one.size(), other.size());
    float most = 0;
    for (std::size_t i = 0; i < std::min(one.size(), other.size()); ++i)
      most = std::max(most, std::abs(std::min(one[i], 1.0f) - std::min(other[i], 1.0f)));
    return most;
  }
};

TEST_F(Kept, DpxSaysTheTransferOfWhatItHolds) {
  OIIO::ImageSpec film = spec(OIIO::TypeUInt16);
  film.attribute("oiio:ColorSpace", "KodakLog");
  film.attribute("dpx:Colorimetric", "Printing density");
  film.attribute("dpx:LowData", 95);
  film.attribute("dpx:WhiteLevel", 685.0f);
  film.attribute("dpx:FrameRate", 25.0f);
  film.attribute("dpx:SlateInfo", "reel 7");
  ASSERT_NO_FATAL_FAILURE(make("log.dpx", film));
  ASSERT_NO_FATAL_FAILURE(through({"log.dpx", "light.exr"}));
  const auto expect = [&](const std::string& file, const char* transfer) {
    const OIIO::ImageSpec said = said_by(file);
    EXPECT_EQ(said.get_string_attribute("dpx:Transfer"), transfer) << file;
    EXPECT_EQ(said.get_string_attribute("dpx:Colorimetric"), "User defined") << file;
    EXPECT_FALSE(said.find_attribute("dpx:LowData")) << file;
    EXPECT_FALSE(said.find_attribute("dpx:WhiteLevel")) << file;
    EXPECT_EQ(said.get_float_attribute("dpx:FrameRate"), 25) << file;
    EXPECT_EQ(said.get_string_attribute("dpx:SlateInfo"), "reel 7") << file;
    ASSERT_NO_FATAL_FAILURE(through({file, "again.exr"}));
    EXPECT_LT(furthest("again.exr", "light.exr"), 0.02f) << file << ": read by its own words";
  };
  for (const auto& [space, transfer] : {std::pair{"srgb", "User defined"},
                                        {"cineon", "Logarithmic"},
                                        {"linear", "Linear"},
                                        {"rec709", "ITU-R 709-4"}}) {
    const std::string file = std::string(space) + ".dpx";
    ASSERT_NO_FATAL_FAILURE(through({"log.dpx", file}, {"--output-space", space}));
    expect(file, transfer);
  }
  ASSERT_NO_FATAL_FAILURE(through({"log.dpx", "way.exr", "way.dpx"}, {"--output-space", "srgb"}));
  expect("way.dpx", "User defined");
}

TEST_F(Kept, HalfIsHalfInTiff) {
  ASSERT_NO_FATAL_FAILURE(make("a.exr", spec()));
  ASSERT_NO_FATAL_FAILURE(through({"a.exr", "a.tif"}, {"--type", "half"}));
  EXPECT_EQ(said_by("a.tif").format, OIIO::TypeHalf);
  EXPECT_EQ(furthest("a.tif", "a.exr"), 0);
  ASSERT_NO_FATAL_FAILURE(through({"a.exr", "f.tif"}, {"--type", "float"}));
  EXPECT_EQ(said_by("f.tif").format, OIIO::TypeFloat);
}

TEST_F(Kept, ThePixelKeepsItsShape) {
  OIIO::ImageSpec wide = spec();
  wide.attribute("PixelAspectRatio", 2.0f);
  ASSERT_NO_FATAL_FAILURE(make("a.exr", wide));
  ASSERT_NO_FATAL_FAILURE(through({"a.exr", "a.jpg", "a.tif", "b.jpg", "b.exr"}));
  for (const char* name : {"a.jpg", "a.tif", "b.jpg", "b.exr"})
    EXPECT_EQ(said_by(name).get_float_attribute("PixelAspectRatio"), 2) << name;
  EXPECT_EQ(said_by("a.jpg").get_float_attribute("XResolution"), 144);
  EXPECT_EQ(said_by("a.jpg").get_float_attribute("YResolution"), 72);
}

TEST_F(Kept, AttributesOfOnesOwnStayFromExrToExr) {
  OIIO::ImageSpec own = spec();
  own.attribute("gamma", 2.5f);
  own.attribute("hash", "abc");
  own.attribute("note", 3);
  own.attribute("Version", "v012");
  const float acescg[8] = {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f};
  const float white[2] = {0.32168f, 0.33767f};
  own.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), acescg);
  own.attribute("adoptedNeutral", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::VEC2), white);
  ASSERT_NO_FATAL_FAILURE(make("a.exr", own));
  ASSERT_NO_FATAL_FAILURE(through({"a.exr", "b.exr"}));
  const Imf::InputFile b(text("b.exr").c_str());
  EXPECT_TRUE(b.header().findTypedAttribute<Imf::IntAttribute>("note"));
  EXPECT_TRUE(b.header().findTypedAttribute<Imf::StringAttribute>("Version"));
  EXPECT_TRUE(b.header().find("gamma") != b.header().end());
  ASSERT_TRUE(b.header().findTypedAttribute<Imf::StringAttribute>("hash"));
  EXPECT_EQ(b.header().findTypedAttribute<Imf::StringAttribute>("hash")->value(), "abc");
  EXPECT_TRUE(b.header().find("adoptedNeutral") == b.header().end()) << "pixels are of Rec.709's white now";
  // Without primaries of its own nothing was converted.
  own.erase_attribute("chromaticities");
  ASSERT_NO_FATAL_FAILURE(make("c.exr", own));
  ASSERT_NO_FATAL_FAILURE(through({"c.exr", "d.exr"}));
  const Imf::InputFile d(text("d.exr").c_str());
  EXPECT_TRUE(d.header().find("adoptedNeutral") != d.header().end());
}

TEST_F(Kept, RatesThatAreNoneAreNotKept) {
  OIIO::ImageSpec film = spec(OIIO::TypeUInt16);
  film.attribute("dpx:FrameRate", 1.00985e-39f);
  ASSERT_NO_FATAL_FAILURE(make("a.dpx", film));
  ASSERT_NO_FATAL_FAILURE(through({"a.dpx", "a.png"}));
  EXPECT_FALSE(said_by("a.png").find_attribute("FramesPerSecond"))
      << said_by("a.png").get_string_attribute("FramesPerSecond");
}

TEST_F(Kept, APatternOfAnotherKindIsTold) {
  make_exr("a.0001.exr");
  const Outcome outcome = run({"run", "look.lua", "a.@@@@.exr", "-o", "b.####.exr"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("a.@@@@.exr: error: no such file; the place of a frame's number is written #; did "
                                     "you mean 'a.####.exr'?"));
}

}  // namespace
}  // namespace afterglow::test
