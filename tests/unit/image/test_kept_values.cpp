// SPDX-License-Identifier: MIT
// Time codes, rates and numbers from each format into each that has a place for them.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "image/kept_values.h"
#include "image/time_code.h"
#include "image/writer.h"
#include "make_files.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {

TEST(KeptValues, RatesAreThoseOfTelevisionWhereTheyAreNear) {
  const auto text = [](const MetadataValue& value) {
    const auto rate = rate_of(value);
    return rate ? std::to_string(rate->numerator) + "/" + std::to_string(rate->denominator) : "";
  };
  EXPECT_EQ(text(24.0f), "24/1");
  EXPECT_EQ(text(23.976f), "24000/1001");
  EXPECT_EQ(text(29.97f), "30000/1001");
  EXPECT_EQ(text(59.94006f), "60000/1001");
  EXPECT_EQ(text(12.5f), "12500/1000");
  EXPECT_EQ(text(Rational{25, 1}), "25/1");
  EXPECT_EQ(text(std::string("24000/1001")), "24000/1001");
  EXPECT_EQ(text(std::string("25")), "25/1");
  for (const MetadataValue& wrong : {MetadataValue(0.0f), MetadataValue(-24.0f), MetadataValue(INFINITY),
                                     MetadataValue(std::string("soon")), MetadataValue(Rational{24, 0})})
    EXPECT_EQ(text(wrong), "");
}

TEST(KeptValues, NumbersAreTextThatIsReadBack) {
  EXPECT_EQ(text_of_number(Rational{1, 50}), "1/50");
  EXPECT_EQ(std::get<Rational>(*number_of_text("ExposureTime", "1/50")).denominator, 50);
  EXPECT_EQ(std::get<int>(*number_of_text("Exif:ISOSpeedRatings", text_of_number(800))), 800);
  EXPECT_EQ(std::get<float>(*number_of_text("FNumber", text_of_number(2.8f))), 2.8f);
  EXPECT_EQ(std::get<float>(*number_of_text("FNumber", text_of_number(8.0f))), 8) << "a fraction for Exif";
  for (const char* wrong : {"", "f/2.8", "1/0", "inf", "2,8"}) EXPECT_FALSE(number_of_text("FNumber", wrong)) << wrong;
}

class KeptBetween : public testing::Test {
 protected:
  void SetUp() override {
    OIIO::ImageSpec spec = make_spec(8, 8, {"R", "G", "B"}, OIIO::TypeHalf);
    const std::uint32_t code[2] = {0x01020304, 0};
    const int rate[2] = {24000, 1001};
    spec.attribute("smpte:TimeCode", OIIO::TypeTimeCode, code);
    spec.attribute("FramesPerSecond", OIIO::TypeRational, rate);
    spec.attribute("Artist", "Me");
    spec.attribute("ExposureTime", 0.25f);
    spec.attribute("FNumber", 2.8f);
    spec.attribute("isoSpeed", 800.0f);
    spec.attribute("XResolution", 300.0f);
    spec.attribute("YResolution", 300.0f);
    spec.attribute("ResolutionUnit", "in");
    make_file(folder_ / "in.exr", {spec}, {marks(8, 8, 3)});
  }
  /// Through files with these endings, one after the other; what the last one says.
  OIIO::ImageSpec through(const std::vector<std::string>& endings) const {
    std::string from = "in.exr";
    for (const auto& ending : endings) {
      const std::string to = "by." + from + ending;
      Diagnostics silent;
      const auto written = write_picture(read_or_fail(folder_ / from), folder_ / to, {}, silent);
      EXPECT_TRUE(written) << written.error().text();
      from = to;
    }
    const auto input = OIIO::ImageInput::open((folder_ / from).string());
    EXPECT_TRUE(input) << from;
    return input ? input->spec() : OIIO::ImageSpec();
  }
  static std::uint32_t code_of(const OIIO::ImageSpec& spec) {
    const auto* found = spec.find_attribute("smpte:TimeCode", OIIO::TypeTimeCode);
    return found ? *static_cast<const std::uint32_t*>(found->data()) : 0;
  }
  static std::pair<int, int> rate_in(const OIIO::ImageSpec& spec) {
    const auto* found = spec.find_attribute("FramesPerSecond", OIIO::TypeRational);
    const auto* parts = found ? static_cast<const int*>(found->data()) : nullptr;
    return parts ? std::pair(parts[0], parts[1]) : std::pair(0, 0);
  }
  /// What OpenImageIO calls an EXR's isoSpeed goes by its version.
  static float iso_in(const OIIO::ImageSpec& spec) {
    for (const char* name : {"isoSpeed", "Exif:ISOSpeedRatings", "Exif:PhotographicSensitivity"})
      if (spec.find_attribute(name)) return spec.get_float_attribute(name);
    return 0;
  }
  TemporaryFolder folder_;
};

