// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "image/scale.h"
#include "image/srgb.h"
#include "temporary_folder.h"
#include "written_files.h"

namespace afterglow {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST(Write, EightBitCodesComeBackExactly) {
  const TemporaryFolder folder;
  Picture picture = make_picture(256, 1, false);
  const std::vector<float> table = srgb_decode_table(255);
  for (int i = 0; i < 256; ++i)
    for (int c = 0; c < 3; ++c) picture.color.at(i, 0)[c] = table[static_cast<std::size_t>(i)];
  for (const char* name : {"o.png", "o.tif"}) {
    ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / name));
    const auto codes = samples_of<unsigned char>(folder / name, OIIO::TypeUInt8);
    for (std::size_t i = 0; i < 256; ++i) ASSERT_EQ(codes[i * 3 + 1], i) << name;
  }
}

TEST(Write, DisplayFormatsClampAndSceneFormatsDoNot) {
  const TemporaryFolder folder;
  Picture picture = make_picture(2, 1, false);
  picture.color.pixels = {5, 0.5f, -1, 1, NAN, 1000, 0, 1};
  ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / "o.png"));
  EXPECT_EQ(samples_of<unsigned char>(folder / "o.png", OIIO::TypeUInt8),
            (std::vector<unsigned char>{255, 188, 0, 0, 255, 0}));
  picture.color.pixels[4] = 3;
  ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / "o.exr"));
  EXPECT_EQ(samples_of<float>(folder / "o.exr", OIIO::TypeFloat), (std::vector<float>{5, 0.5f, -1, 3, 1000, 0}));
}

TEST(Write, AlphaZeroKeepsItsColour) {
  const TemporaryFolder folder;
  Picture picture = make_picture(1, 1, true);
  picture.color.pixels = {0.25f, 1, 0, 0};
  ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / "o.png"));
  EXPECT_EQ(samples_of<unsigned char>(folder / "o.png", OIIO::TypeUInt8), (std::vector<unsigned char>{137, 255, 0, 0}));
}

/// As filters of renderers with sharp edges make it.
TEST(Write, AlphaAboveOneIsOneAndTakesNoLight) {
  const TemporaryFolder folder;
  Picture picture = make_picture(1, 1, true);
  picture.color.pixels = {0.25f, 1, 0, 2};
  for (const char* name : {"o.png", "o.tif"}) {
    ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / name));
    EXPECT_EQ(samples_of<unsigned char>(folder / name, OIIO::TypeUInt8),
              (std::vector<unsigned char>{137, 255, 0, 255}));
  }
}

TEST(Write, GlowsWithoutCoverageAreTold) {
  const TemporaryFolder folder;
  Picture picture = make_picture(16, 16, true);
  for (std::size_t i = 0; i < picture.color.pixels.size(); ++i) picture.color.pixels[i] = i % 4 == 3 ? 0.0f : 0.25f;
  const auto warnings = [&](const std::string& name, SampleType type) {
    Messages messages;
    WriteOptions options;
    options.type = type;
    EXPECT_TRUE(write_picture(picture, folder / name, options, messages.diagnostics));
    return messages.warnings;
  };
  for (const char* name : {"o.png", "o.tif", "o.webp"})
    EXPECT_THAT(warnings(name, SampleType::uint8), ElementsAre(HasSubstr("glows where alpha is 0 is not seen")))
        << name;
  EXPECT_THAT(warnings("o.exr", SampleType::half), IsEmpty());
  EXPECT_THAT(warnings("o.tif", SampleType::half), IsEmpty());
  picture.unorm8.resize(picture.color.pixels.size());
  for (std::size_t i = 0; i < picture.unorm8.size(); ++i) picture.unorm8[i] = i % 4 == 3 ? 0 : 137;
  EXPECT_THAT(warnings("o.png", SampleType::uint8), SizeIs(1));
  for (std::size_t i = 0; i < picture.unorm8.size(); ++i) picture.unorm8[i] = i % 4 == 3 ? 0 : 2;
  EXPECT_THAT(warnings("o.png", SampleType::uint8), IsEmpty()) << "too faint to be seen";
  picture.unorm8.clear();
  for (std::size_t i = 3; i < picture.color.pixels.size(); i += 4) picture.color.pixels[i] = 0.01f;
  EXPECT_THAT(warnings("o.png", SampleType::uint8), IsEmpty()) << "straight alpha has it";
}

