// SPDX-License-Identifier: MIT
// Every format and sample type that people bring, at even, odd and tiny sizes.
#include <gtest/gtest.h>

#include "image/srgb.h"
#include "make_files.h"
#include "raw_png.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {

struct Case {
  const char* name;
  const char* extension;
  OIIO::TypeDesc type;
  std::vector<std::string> channels;
  int codes;         ///< largest code of integers; 0: floats, which are linear
  double tolerance;  ///< of the stored value
  bool tiled = false;
};

const Case kCases[] = {
    {"ExrHalf", "exr", OIIO::TypeHalf, {"R", "G", "B"}, 0, 0},
    {"ExrHalfAlpha", "exr", OIIO::TypeHalf, {"R", "G", "B", "A"}, 0, 0},
    {"ExrFloat", "exr", OIIO::TypeFloat, {"R", "G", "B", "A"}, 0, 0},
    {"ExrTiled", "exr", OIIO::TypeHalf, {"R", "G", "B", "A"}, 0, 0, true},
    {"ExrGrey", "exr", OIIO::TypeHalf, {"Y"}, 0, 0},
    {"ExrGreyAlpha", "exr", OIIO::TypeHalf, {"Y", "A"}, 0, 0},
    {"Png8", "png", OIIO::TypeUInt8, {"R", "G", "B"}, 255, 0.5 / 255},
    {"Png8Alpha", "png", OIIO::TypeUInt8, {"R", "G", "B", "A"}, 255, 0.5 / 255},
    {"Png16", "png", OIIO::TypeUInt16, {"R", "G", "B"}, 65535, 0.5 / 65535},
    {"Png16Alpha", "png", OIIO::TypeUInt16, {"R", "G", "B", "A"}, 65535, 0.5 / 65535},
    {"PngGrey", "png", OIIO::TypeUInt8, {"Y"}, 255, 0.5 / 255},
    {"PngGreyAlpha", "png", OIIO::TypeUInt8, {"Y", "A"}, 255, 0.5 / 255},
    {"PngGrey16", "png", OIIO::TypeUInt16, {"Y"}, 65535, 0.5 / 65535},
    {"Tiff8", "tif", OIIO::TypeUInt8, {"R", "G", "B"}, 255, 0.5 / 255},
    {"Tiff16Alpha", "tif", OIIO::TypeUInt16, {"R", "G", "B", "A"}, 65535, 0.5 / 65535},
    {"TiffFloat", "tif", OIIO::TypeFloat, {"R", "G", "B"}, 0, 0},
    {"TiffTiled", "tif", OIIO::TypeUInt8, {"R", "G", "B"}, 255, 0.5 / 255, true},
    {"Hdr", "hdr", OIIO::TypeFloat, {"R", "G", "B"}, 0, 1.0 / 128},
    {"Bmp", "bmp", OIIO::TypeUInt8, {"R", "G", "B"}, 255, 0.5 / 255},
    {"Targa", "tga", OIIO::TypeUInt8, {"R", "G", "B"}, 255, 0.5 / 255},
    {"Sgi", "sgi", OIIO::TypeUInt8, {"R", "G", "B"}, 255, 0.5 / 255},
};

class Formats : public testing::TestWithParam<std::tuple<Case, Size>> {};

TEST_P(Formats, Read) {
  const auto& [c, size] = GetParam();
  const TemporaryFolder folder;
  const auto file = folder / (std::string("in.") + c.extension);
  OIIO::ImageSpec spec = make_spec(size.width, size.height, c.channels, c.type);
  spec.attribute("oiio:UnassociatedAlpha", c.codes > 0 ? 1 : 0);  // samples are stored as they are
  if (c.tiled) spec.tile_width = spec.tile_height = 16;
  const int channels = static_cast<int>(c.channels.size());
  ASSERT_NO_FATAL_FAILURE(make_file(file, {spec}, {marks(size.width, size.height, channels)}));

  const Picture picture = read_or_fail(file);
  ASSERT_EQ(picture.color.size(), size);
  EXPECT_EQ(picture.color.channels, 4);
  EXPECT_EQ(picture.data_window, (Rect{0, 0, size.width, size.height}));
  EXPECT_EQ(picture.display_window, picture.data_window);
  const bool alpha = c.channels.back() == "A", grey = c.channels.front() == "Y";
  EXPECT_EQ(picture.has_alpha, alpha);
  ASSERT_TRUE(picture.facts);
  const auto linear = [&](double stored) { return c.codes > 0 ? srgb_to_linear(stored) : stored; };
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const float* pixel = picture.color.at(x, y);
      // Half a code to either side of the mark: what rounding to the file's codes may have done.
      const double wanted_alpha = alpha ? mark(x, y, channels - 1) : 1;
      ASSERT_NEAR(pixel[3], wanted_alpha, c.tolerance + 1e-7);
      const double factor = alpha && c.codes > 0 ? pixel[3] : 1;  // straight alpha is multiplied
      for (int k = 0; k < 3; ++k) {
        const double stored = mark(x, y, grey ? 0 : k);
        const double low = linear(std::max(stored - c.tolerance, 0.0)) * factor,
                     high = linear(stored + c.tolerance) * factor;
        ASSERT_GE(pixel[k], low - 1e-6) << x << "," << y << " channel " << k;
        ASSERT_LE(pixel[k], high + 1e-6) << x << "," << y << " channel " << k;
      }
    }
  }
}

