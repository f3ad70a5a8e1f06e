// SPDX-License-Identifier: MIT
// Targa, BMP, Radiance, TIFF, PNM, PAM, JPEG 2000: codes as stored, and what the files say of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/file.h"
#include "image/output_format.h"
#include "make_files.h"
#include "temporary_folder.h"
#include "wedge.h"

namespace afterglow {
namespace {
using testing::HasSubstr;

/// Of 2×1 pixels of four bytes, behind a header of `bytes`.
void write_bytes(const std::filesystem::path& file, std::string bytes, const std::string& pixels) {
  ASSERT_TRUE(write_file_atomically(file, bytes + pixels));
}

/// A byte that a header says nothing of, or that no mask is for, is no alpha.
TEST(FourthByte, IsAlphaWhereTheFileSaysSo) {
  const TemporaryFolder folder;
  const std::string colors("\x10\x20\x30\0\x40\x50\x60\0", 8), with_alpha("\x10\x20\x30\0\x40\x50\x60\xff", 8);
  const auto has_alpha = [&](const char* name, const std::string& header, const std::string& pixels) {
    write_bytes(folder / name, header, pixels);
    const Picture picture = read_or_fail(folder / name);
    EXPECT_EQ(picture.color.width, 2);
    if (!picture.has_alpha) {
      EXPECT_NEAR(picture.color.pixels[0], 0.0296, 1e-3) << name << ": 0x30 of sRGB";
      EXPECT_EQ(picture.color.pixels[3], 1) << name;
    }
    return picture.has_alpha;
  };
  const auto targa = [](char attributes) {
    return std::string("\0\0\2\0\0\0\0\0\0\0\0\0\2\0\1\0\x20", 17) + static_cast<char>(0x20 | attributes);
  };
  EXPECT_FALSE(has_alpha("none.tga", targa(0), colors));
  EXPECT_FALSE(has_alpha("none2.tga", targa(0), with_alpha));
  EXPECT_TRUE(has_alpha("alpha.tga", targa(8), with_alpha));
  const std::string bmp(
      "BM\x3e\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\2\0\0\0\1\0\0\0\1\0\x20\0\0\0\0\0\x08\0\0\0"
      "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0",
      54);
  EXPECT_FALSE(has_alpha("none.bmp", bmp, colors));
  EXPECT_TRUE(has_alpha("alpha.bmp", bmp, with_alpha)) << "some programs write it so";
}

TEST(Radiance, ExposureIsTakenBackAndXyzRefused) {
  const TemporaryFolder folder;
  const auto file = [&](const char* name, const std::string& lines) {
    write_bytes(folder / name, "#?RADIANCE\n" + lines + "\n-Y 1 +X 2\n", "\x80\x40\x20\x81\x80\x40\x20\x81");
    return folder / name;
  };
  const Picture plain = read_or_fail(file("plain.hdr", "FORMAT=32-bit_rle_rgbe\n"));
  const Picture exposed =
      read_or_fail(file("exposed.hdr", "EXPOSURE=2.5\nFORMAT=32-bit_rle_rgbe\nEXPOSURE= 2\nEXPOSURE=0\n"));
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_FLOAT_EQ(exposed.color.pixels[i], plain.color.pixels[i] / (i % 4 == 3 ? 1 : 5)) << i;
  EXPECT_NEAR(plain.color.pixels[0], 1, 0.01);
  for (const char* space : {"linear", "acescg", "gamma22"}) {
    ReadOptions options;
    options.input_space = space;
    const Picture a = read_or_fail(folder / "exposed.hdr", options), b = read_or_fail(folder / "plain.hdr", options);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(a.color.pixels[i], b.color.pixels[i] / 5, 1e-7) << "also in the space " << space;
  }
  Messages messages;
  const auto xyz = read_picture(file("xyz.hdr", "FORMAT=32-bit_rle_xyze\n"), {}, messages.diagnostics);
  ASSERT_FALSE(xyz);
  EXPECT_THAT(xyz.error().text(), HasSubstr("holds CIE XYZ"));
}

/// 0 is white, whatever the samples are; alpha is what it is.
TEST(Tiff, WhiteIsZeroWhereItSaysSo) {
  const TemporaryFolder folder;
  const auto number = [](std::uint32_t value, int bytes) {
    std::string out;
    for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 255);
    return out;
  };
  // Two pixels, black and white, of one channel and alpha.
  for (const int bits : {8, 16, 32}) {
    const auto bytes = static_cast<std::uint32_t>(bits / 8);
    const std::string dark(bytes, '\xff'), light(bytes, '\0'), opaque(bytes, '\xff');
    for (const bool alpha : {false, true}) {
      const std::string pixels = alpha ? dark + opaque + light + opaque : dark + light;
      struct Tag {
        std::uint32_t name, type, value;
      };
      std::vector<Tag> tags{{256, 4, 2},
                            {257, 4, 1},
                            {258, 3, static_cast<std::uint32_t>(bits)},
                            {259, 3, 1},
                            {262, 3, 0},
                            {273, 4, 8},
                            {277, 3, alpha ? 2u : 1u},
                            {278, 4, 1},
                            {279, 4, static_cast<std::uint32_t>(pixels.size())}};
      if (alpha) tags.push_back({338, 3, 2});
      std::string list = number(static_cast<std::uint32_t>(tags.size()), 2);
      for (const Tag& tag : tags) {
        const bool pair = alpha && tag.name == 258;  // of both channels
        list += number(tag.name, 2) + number(tag.type, 2) + number(pair ? 2 : 1, 4) +
                (pair ? number(tag.value, 2) + number(tag.value, 2) : number(tag.value, 4));
      }
      write_bytes(folder / "white.tif",
                  "II*" + std::string(1, '\0') + number(8 + static_cast<std::uint32_t>(pixels.size()), 4),
                  pixels + list + number(0, 4));
      const Picture picture = read_or_fail(folder / "white.tif");
      EXPECT_EQ(picture.color.pixels, (std::vector<float>{0, 0, 0, 1, 1, 1, 1, 1}))
          << bits << (alpha ? " with alpha" : "");
    }
  }
}

/// Two rows of three, in the eight orders that the format knows.
TEST(Radiance, EveryOrderOfPixelsStandsUpright) {
  const TemporaryFolder folder;
  constexpr int kWidth = 3, kHeight = 2;
  for (const char* order :
       {"-Y 2 +X 3", "-Y 2 -X 3", "+Y 2 +X 3", "+Y 2 -X 3", "+X 3 -Y 2", "+X 3 +Y 2", "-X 3 -Y 2", "-X 3 +Y 2"}) {
    const std::string text = order;
    const bool columns = text[1] == 'X';
    const bool right = text[columns ? 0 : 5] == '+', down = text[columns ? 5 : 0] == '-';
    std::string pixels;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      const int x = columns ? i / kHeight : i % kWidth, y = columns ? i % kHeight : i / kWidth;
      const int value = (right ? x : kWidth - 1 - x) + kWidth * (down ? y : kHeight - 1 - y);
      pixels += std::string(3, static_cast<char>(128 + value)) + '\x88';  // as they are, 8 bits of 256
    }
    write_bytes(folder / "turned.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + text + "\n", pixels);
    const Picture upright = read_or_fail(folder / "turned.hdr");
    ASSERT_EQ(upright.color.size(), (Size{kWidth, kHeight})) << order;
    for (std::size_t i = 0; i < kWidth * kHeight; ++i)
      EXPECT_NEAR(upright.color.pixels[4 * i], 128 + static_cast<double>(i), 0.6) << order << ", pixel " << i;
  }
}

TEST(Pnm, DeepSamplesAreWhatTheyAre) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& header, const std::string& data) {
    write_bytes(folder / "p.ppm", header, data);
    Messages messages;
    ReadOptions options;
    options.raw = true;
    const auto picture = read_picture(folder / "p.ppm", options, messages.diagnostics);
    return picture ? picture->color.pixels : std::vector<float>{};
  };
  const auto expect = [&](const std::vector<float>& found, const std::vector<double>& wanted, const char* what) {
    ASSERT_EQ(found.size(), wanted.size() / 3 * 4) << what;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      EXPECT_FLOAT_EQ(found[i / 3 * 4 + i % 3], static_cast<float>(wanted[i])) << what << " " << i;
  };
  const std::string six("\xff\xff\x9c\x40\x80\x00\x80\x01\x7f\xff\x00\x64", 12);
  const std::vector<double> codes{65535, 40000, 32768, 32769, 32767, 100};
  const auto over = [&](double most) {
    std::vector<double> out;
    for (const double code : codes) out.push_back(std::min(code, most) / most);
    return out;
  };
  expect(read("P6\n# a comment\n2 1 65535\n", six), over(65535), "bytes");
  expect(read("P3 2 1 65535 ", "65535 40000\n32768 # more\n32769 32767 100"), over(65535), "text");
  expect(read("P6 2 1\n40000\n", six), over(40000), "another largest value");
  const auto grey = read("P5 3 2 65535\n", six);
  ASSERT_EQ(grey.size(), 24u);
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(grey[4 * i + c], static_cast<float>(codes[i] / 65535));
  const std::string three("\x64\x32\x21", 3);
  for (const char* most : {"100", "254"}) {
    const double all = std::stod(most);
    expect(read(std::string("P6 1 1 ") + most + "\n", three), {100 / all, 50 / all, 33 / all}, most);
    expect(read(std::string("P3 1 1 ") + most + "\n", "100 50 33"), {100 / all, 50 / all, 33 / all}, most);
  }
  write_bytes(folder / "p.ppm", "P6 1 1 100\n", three);
  const Picture light = read_or_fail(folder / "p.ppm");
  EXPECT_NEAR(light.color.pixels[1], 0.2140411, 1e-6) << "half of sRGB";
  EXPECT_TRUE(read("P6 2 1 65535\n", six.substr(1)).empty()) << "too short";
  EXPECT_TRUE(read("P3 2 1 65535\n", "1 2 3 4 5 x").empty());
  for (const char* most : {"0", "65536"}) EXPECT_TRUE(read(std::string("P6 2 1 ") + most + "\n", six).empty());
}

