// SPDX-License-Identifier: MIT
// DPX and Cineon: codes as stored, and what the files say of them.
#include <gtest/gtest.h>

#include <bit>
#include <fstream>

#include "core/file.h"
#include "make_files.h"
#include "temporary_folder.h"
#include "wedge.h"

namespace afterglow {
namespace {

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

/// Lines begin at words of 32 bits (SMPTE ST 268), whether the header tells of it, as ours does, or not.
TEST(FilmScans, DpxLinesAreWholeWords) {
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

/// Transfer characteristics of SMPTE ST 268, table 5, at their byte.
TEST(FilmScans, DpxIsReadByItsTransferCharacteristic) {
  const TemporaryFolder folder;
  const Picture picture = wedge(36, 4, false);
  ASSERT_TRUE(write(picture, folder / "a.dpx", with(SampleType::uint10)));
  const std::string bytes = read_file(folder / "a.dpx").value();
  const auto with_byte = [&](char value) {
    std::string changed = bytes;
    changed[801] = value;
    std::ofstream(folder / "b.dpx", std::ios::binary) << changed;
    return read_or_fail(folder / "b.dpx").color.pixels;
  };
  const auto logarithm = with_byte(3), camera = with_byte(6), other = with_byte(0);
  EXPECT_NE(logarithm, other);
  EXPECT_NE(camera, other);
  EXPECT_EQ(with_byte(1), logarithm) << "printing density";
  for (const char byte : {5, 7, 8}) {
    const auto read = with_byte(byte);
    for (std::size_t i = 0; i < read.size(); ++i) ASSERT_NEAR(read[i], camera[i], 1e-6) << static_cast<int>(byte);
  }
}

}  // namespace
}  // namespace afterglow