std::string format_case_name(const testing::TestParamInfo<std::tuple<Case, Size>>& info) {
  const auto& [c, size] = info.param;
  return std::string(c.name) + "_" + std::to_string(size.width) + "x" + std::to_string(size.height);
}
INSTANTIATE_TEST_SUITE_P(All, Formats,
                         testing::Combine(testing::ValuesIn(kCases),
                                          testing::Values(Size{1, 1}, Size{64, 48}, Size{37, 53}, Size{1, 70},
                                                          Size{301, 3})),
                         format_case_name);

class Png : public testing::Test {
 protected:
  Picture read(RawPng& png) {
    write_bytes(folder_ / "in.png", png.finish());
    return read_or_fail(folder_ / "in.png");
  }
  TemporaryFolder folder_;
};

TEST_F(Png, SmallGreyDepths) {
  for (const int bits : {1, 2, 4}) {
    RawPng png(2, 1, bits, 0);
    // First pixel all ones, second zero.
    png.pixels({std::string(1, static_cast<char>(((1 << bits) - 1) << (8 - bits)))});
    const Picture picture = read(png);
    EXPECT_EQ(picture.color.pixels, (std::vector<float>{1, 1, 1, 1, 0, 0, 0, 1})) << bits;
  }
  RawPng middle(1, 1, 2, 0);
  middle.pixels({std::string(1, '\x40')});  // code 1 of 3
  EXPECT_NEAR(read(middle).color.pixels[0], srgb_to_linear(1 / 3.0), 1e-6);
}

TEST_F(Png, Palette) {
  RawPng png(3, 1, 8, 3);
  png.chunk("PLTE", std::string("\xff\x00\x00\x00\xff\x00\x00\x00\x80", 9)).pixels({std::string("\x02\x00\x01", 3)});
  const Picture picture = read(png);
  EXPECT_FALSE(picture.has_alpha);
  EXPECT_NEAR(picture.color.at(0, 0)[2], srgb_to_linear(128 / 255.0), 1e-6);
  EXPECT_EQ(picture.color.at(1, 0)[0], 1);
  EXPECT_EQ(picture.color.at(2, 0)[1], 1);
}

TEST_F(Png, TransparentPalette) {
  RawPng png(2, 1, 8, 3);
  png.chunk("PLTE", std::string("\xff\xff\xff\xff\x00\x00", 6))
      .chunk("tRNS", std::string("\x80", 1))
      .pixels({std::string("\x00\x01", 2)});
  const Picture picture = read(png);
  EXPECT_TRUE(picture.has_alpha);
  EXPECT_NEAR(picture.color.at(0, 0)[0], 128 / 255.0, 1e-6);
  EXPECT_NEAR(picture.color.at(0, 0)[3], 128 / 255.0, 1e-6);
  EXPECT_EQ(picture.color.at(1, 0)[3], 1);
}

TEST_F(Png, GammaChunk) {
  const std::string row("\x80\x80\x80", 3);
  const auto value = [&](std::uint32_t gamma, bool srgb) {
    RawPng png(1, 1, 8, 2);
    if (srgb) png.chunk("sRGB", std::string(1, '\0'));
    png.chunk("gAMA", RawPng::big_endian(gamma)).pixels({row});
    return read(png).color.pixels[0];
  };
  EXPECT_NEAR(value(100000, false), 128 / 255.0, 1e-6);                // linear
  EXPECT_NEAR(value(55556, false), std::pow(128 / 255.0, 1.8), 1e-5);  // an old Macintosh
  EXPECT_NEAR(value(45000, false), std::pow(128 / 255.0, 1 / 0.45), 1e-5);
  EXPECT_NEAR(value(46000, false), std::pow(128 / 255.0, 1 / 0.46), 1e-5);
  EXPECT_NEAR(value(45455, false), srgb_to_linear(128 / 255.0), 1e-6);  // means sRGB
  EXPECT_NEAR(value(100000, true), srgb_to_linear(128 / 255.0), 1e-6);  // the sRGB chunk wins
}