TEST(MoreFormats, OtherSpaces) {
  const TemporaryFolder folder;
  const OutputSpace* gamma = find_output_space("gamma22").value();
  Picture picture = wedge(4, 1, false);
  picture.color.pixels = {1, 0.5f, 0, 1, 0.25f, 0.1f, 2, 1, 0, 0, 0, 1, 1, 1, 1, 1};
  ASSERT_TRUE(write(picture, folder / "o.ppm", with(SampleType::uint16, gamma)));
  const std::string bytes = read_file(folder / "o.ppm").value();
  ASSERT_EQ(bytes.substr(0, 13), "P6\n4 1\n65535\n");
  const auto code = [&](std::size_t i) {
    return static_cast<std::uint8_t>(bytes[13 + 2 * i]) * 256 + static_cast<std::uint8_t>(bytes[14 + 2 * i]);
  };
  EXPECT_EQ(code(0), 65535);
  EXPECT_NEAR(code(1), 65535 * std::pow(0.5, 1 / 2.2), 0.7);
  EXPECT_EQ(code(2), 0);
  EXPECT_NEAR(code(4), 65535 * std::pow(0.1, 1 / 2.2), 0.7);
  EXPECT_EQ(code(5), 65535);
  const auto refused = write(picture, folder / "o.exr", with(SampleType::automatic, gamma));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::usage);
  EXPECT_THAT(refused.error().text(), HasSubstr("exr files hold scene-linear light, not gamma22; allowed: aces2065_1"));
  const auto radiance = write(picture, folder / "o.hdr", with(SampleType::automatic, gamma));
  ASSERT_FALSE(radiance);
  EXPECT_THAT(radiance.error().text(), HasSubstr("hdr files hold scene-linear light; --output-space is for integer"));
}