TEST(Write, JpegGoesOnBlackAndSaysSoWhenItMatters) {
  const TemporaryFolder folder;
  Messages messages;
  Picture picture = make_picture(16, 16, true);
  for (std::size_t i = 0; i < picture.color.pixels.size(); ++i) picture.color.pixels[i] = i % 4 == 3 ? 0.5f : 0.25f;
  ASSERT_TRUE(write_picture(picture, folder / "o.jpg", {}, messages.diagnostics));
  ASSERT_EQ(messages.warnings.size(), 1u);
  EXPECT_THAT(messages.warnings[0], HasSubstr("o.jpg"));
  for (const unsigned char code : samples_of<unsigned char>(folder / "o.jpg", OIIO::TypeUInt8))
    ASSERT_NEAR(code, 137, 1);  // not divided
  for (std::size_t i = 3; i < picture.color.pixels.size(); i += 4) picture.color.pixels[i] = 1;
  messages.warnings.clear();
  ASSERT_TRUE(write_picture(picture, folder / "o.jpg", {}, messages.diagnostics));
  EXPECT_TRUE(messages.warnings.empty());
}

TEST(Write, WindowsCroppedAndPadded) {
  const TemporaryFolder folder;
  for (const char* name : {"openexr/DisplayWindow_t03.exr", "openexr/DisplayWindow_t08.exr"}) {
    const Picture picture = read_or_fail(test_image(name));
    ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / "o.exr"));
    const Picture again = read_or_fail(folder / "o.exr");
    EXPECT_EQ(again.data_window, picture.data_window);
    EXPECT_EQ(again.display_window, picture.display_window);
    EXPECT_EQ(again.color.pixels, picture.color.pixels);
    ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / "o.png"));
    const Picture shown = read_or_fail(folder / "o.png");
    ASSERT_EQ(shown.color.size(), picture.display_window.size());
    for (int y = 0; y < shown.color.height; ++y) {
      for (int x = 0; x < shown.color.width; ++x) {
        const int dx = x + picture.display_window.x - picture.data_window.x,
                  dy = y + picture.display_window.y - picture.data_window.y;
        const bool inside = dx >= 0 && dy >= 0 && dx < picture.color.width && dy < picture.color.height;
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(linear_to_srgb(shown.color.at(x, y)[c]),
                      inside ? std::min(linear_to_srgb(picture.color.at(dx, dy)[c]), 1.0) : 0, 0.502 / 255);
      }
    }
  }
}

TEST(Write, PaddingIsTransparentWhereThereIsAlpha) {
  const TemporaryFolder folder;
  Picture picture = make_picture(1, 1, true);
  picture.color.pixels = {1, 1, 1, 1};
  picture.display_window = {-1, 0, 2, 1};
  ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / "o.png"));
  EXPECT_EQ(samples_of<unsigned char>(folder / "o.png", OIIO::TypeUInt8),
            (std::vector<unsigned char>{0, 0, 0, 0, 255, 255, 255, 255}));
}

TEST(Write, HalfOverflowIsHeldAndSaid) {
  const TemporaryFolder folder;
  Messages messages;
  Picture picture = make_picture(2, 1, false);
  picture.color.pixels = {1e6f, 65504, 1, 1, -1e6f, INFINITY, 1, 1};
  ASSERT_TRUE(write_picture(picture, folder / "o.exr", {}, messages.diagnostics));
  EXPECT_EQ(samples_of<float>(folder / "o.exr", OIIO::TypeFloat),
            (std::vector<float>{65504, 65504, 1, -65504, 65504, 1}));
  ASSERT_EQ(messages.warnings.size(), 1u);
  EXPECT_THAT(messages.warnings[0], HasSubstr("3 samples"));
}

TEST(Write, SampleTypesFollowTheInput) {
  const TemporaryFolder folder;
  const auto type_through = [&](const char* in, OIIO::TypeDesc type, const char* out) {
    make_file(folder / in, 3, 3, {"R", "G", "B"}, type);
    write_or_fail(read_or_fail(folder / in), folder / out);
    return std::string(spec_of(folder / out).format.c_str());
  };
  EXPECT_EQ(type_through("h.exr", OIIO::TypeHalf, "o.exr"), "half");
  EXPECT_EQ(type_through("f.exr", OIIO::TypeFloat, "o.exr"), "float");
  EXPECT_EQ(type_through("b.png", OIIO::TypeUInt8, "o.exr"), "half");
  EXPECT_EQ(type_through("h.exr", OIIO::TypeHalf, "o.png"), "uint8");
  EXPECT_EQ(type_through("w.png", OIIO::TypeUInt16, "o.png"), "uint16");
  EXPECT_EQ(type_through("w.png", OIIO::TypeUInt16, "o.tif"), "uint16");
  EXPECT_EQ(type_through("w.png", OIIO::TypeUInt16, "o.jpg"), "uint8");
  EXPECT_EQ(type_through("f.tif", OIIO::TypeFloat, "o.exr"), "float");
}

