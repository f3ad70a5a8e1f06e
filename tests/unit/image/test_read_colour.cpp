// SPDX-License-Identifier: MIT
// Profiles, alpha and orientation of real files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcms2.h>

#include "image/color_matrix.h"
#include "image/icc_profile.h"
#include "image/orientation.h"
#include "image/srgb.h"
#include "make_files.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {

TEST(ReadColour, AdobeRgbProfile) {
  const auto file = test_image("ldr/rocket.jpg");
  const Picture picture = read_or_fail(file);
  const auto input = OIIO::ImageInput::open(file.string());
  std::vector<unsigned char> codes(640 * 427 * 3);
  ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeUInt8, codes.data()));
  // Adobe RGB (1998): exponent 563/256, its own green.
  const Matrix3 matrix = to_rec709({{0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}, {0.3127, 0.3290}});
  for (std::size_t i = 0; i < codes.size() / 3; i += 97) {
    double rgb[3];
    for (std::size_t c = 0; c < 3; ++c) rgb[c] = std::pow(codes[i * 3 + c] / 255.0, 563.0 / 256);
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_NEAR(picture.color.pixels[i * 4 + c],
                  std::max(matrix[c][0] * rgb[0] + matrix[c][1] * rgb[1] + matrix[c][2] * rgb[2], 0.0), 2e-3);
  }
}

TEST(ReadColour, SrgbProfileAndSoftStraightAlpha) {
  const auto file = test_image("ldr/wesaturate_alpha.png");
  const Picture picture = read_or_fail(file);
  ASSERT_TRUE(picture.has_alpha);
  OIIO::ImageSpec raw;
  raw.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open(file.string(), &raw);
  std::vector<unsigned char> codes(500 * 500 * 4);
  ASSERT_TRUE(input->read_image(0, 0, 0, 4, OIIO::TypeUInt8, codes.data()));
  for (std::size_t i = 0; i < codes.size(); i += 4) {
    const double alpha = codes[i + 3] / 255.0;
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_NEAR(picture.color.pixels[i + c], srgb_to_linear(codes[i + c] / 255.0) * alpha, 1e-6);
    ASSERT_NEAR(picture.color.pixels[i + 3], alpha, 1e-6);
  }
}

/// A curve of grey gives L* where the profile meets others in Lab.
TEST(ReadColour, GreyProfilesThatMeetInLab) {
  cmsToneCurve* straight = cmsBuildGamma(nullptr, 1.0);
  cmsHPROFILE profile = cmsCreateGrayProfile(cmsD50_xyY(), straight);
  cmsSetPCS(profile, cmsSigLabData);
  cmsUInt32Number size = 0;
  ASSERT_TRUE(cmsSaveProfileToMem(profile, nullptr, &size));
  std::vector<std::uint8_t> bytes(size);
  ASSERT_TRUE(cmsSaveProfileToMem(profile, bytes.data(), &size));
  cmsCloseProfile(profile);
  cmsFreeToneCurve(straight);
  ColorEncoding encoding;
  encoding.max_code = 255;
  encoding.grey = true;
  ASSERT_TRUE(use_icc_profile(bytes, 1, encoding));
  ASSERT_EQ(encoding.curve, TransferCurve::tables);
  for (const int code : {0, 10, 64, 128, 200, 255}) {
    const double lightness = 100 * code / 255.0;  // CIE 15: L* to Y
    const double light = lightness > 8 ? std::pow((lightness + 16) / 116, 3) : lightness * 27 / 24389;
    for (const auto& table : encoding.tables) EXPECT_NEAR(table[static_cast<std::size_t>(code)], light, 2e-3) << code;
  }
}

TEST(ReadColour, DamagedProfileIsWarnedAboutAndIgnored) {
  const TemporaryFolder folder;
  OIIO::ImageSpec spec = make_spec(1, 1, {"R", "G", "B"}, OIIO::TypeUInt8);
  std::vector<std::uint8_t> profile = srgb_icc_profile();
  std::fill(profile.begin() + 36, profile.begin() + 40, 'x');  // the magic number "acsp"
  spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(profile.size())), profile.data());
  ASSERT_NO_FATAL_FAILURE(make_file(folder / "in.tif", {spec}, {{0.5f, 0.5f, 0.5f}}));
  Messages messages;
  const auto picture = read_picture(folder / "in.tif", {}, messages.diagnostics);
  ASSERT_TRUE(picture);
  EXPECT_NEAR(picture.value().color.pixels[0], srgb_to_linear(128 / 255.0), 1e-6);
  ASSERT_EQ(messages.warnings.size(), 1u);
  EXPECT_THAT(messages.warnings[0], testing::HasSubstr("profile"));
}

class Orientations : public testing::TestWithParam<int> {};

TEST_P(Orientations, OfTiffAndJpeg) {
  const TemporaryFolder folder;
  for (const char* extension : {"tif", "jpg"}) {
    OIIO::ImageSpec spec = make_spec(24, 16, {"R", "G", "B"}, OIIO::TypeUInt8);
    spec.attribute("Orientation", GetParam());
    spec.attribute("CompressionQuality", 100);
    std::vector<float> samples;  // four quarters of different brightness
    Image stored(24, 16, 1);
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 24; ++x) {
        const float v = (x < 16 ? 0.2f : 0.5f) + (y < 8 ? 0.0f : 0.3f);
        *stored.at(x, y) = v;
        samples.insert(samples.end(), {v, v, v});
      }
    const auto file = folder / (std::string("in.") + extension);
    ASSERT_NO_FATAL_FAILURE(make_file(file, {spec}, {samples}));
    const Picture picture = read_or_fail(file);
    const Image wanted = upright(stored, GetParam());
    ASSERT_EQ(picture.color.size(), wanted.size()) << extension;
    EXPECT_EQ(picture.data_window.size(), wanted.size());
    for (int y = 0; y < wanted.height; ++y)
      for (int x = 0; x < wanted.width; ++x)
        ASSERT_NEAR(linear_to_srgb(picture.color.at(x, y)[0]), *wanted.at(x, y), 3.0 / 255)
            << extension << " " << x << "," << y;
  }
}
INSTANTIATE_TEST_SUITE_P(All, Orientations, testing::Range(1, 9));

}  // namespace
}  // namespace afterglow