TEST(MoreFormats, PamHasStraightAlpha) {
  const TemporaryFolder folder;
  Picture picture = wedge(2, 1, true);
  picture.color.pixels = {0.5f, 0, 0, 0.5f, 0, 0, 0, 0};
  ASSERT_TRUE(write(picture, folder / "o.pam", with(SampleType::automatic)));
  EXPECT_EQ(read_file(folder / "o.pam").value(),
            std::string("P7\nWIDTH 2\nHEIGHT 1\nDEPTH 4\nMAXVAL 255\nTUPLTYPE RGB_ALPHA\nENDHDR\n") +
                std::string("\xff\0\0\x80\0\0\0\0", 8));
}

TEST(MoreFormats, AlphaComesBack) {
  const TemporaryFolder folder;
  Picture picture = wedge(2, 1, true);
  picture.color.pixels = {0.4f, 0.2f, 0.1f, 0.5f, 0.75f, 0.5f, 0.25f, 1};
  for (const char* name : {"o.dpx", "o.png", "o.tif", "o.tga", "o.webp", "o.exr"}) {
    const bool deep = std::string_view(name) == "o.dpx" || std::string_view(name) == "o.tif";
    ASSERT_TRUE(write(picture, folder / name, with(deep ? SampleType::uint16 : SampleType::automatic))) << name;
    const Picture back = read_or_fail(folder / name);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(back.color.pixels[i], picture.color.pixels[i], 0.006) << name << i;
  }
}