TEST_F(KeptBetween, ExrAndPng) {
  const auto png = through({".png"});
  EXPECT_EQ(png.get_string_attribute("smpte:TimeCode"), "01:02:03:04");
  EXPECT_EQ(png.get_string_attribute("FramesPerSecond"), "24000/1001");
  EXPECT_EQ(png.get_string_attribute("FNumber"), "2.8");
  EXPECT_NEAR(png.get_float_attribute("XResolution"), 300, 0.01);
  for (const auto& way : {std::vector<std::string>{".png", ".exr"}, {".exr"}, {".png", ".png", ".exr"}}) {
    const auto exr = through(way);
    EXPECT_EQ(code_of(exr), 0x01020304u);
    EXPECT_EQ(rate_in(exr), std::pair(24000, 1001));
    EXPECT_EQ(exr.get_string_attribute("Artist"), "Me");
    EXPECT_EQ(exr.get_float_attribute("FNumber"), 2.8f);
    EXPECT_EQ(exr.get_float_attribute("ExposureTime"), 0.25f);
    EXPECT_EQ(iso_in(exr), 800);
    EXPECT_NEAR(exr.get_float_attribute("XResolution"), 300, 0.01);
    EXPECT_NEAR(exr.get_float_attribute("YResolution"), 300, 0.01);
  }
}

TEST_F(KeptBetween, ExrAndDpx) {
  EXPECT_EQ(code_of(through({".dpx"})), 0x01020304u);
  EXPECT_NEAR(through({".dpx"}).get_float_attribute("dpx:FrameRate"), 23.976, 1e-3);
  const auto exr = through({".dpx", ".exr"});
  EXPECT_EQ(code_of(exr), 0x01020304u);
  EXPECT_EQ(rate_in(exr), std::pair(24000, 1001));
}

TEST_F(KeptBetween, ExrAndJpeg) {
  const auto jpeg = through({".jpg"});
  EXPECT_EQ(jpeg.get_int_attribute("Exif:PhotographicSensitivity"), 800);
  EXPECT_NEAR(jpeg.get_float_attribute("FNumber"), 2.8, 1e-3);
  const auto exr = through({".jpg", ".exr"});
  EXPECT_EQ(iso_in(exr), 800);
}

TEST_F(KeptBetween, ResolutionGoesIntoAllThatHaveIt) {
  for (const auto& way : {std::vector<std::string>{".jpg"},
                          {".tif"},
                          {".png", ".jpg"},
                          {".png", ".tif"},
                          {".jpg", ".exr"},
                          {".tif", ".exr"}}) {
    const auto spec = through(way);
    EXPECT_NEAR(spec.get_float_attribute("XResolution"), 300, 0.01) << way.front() << way.back();
    EXPECT_EQ(spec.get_string_attribute("ResolutionUnit").substr(0, 2), "in") << way.front() << way.back();
  }
}

