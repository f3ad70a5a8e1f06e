// SPDX-License-Identifier: MIT
// DPX, Cineon, PAM: codes as stored, and what the files say of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <webp/decode.h>

#include <bit>
#include <cmath>
#include <fstream>

#include "core/file.h"
#include "image/output_format.h"
#include "image/output_space.h"
#include "image/writer.h"
#include "make_files.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {
using testing::HasSubstr;

/// Greys whose Cineon codes are 95, 95 + step, …; red, green and blue differ.
Picture wedge(int width, int height, bool alpha) {
  Picture picture;
  picture.color = Image(width, height, 4);
  const InputSpace& cineon = *find_input_space("cineon").value();
  for (int i = 0; i < width * height; ++i) {
    float* pixel = &picture.color.pixels[static_cast<std::size_t>(i) * 4];
    pixel[3] = alpha ? static_cast<float>(i % 5) / 4 : 1;
    for (int c = 0; c < 3; ++c)
      pixel[c] = static_cast<float>(cineon.to_linear((95 + (i * 7 + c * 131) % 900) / 1023.0)) * pixel[3];
  }
  picture.has_alpha = alpha;
  picture.data_window = picture.display_window = {0, 0, width, height};
  return picture;
}

/// Rounded to the nearest code, in this type and space.
WriteOptions with(SampleType type, const OutputSpace* space = nullptr) {
  WriteOptions options;
  options.type = type;
  options.space = space;
  options.dither = false;
  return options;
}
WriteOptions compressed(const char* compression) {
  WriteOptions options;
  options.compression = compression;
  return options;
}

Result<void> write(const Picture& picture, const std::filesystem::path& file, const WriteOptions& options = {}) {
  Diagnostics silent;
  return write_picture(picture, file, options, silent);
}

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

TEST(Cineon, HoldsTheCodesWhereTheFormatSays) {
  const TemporaryFolder folder;
  const Picture picture = wedge(37, 5, false);
  ASSERT_TRUE(write(picture, folder / "o.cin"));
  const std::string bytes = read_file(folder / "o.cin").value();
  ASSERT_EQ(bytes.size(), 2048u + 37 * 5 * 4);
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
    return value;
  };
  EXPECT_EQ(number(0), 0x802a5fd7u);
  EXPECT_EQ(number(4), 2048u);
  EXPECT_EQ(number(20), bytes.size());
  for (std::size_t i = 0; i < 37 * 5; ++i)
    for (int c = 0; c < 3; ++c)
      ASSERT_EQ(number(2048 + i * 4) >> (22 - 10 * c) & 1023, 95 + (i * 7 + static_cast<unsigned>(c) * 131) % 900);
}

/// As another library, and the reader, see them.
TEST(Cineon, ComesBackAsLight) {
  const TemporaryFolder folder;
  for (const char* name : {"o.cin", "o.dpx"}) {
    const Picture picture = wedge(37, 5, false);
    ASSERT_TRUE(write(picture, folder / name));
    const Picture back = read_or_fail(folder / name);
    ASSERT_EQ(back.color.size(), (Size{37, 5}));
    for (std::size_t i = 0; i < picture.color.pixels.size(); ++i)
      ASSERT_NEAR(back.color.pixels[i], picture.color.pixels[i], 1e-4 * (1 + picture.color.pixels[i])) << name << i;
  }
}

class Dpx : public testing::TestWithParam<std::tuple<SampleType, bool>> {};

TEST_P(Dpx, HoldsTheCodes) {
  const auto& [type, wanted_alpha] = GetParam();
  const bool alpha = wanted_alpha && type != SampleType::uint10;  // which has none
  const TemporaryFolder folder;
  const Picture picture = wedge(37, 53, wanted_alpha);
  ASSERT_TRUE(write(picture, folder / "o.dpx", with(type)));
  const auto input = OIIO::ImageInput::open((folder / "o.dpx").string());
  ASSERT_TRUE(input) << OIIO::geterror();
  const OIIO::ImageSpec spec = input->spec();
  EXPECT_EQ(spec.nchannels, alpha ? 4 : 3);
  const int most = max_code(type);
  const int bits = std::bit_width(static_cast<unsigned>(most));
  EXPECT_EQ(spec.get_int_attribute("oiio:BitsPerSample", bits), bits);
  std::vector<float> samples(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
  ASSERT_TRUE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, samples.data())) << input->geterror();
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  for (std::size_t i = 0; i < spec.image_pixels(); ++i) {
    ASSERT_NEAR(alpha ? samples[i * channels + 3] : static_cast<float>(i % 5) / 4, static_cast<float>(i % 5) / 4,
                0.55 / most);
    if (wanted_alpha && (alpha ? i % 5 == 0 : i % 5 != 4)) continue;  // nothing is there, or less than all
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_NEAR(samples[i * channels + c] * static_cast<float>(most),
                  static_cast<double>((95 + (i * 7 + c * 131) % 900)) / 1023 * most, 0.65)
          << i << " " << c;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Dpx,
                         testing::Combine(testing::Values(SampleType::uint8, SampleType::uint10, SampleType::uint12,
                                                          SampleType::uint16),
                                          testing::Bool()));

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