TEST(Write, MetadataIsKeptExceptWhatDescribedTheOldFile) {
  const TemporaryFolder folder;
  OIIO::ImageSpec spec = make_spec(20, 10, {"R", "G", "B"}, OIIO::TypeHalf);
  spec.tile_width = spec.tile_height = 16;
  spec.attribute("compression", "piz");
  spec.attribute("Copyright", "someone");
  spec.attribute("ImageDescription", "a room");
  spec.attribute("Camera", "Cam");
  spec.attribute("DateTime", "2026:11:21 13:05:59");
  spec.attribute("where", "Zürich");
  spec.attribute("shot:take", 3);
  spec.attribute("ExposureTime", 0.25f);
  spec.attribute("PixelAspectRatio", 2.0f);
  spec.attribute("Orientation", 1);
  spec.attribute("BlenderMultiChannel", "yes");
  ASSERT_NO_FATAL_FAILURE(make_file(folder / "in.exr", {spec}, {marks(20, 10, 3)}));
  const Picture picture = read_or_fail(folder / "in.exr");

  ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / "o.exr"));
  const OIIO::ImageSpec exr = spec_of(folder / "o.exr");
  EXPECT_EQ(exr.get_string_attribute("Copyright"), "someone");
  EXPECT_EQ(exr.get_string_attribute("Camera"), "Cam");
  EXPECT_EQ(exr.get_int_attribute("shot:take"), 3);
  EXPECT_EQ(exr.get_float_attribute("ExposureTime"), 0.25f);
  EXPECT_EQ(exr.get_float_attribute("PixelAspectRatio"), 2);
  EXPECT_EQ(exr.get_string_attribute("compression"), "zip");
  EXPECT_EQ(exr.tile_width, 0);
  EXPECT_FALSE(exr.find_attribute("BlenderMultiChannel"));
  for (const auto& [size, ratio] : {std::pair(Size{40, 10}, 1.0f), {Size{11, 5}, 2.0f}, {Size{20, 40}, 8.0f}}) {
    Picture scaled = picture;
    scale_picture(scaled, {size});
    for (const char* name : {"scaled.exr", "scaled.png"}) {
      ASSERT_NO_FATAL_FAILURE(write_or_fail(scaled, folder / name));
      EXPECT_NEAR(spec_of(folder / name).get_float_attribute("PixelAspectRatio", 1), ratio, 1e-2) << name;
    }
  }

  ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / "o.png"));
  const OIIO::ImageSpec png = spec_of(folder / "o.png");
  EXPECT_EQ(png.get_string_attribute("Camera"), "Cam");
  EXPECT_EQ(png.get_string_attribute("DateTime"), "2026:11:21 13:05:59");
  EXPECT_EQ(png.get_string_attribute("ImageDescription"), "a room");
  EXPECT_EQ(png.get_string_attribute("where"), "Zürich");
  EXPECT_EQ(spec_of(folder / "o.png").get_string_attribute("oiio:ColorSpace"), "sRGB");
  ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / "o.tif"));
  EXPECT_EQ(spec_of(folder / "o.tif").get_string_attribute("Copyright"), "someone");
  ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / "o.jpg"));
  EXPECT_EQ(spec_of(folder / "o.jpg").get_string_attribute("ImageDescription"), "a room");

  // And back from a display format into EXR.
  ASSERT_NO_FATAL_FAILURE(write_or_fail(read_or_fail(folder / "o.tif"), folder / "back.exr"));
  EXPECT_EQ(spec_of(folder / "back.exr").get_string_attribute("Copyright"), "someone");
}

TEST(Write, PngOfEveryShapeAndDepthOfStrip) {
  // Strips of rows are compressed apart: seams at every height, rows longer than a strip, all levels.
  const TemporaryFolder folder;
  for (const Size size : {Size{1, 5000}, Size{16000, 3}, Size{700, 1500}}) {
    for (const int level : {0, 1, 9}) {
      const Picture picture = make_picture(size.width, size.height, size.width == 700);
      WriteOptions options;
      options.png_level = level;
      options.type = size.width == 1 ? SampleType::uint16 : SampleType::uint8;
      ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / "o.png", options));
      const Picture back = read_or_fail(folder / "o.png");
      ASSERT_EQ(back.color.size(), size);
      for (std::size_t i = 0; i < picture.color.pixels.size(); ++i)
        ASSERT_NEAR(back.color.pixels[i], picture.color.pixels[i], 0.006) << i;
    }
  }
}

TEST(Write, ResolutionOfPng) {
  const TemporaryFolder folder;
  OIIO::ImageSpec spec = make_spec(4, 4, {"R", "G", "B"}, OIIO::TypeUInt8);
  spec.attribute("XResolution", 300.0f);
  spec.attribute("YResolution", 300.0f);
  spec.attribute("ResolutionUnit", "in");
  ASSERT_NO_FATAL_FAILURE(make_file(folder / "in.tif", {spec}, {marks(4, 4, 3)}));
  ASSERT_NO_FATAL_FAILURE(write_or_fail(read_or_fail(folder / "in.tif"), folder / "o.png"));
  const OIIO::ImageSpec png = spec_of(folder / "o.png");
  EXPECT_NEAR(png.get_float_attribute("XResolution"), 300, 0.02);
  EXPECT_NEAR(png.get_float_attribute("YResolution"), 300, 0.02);
}