TEST_F(KeptBetween, ResolutionTurnsWithThePixels) {
  OIIO::ImageSpec spec = make_spec(8, 4, {"R", "G", "B"}, OIIO::TypeUInt8);
  spec.attribute("Orientation", 6);
  spec.attribute("XResolution", 300.0f);
  spec.attribute("YResolution", 150.0f);
  spec.attribute("PixelAspectRatio", 0.5f);
  spec.attribute("ResolutionUnit", "in");
  make_file(folder_ / "turned.tif", {spec}, {marks(8, 4, 3)});
  Diagnostics silent;
  // PNG counts whole pixels of a metre.
  const Picture turned = read_or_fail(folder_ / "turned.tif");
  for (const char* name : {"o.tif", "o.png"}) {
    ASSERT_TRUE(write_picture(turned, folder_ / name, {}, silent));
    const auto written = OIIO::ImageInput::open((folder_ / name).string());
    ASSERT_TRUE(written) << name;
    EXPECT_EQ(written->spec().width, 4) << name;
    EXPECT_NEAR(written->spec().get_float_attribute("XResolution"), 150, 0.02) << name;
    EXPECT_NEAR(written->spec().get_float_attribute("YResolution"), 300, 0.02) << name;
  }
}

/// 300 dots across an inch and 600 down it: each is twice as wide as high. Without a unit JPEG's numbers are the width
/// and the height themselves.
TEST_F(KeptBetween, DotsOfAnInchAreTheShapeOfJpegsPixels) {
  OIIO::ImageSpec spec = make_spec(8, 4, {"R", "G", "B"}, OIIO::TypeUInt8);
  spec.attribute("XResolution", 300.0f);
  spec.attribute("YResolution", 600.0f);
  spec.attribute("PixelAspectRatio", 2.0f);  // of which the library makes YResolution
  spec.attribute("ResolutionUnit", "in");
  make_file(folder_ / "wide.tif", {spec}, {marks(8, 4, 3)});
  Diagnostics silent;
  ASSERT_TRUE(write_picture(read_or_fail(folder_ / "wide.tif"), folder_ / "wide.jpg", {}, silent));
  std::ifstream in(folder_ / "wide.jpg", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(bytes.substr(6, 5), std::string("JFIF\0", 5));
  EXPECT_EQ(bytes.substr(13, 5), std::string("\1\x01\x2c\x02\x58", 5)) << "inches, 300, 600";
  const Picture wide = read_or_fail(folder_ / "wide.jpg");
  const MetadataValue* shape = find_metadata(wide.facts->metadata, "PixelAspectRatio");
  ASSERT_TRUE(shape);
  EXPECT_EQ(metadata_number(*shape, 0), 2);
  ASSERT_TRUE(write_picture(wide, folder_ / "wide.exr", {}, silent));
  EXPECT_EQ(OIIO::ImageInput::open((folder_ / "wide.exr").string())->spec().get_float_attribute("PixelAspectRatio"), 2);
}

TEST_F(KeptBetween, PixelsThatAreNotSquareAreTold) {
  struct {
    const char* name;
    float ratio;
    int orientation;
    const char* said;  ///< null: nothing
  } const cases[] = {{"wide.tif", 2, 1, "2 times as wide as high"},
                     {"turned.tif", 2, 6, "0.5 times as wide as high"},
                     {"wide.exr", 1.422f, 1, "1.42 times as wide as high"},
                     {"square.exr", 1, 1, nullptr},
                     {"nearly.exr", 1.005f, 1, nullptr}};
  for (const auto& c : cases) {
    OIIO::ImageSpec spec = make_spec(8, 4, {"R", "G", "B"}, OIIO::TypeHalf);
    spec.attribute("PixelAspectRatio", c.ratio);
    spec.attribute("Orientation", c.orientation);
    make_file(folder_ / c.name, {spec}, {marks(8, 4, 3)});
    std::string said;
    Diagnostics heard([&](Severity severity, const std::string& text) {
      if (severity == Severity::warning) said += text;
    });
    ASSERT_TRUE(read_picture(folder_ / c.name, {}, heard)) << c.name;
    if (c.said)
      EXPECT_NE(said.find(c.said), std::string::npos) << c.name << ": " << said;
    else
      EXPECT_EQ(said, "") << c.name;
  }
}

TEST_F(KeptBetween, WhatJpegSaysTwiceIsNotDoubled) {
  EXPECT_EQ(through({".jpg", ".jpg", ".jpg"}).get_string_attribute("IPTC:Creator"), "Me");
}

}  // namespace
}  // namespace afterglow