TEST(MoreFormats, WebpHoldsStraightCodes) {
  const TemporaryFolder folder;
  const Picture picture = wedge(37, 53, true);
  for (const char* name : {"o.webp", "o.pam"}) ASSERT_TRUE(write(picture, folder / name, with(SampleType::automatic)));
  const std::string webp = read_file(folder / "o.webp").value(), pam = read_file(folder / "o.pam").value();
  int width = 0, height = 0;
  std::uint8_t* pixels =
      WebPDecodeRGBA(reinterpret_cast<const std::uint8_t*>(webp.data()), webp.size(), &width, &height);
  ASSERT_TRUE(pixels);
  EXPECT_EQ((Size{width, height}), (Size{37, 53}));
  const std::string codes(reinterpret_cast<const char*>(pixels), 37 * 53 * 4);
  WebPFree(pixels);
  EXPECT_TRUE(pam.ends_with(codes));
}

/// Lines begin at words of 32 bits (SMPTE ST 268), whether the header tells of it, as ours does, or not.
TEST(MoreFormats, DpxLinesAreWholeWords) {
  const TemporaryFolder folder;
  for (const int width : {5, 6, 7, 8}) {
    const Picture picture = wedge(width, 4, false);
    ASSERT_TRUE(write(picture, folder / "a.dpx", with(SampleType::uint8)));
    const std::string bytes = read_file(folder / "a.dpx").value();
    const std::size_t line = static_cast<std::size_t>(3 * width), words = (line + 3) / 4 * 4;
    ASSERT_GE(bytes.size(), 4 * words);
    const std::size_t offset = bytes.size() - 4 * words;
    EXPECT_EQ(offset % 64, 0u) << "of the pixels";
    const Picture told = read_or_fail(folder / "a.dpx");
    std::string untold = bytes, tight = bytes.substr(0, offset);
    untold.replace(812, 4, 4, '\0');
    for (std::size_t y = 0; y < 4; ++y) tight += bytes.substr(offset + y * words, line);
    tight.replace(812, 4, 4, '\0');
    for (const std::string& other : {untold, tight}) {  // as FFmpeg writes them, and as OpenImageIO does
      std::ofstream(folder / "b.dpx", std::ios::binary) << other;
      EXPECT_EQ(read_or_fail(folder / "b.dpx").color.pixels, told.color.pixels) << width;
    }
    for (std::size_t i = 0; i < picture.color.pixels.size(); ++i)
      ASSERT_NEAR(told.color.pixels[i], picture.color.pixels[i], 0.02 + 0.05 * picture.color.pixels[i]) << width;
  }
}

/// Soft edges keep their colours: nothing is multiplied in 8 bits.
TEST(MoreFormats, WebpIsReadStraight) {
  const TemporaryFolder folder;
  Picture picture = wedge(16, 16, true);
  for (std::size_t i = 0; i < picture.color.pixels.size(); i += 4) {
    const float alpha = static_cast<float>(i / 4 % 16 + 1) / 255;
    picture.color.pixels[i + 3] = alpha;
    for (std::size_t c = 0; c < 3; ++c) picture.color.pixels[i + c] = alpha * (c == 0 ? 0.5f : 0.1f);
  }
  picture.has_alpha = true;
  for (const char* name : {"o.webp", "o.png"})
    ASSERT_TRUE(write(picture, folder / name, with(SampleType::automatic))) << name;
  const Picture webp = read_or_fail(folder / "o.webp"), png = read_or_fail(folder / "o.png");
  ASSERT_EQ(webp.color.pixels.size(), png.color.pixels.size());
  for (std::size_t i = 0; i < png.color.pixels.size(); ++i)
    ASSERT_FLOAT_EQ(webp.color.pixels[i], png.color.pixels[i]) << i;
}

/// As the container's specification has it: the chunk begins with the TIFF head.
TEST(MoreFormats, WebpIsTurnedAsItsExifSays) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write(wedge(40, 24, false), folder / "a.webp"));
  const std::string plain = read_file(folder / "a.webp").value();
  const std::string exif("II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0", 26);
  for (const bool named : {false, true}) {
    std::string chunk = (named ? std::string("Exif\0\0", 6) : "") + exif;
    const auto number = [](std::size_t value, int bytes) {
      std::string out;
      for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 255);
      return out;
    };
    const std::string body = "WEBPVP8X" + number(10, 4) + std::string("\x08\0\0\0", 4) + number(39, 3) + number(23, 3) +
                             plain.substr(12) + "EXIF" + number(chunk.size(), 4) + chunk;
    std::ofstream(folder / "b.webp", std::ios::binary) << "RIFF" << number(body.size(), 4) << body;
    EXPECT_EQ(read_or_fail(folder / "b.webp").color.size(), (Size{24, 40})) << named;
  }
}

TEST(MoreFormats, WebpLossy) {
  const TemporaryFolder folder;
  Picture picture = wedge(64, 64, false);
  ASSERT_TRUE(write(picture, folder / "a.webp"));
  ASSERT_TRUE(write(picture, folder / "b.webp", compressed("lossy:10")));
  EXPECT_LT(std::filesystem::file_size(folder / "b.webp"), std::filesystem::file_size(folder / "a.webp"));
  EXPECT_EQ(read_or_fail(folder / "b.webp").color.size(), (Size{64, 64}));
}

}  // namespace
}  // namespace afterglow