TEST(MoreFormats, WhatAFormatCannotHold) {
  const TemporaryFolder folder;
  struct Case {
    const char* file;
    WriteOptions options;
    const char* message;
  };
  for (const Case& c : {Case{"o.cin", with(SampleType::uint16), "cin files cannot hold samples of type uint16"},
                        Case{"o.pfm", with(SampleType::uint8), "pfm files cannot hold samples of type uint8"},
                        Case{"o.webp", with(SampleType::uint16), "webp files cannot hold samples of type uint16"},
                        Case{"o.png", with(SampleType::uint10), "png files cannot hold samples of type uint10"},
                        Case{"o.webp", compressed("lossles"), "did you mean 'lossless'?"},
                        Case{"o.tga", compressed("rle:3"), "compression 'rle' takes no level"}}) {
    const auto refused = write(wedge(4, 4, false), folder / c.file, c.options);
    ASSERT_FALSE(refused) << c.message;
    EXPECT_EQ(refused.error().kind, ErrorKind::usage);
    EXPECT_THAT(refused.error().text(), HasSubstr(c.message));
  }
  EXPECT_EQ(folder.count(), 0);
}

TEST(MoreFormats, AlphaThatAFormatCannotHoldIsTold) {
  const TemporaryFolder folder;
  Messages messages;
  for (const char* name : {"o.cin", "o.ppm", "o.pfm", "o.dpx"})
    ASSERT_TRUE(write_picture(wedge(4, 4, true), folder / name, {}, messages.diagnostics));
  ASSERT_EQ(messages.warnings.size(), 4u);
  EXPECT_THAT(messages.warnings[0], HasSubstr("cin files have no alpha; the picture is put on black"));
  EXPECT_THAT(messages.warnings[3], HasSubstr("dpx files have no alpha in 10 bits (--type uint16 has); the picture"));
}

TEST(MoreFormats, SmallJpeg2000) {
  const TemporaryFolder folder;
  const auto refused = write(wedge(31, 64, false), folder / "o.jp2");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::io);
  EXPECT_THAT(refused.error().text(), HasSubstr("sides of at least 32 pixels, not 31x64"));
  EXPECT_EQ(folder.count(), 0);
}

}  // namespace
}  // namespace afterglow