TEST(Write, ProfilesAreRewrittenToMatch) {
  const TemporaryFolder folder;
  const Picture picture = read_or_fail(test_image("ldr/rocket.jpg"));  // Adobe RGB
  for (const char* name : {"o.jpg", "o.tif"}) {
    ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / name));
    EXPECT_THAT(std::string(spec_of(folder / name).get_string_attribute("ICCProfile:profile_description")),
                HasSubstr("sRGB"))
        << name;
    // Read again, it is the same picture, but for what sRGB cannot show.
    const Picture again = read_or_fail(folder / name);
    for (std::size_t i = 0; i < picture.color.pixels.size(); i += 401) {
      if (i % 4 == 3) continue;
      ASSERT_NEAR(linear_to_srgb(again.color.pixels[i]), std::min(linear_to_srgb(picture.color.pixels[i]), 1.0),
                  name[2] == 'j' ? 0.06 : 0.0021)
          << name;
    }
  }
  ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / "o.png"));
  EXPECT_FALSE(spec_of(folder / "o.png").find_attribute("ICCProfile"));
  EXPECT_THAT(file_bytes(folder / "o.png"), HasSubstr("sRGB"));
}

TEST(Write, OrientationTagIsReset) {
  const TemporaryFolder folder;
  OIIO::ImageSpec spec = make_spec(4, 2, {"R", "G", "B"}, OIIO::TypeUInt8);
  spec.attribute("Orientation", 6);
  ASSERT_NO_FATAL_FAILURE(make_file(folder / "in.tif", {spec}, {marks(4, 2, 3)}));
  const Picture picture = read_or_fail(folder / "in.tif");
  for (const char* name : {"o.tif", "o.jpg", "o.exr"}) {
    ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / name));
    EXPECT_EQ(spec_of(folder / name).get_int_attribute("Orientation", 1), 1) << name;
    EXPECT_EQ(read_or_fail(folder / name).color.size(), (Size{2, 4})) << name;
  }
}

TEST(Write, Compressions) {
  const TemporaryFolder folder;
  const Picture picture = make_picture(40, 40, true);
  for (const char* compression :
       {"none", "rle", "zip", "zips", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab", "dwaa:200", "zip:1", "ZIP"}) {
    WriteOptions options;
    options.compression = compression;
    ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / "o.exr", options)) << compression;
    const std::string stored = spec_of(folder / "o.exr").get_string_attribute("compression");
    EXPECT_TRUE(std::string(compression).starts_with(stored) || stored == "zip") << compression << " became " << stored;
  }
  const auto refused = [&](const char* compression, const char* file) {
    WriteOptions options;
    options.compression = compression;
    const auto checked = check_output(folder / file, options);
    EXPECT_FALSE(checked);
    return checked ? Error{} : checked.error();
  };
  EXPECT_EQ(refused("zipp", "o.exr").nearest, "zip");
  EXPECT_EQ(refused("zipp", "o.exr").kind, ErrorKind::usage);
  EXPECT_THAT(refused("piz:3", "o.exr").message, HasSubstr("no level"));
  EXPECT_THAT(refused("dwaa:x", "o.exr").message, HasSubstr("level"));
  EXPECT_THAT(refused("zip", "o.png").message, HasSubstr("no choice"));
  EXPECT_EQ(refused("lzv", "o.tif").nearest, "lzw");
}

TEST(Write, SameBytesEveryTime) {
  const TemporaryFolder folder;
  const Picture picture = make_picture(300, 200, true);
  for (const char* name : {"o.exr", "o.png", "o.jpg", "o.hdr", "o.dpx", "o.tif"}) {
    WriteOptions options;
    options.dither = true;
    ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / name, options));
    const std::string first = file_bytes(folder / name);
    ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / name, options));
    EXPECT_EQ(first, file_bytes(folder / name)) << name;
  }
  // Neither the name that it had while it was written nor the time of day.
  const std::string dpx = file_bytes(folder / "o.dpx");
  EXPECT_EQ(dpx.substr(36, 100), std::string("o.dpx") + std::string(95, '\0'));
  EXPECT_EQ(dpx.substr(136, 24), std::string(24, '\0'));
  EXPECT_THAT(file_bytes(folder / "o.tif"), HasSubstr("    :  :     :  :  "));
}

// Codes of a flat area of this light.

}  // namespace
}  // namespace afterglow