TEST_F(Png, PrimariesChunk) {
  // Display P3 red is outside Rec.709: its green and blue come out negative and are held at 0.
  RawPng png(2, 1, 8, 2);
  std::string chrm;
  for (const std::uint32_t v : {31270u, 32900u, 68000u, 32000u, 26500u, 69000u, 15000u, 6000u})
    chrm += RawPng::big_endian(v);
  png.chunk("gAMA", RawPng::big_endian(45455)).chunk("cHRM", chrm).pixels({std::string("\xff\x00\x00\x80\x80\x80", 6)});
  const Picture picture = read(png);
  EXPECT_NEAR(picture.color.at(0, 0)[0], 1.2249, 1e-3);
  EXPECT_EQ(picture.color.at(0, 0)[1], 0);
  EXPECT_EQ(picture.sanitized.negative, 2u);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(picture.color.at(1, 0)[c], std::pow(128 / 255.0, 1 / 0.45455), 1e-4);  // white stays white
  ReadOptions keep;
  keep.keep_negative = true;
  Diagnostics silent;
  const Picture kept = read_picture(folder_ / "in.png", keep, silent).value();
  EXPECT_NEAR(kept.color.at(0, 0)[0], 1.2249, 1e-3);
  EXPECT_NEAR(kept.color.at(0, 0)[1], -0.0421, 1e-3);
  EXPECT_NEAR(kept.color.at(0, 0)[2], -0.0196, 1e-3);
  EXPECT_EQ(kept.sanitized.negative, 0u);
}

TEST_F(Png, SixteenBitsAreReadWhole) {
  RawPng png(1, 1, 16, 0);
  png.pixels({std::string("\x12\x34", 2)});
  EXPECT_NEAR(read(png).color.pixels[0], srgb_to_linear(0x1234 / 65535.0), 1e-9);
  EXPECT_TRUE(read_header(folder_ / "in.png", {}));
}

TEST(Jpeg, ReadsNearly) {
  const TemporaryFolder folder;
  OIIO::ImageSpec spec = make_spec(33, 17, {"R", "G", "B"}, OIIO::TypeUInt8);
  spec.attribute("CompressionQuality", 100);
  spec.attribute("jpeg:subsampling", "4:4:4");
  std::vector<float> flat;
  for (int i = 0; i < 33 * 17; ++i) flat.insert(flat.end(), {0.8f, 0.4f, 0.2f});
  ASSERT_NO_FATAL_FAILURE(make_file(folder / "in.jpg", {spec}, {flat}));
  const Picture picture = read_or_fail(folder / "in.jpg");
  ASSERT_EQ(picture.color.size(), (Size{33, 17}));
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(linear_to_srgb(picture.color.at(20, 9)[c]), flat[static_cast<std::size_t>(c)], 2.0 / 255);
}

TEST(Tiff, AssociatedAlphaOfIntegersIsDecodedUndivided) {
  const TemporaryFolder folder;
  const OIIO::ImageSpec spec = make_spec(1, 1, {"R", "G", "B", "A"}, OIIO::TypeUInt16);  // no oiio:UnassociatedAlpha
  ASSERT_NO_FATAL_FAILURE(make_file(folder / "in.tif", {spec}, {{0.25f, 0.125f, 0.5f, 0.5f}}));
  const Picture picture = read_or_fail(folder / "in.tif");
  EXPECT_NEAR(picture.color.pixels[0], srgb_to_linear(0.5) * 0.5, 1e-4);
  EXPECT_NEAR(picture.color.pixels[1], srgb_to_linear(0.25) * 0.5, 1e-4);
  EXPECT_NEAR(picture.color.pixels[2], 0.5, 1e-4);
}

TEST(Tiff, PagesAreParts) {
  const TemporaryFolder folder;
  const OIIO::ImageSpec spec = make_spec(4, 3, {"R", "G", "B"}, OIIO::TypeFloat);
  std::vector<float> second(4 * 3 * 3, 0.75f);
  ASSERT_NO_FATAL_FAILURE(make_file(folder / "in.tif", {spec, spec}, {marks(4, 3, 3), second}));
  EXPECT_EQ(read_or_fail(folder / "in.tif").color.at(2, 1)[1], mark(2, 1, 1));
  ReadOptions options;
  options.layer = "page2";
  EXPECT_EQ(read_or_fail(folder / "in.tif", options).color.at(2, 1)[1], 0.75f);
}

}  // namespace
}  // namespace afterglow
