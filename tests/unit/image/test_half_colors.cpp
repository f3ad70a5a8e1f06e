// SPDX-License-Identifier: MIT
// Pictures whose colours stay half floats: the same light, the same counts and the same files as with floats.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "core/half.h"
#include "image/encode.h"
#include "image/output_space.h"
#include "image/writer.h"
#include "make_files.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {

using Names = std::vector<std::string>;

constexpr std::uint16_t kNan = 0x7e01, kInfinite = 0x7c00, kMinusZero = 0x8000, kMinusSmallest = 0x8001;

/// Halves of every kind that is finite: negative ones, both zeros, subnormal ones, the largest.
std::vector<std::uint16_t> finite_halves(std::size_t count) {
  std::vector<std::uint16_t> halves(count);
  std::uint32_t state = 12345;
  for (std::uint16_t& half : halves) {
    do {
      state = state * 1664525 + 1013904223;
      half = static_cast<std::uint16_t>(state >> 16);
      if ((state & 0x300) == 0) half = static_cast<std::uint16_t>(half & 0x83ff);  // 0 and subnormal
    } while ((half & 0x7c00) == 0x7c00);
  }
  for (const std::uint16_t half : {kMinusZero, kMinusSmallest, std::uint16_t{0x7bff}, std::uint16_t{0xfbff}})
    if (count > half % 7u) halves[half % 7u] = half;
  return halves;
}

/// A file with these halves, channel after channel.
void write_halves(const std::filesystem::path& file, Size size, const Names& names, Imf::Compression compression,
                  std::vector<std::uint16_t> halves, const std::function<void(Imf::Header&)>& edit = {}) {
  Imf::Header header(size.width, size.height);
  header.compression() = compression;
  if (edit) edit(header);
  const Imath::Box2i window = header.dataWindow();
  Imf::FrameBuffer buffer;
  const auto area = static_cast<std::size_t>(size.area());
  for (std::size_t c = 0; c < names.size(); ++c) {
    header.channels().insert(names[c], Imf::Channel(Imf::HALF));
    buffer.insert(names[c], Imf::Slice::Make(Imf::HALF, halves.data() + c * area, window, 2,
                                             2 * static_cast<std::size_t>(size.width)));
  }
  Imf::OutputFile out(file.c_str(), header);
  out.setFrameBuffer(buffer);
  out.writePixels(size.height);
}

struct Read {
  PixelMemory memory;
  Messages messages;
  Picture picture;

  explicit Read(const std::filesystem::path& file, ReadOptions options = {}) {
    options.halves = true;
    options.memory = &memory;
    auto read = read_picture(file, options, messages.diagnostics);
    if (!read) throw std::runtime_error(read.error().text());
    picture = std::move(read).value();
  }
};

std::vector<std::uint32_t> bits_of(const std::vector<float>& values) {
  std::vector<std::uint32_t> bits(values.size());
  std::memcpy(bits.data(), values.data(), values.size() * sizeof(float));
  return bits;
}

ReadOptions asking(const std::string& auxiliary) {
  ReadOptions options;
  options.auxiliary = {auxiliary};
  return options;
}
ReadOptions in_space(const std::string& space) {
  ReadOptions options;
  options.input_space = space;
  return options;
}

constexpr std::array kLossless = {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                  Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION};

TEST(HalfColors, AreTheLightThatFloatsAre) {
  const TemporaryFolder folder;
  for (const Names& names :
       {Names{"R", "G", "B"}, Names{"R", "G", "B", "A"}, Names{"B", "G", "R", "Z"}, Names{"id", "R", "A", "B", "G"}})
    for (const Size size : {Size{1, 1}, Size{3, 17}, Size{8, 16}, Size{9, 33}, Size{70, 40}})
      for (const auto compression : kLossless) {
        write_halves(folder / "h.exr", size, names, compression,
                     finite_halves(static_cast<std::size_t>(size.area()) * names.size()));
        const Picture floats = read_or_fail(folder / "h.exr");
        Read read(folder / "h.exr");
        const auto what = testing::Message() << names.size() << " channels, " << size.width << " × " << size.height
                                             << ", compression " << compression;
        ASSERT_EQ(read.picture.halves.size(), floats.color.pixels.size()) << what;
        EXPECT_TRUE(read.picture.color.pixels.empty());
        EXPECT_EQ(read.picture.color.size(), size);
        EXPECT_EQ(read.picture.has_alpha, floats.has_alpha) << what;
        EXPECT_EQ(read.picture.sanitized.negative, floats.sanitized.negative) << what;
        std::vector<float> memory;
        for (int y = 0; y < size.height; ++y)
          ASSERT_EQ(std::memcmp(color_row(read.picture, y, memory), floats.color.at(0, y),
                                static_cast<std::size_t>(size.width) * 4 * sizeof(float)),
                    0)
              << what << ", row " << y;
        open_color(read.picture);
        EXPECT_TRUE(read.picture.halves.empty());
        EXPECT_EQ(bits_of(read.picture.color.pixels), bits_of(floats.color.pixels)) << what;
      }
}

/// Anywhere: first, last, in a vector's middle and in its remainder, in a colour and in alpha.
TEST(HalfColors, WhatIsNotFiniteIsReadAsFloats) {
  const TemporaryFolder folder;
  const Size size{9, 5};
  const auto area = static_cast<std::size_t>(size.area());
  for (const std::uint16_t value : {kNan, kInfinite, std::uint16_t(kInfinite | kMinusZero)})
    for (const std::size_t place : {std::size_t{0}, area - 1, area + 7, 2 * area + 20, 4 * area - 1})
      for (const auto compression : {Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
        auto halves = finite_halves(area * 4);
        halves[place] = value;
        write_halves(folder / "n.exr", size, {"R", "G", "B", "A"}, compression, halves);
        Messages messages;
        const auto floats = read_picture(folder / "n.exr", {}, messages.diagnostics);
        const Read read(folder / "n.exr");
        EXPECT_TRUE(read.picture.halves.empty());
        EXPECT_EQ(bits_of(read.picture.color.pixels), bits_of(floats.value().color.pixels));
        EXPECT_EQ(read.messages.warnings, messages.warnings);
        EXPECT_EQ(read.picture.sanitized.negative, floats.value().sanitized.negative);
      }
}

TEST(HalfColors, OtherPicturesAreReadAsFloats) {
  const TemporaryFolder folder;
  const Size size{6, 4};
  const auto area = static_cast<std::size_t>(size.area());
  const auto expect_floats = [&](const char* what, const std::filesystem::path& file, const ReadOptions& options = {}) {
    const Read read(file, options);
    EXPECT_TRUE(read.picture.halves.empty()) << what;
    EXPECT_EQ(bits_of(read.picture.color.pixels), bits_of(read_or_fail(file, options).color.pixels)) << what;
  };
  write_halves(folder / "y.exr", size, {"Y"}, Imf::ZIP_COMPRESSION, finite_halves(area));
  expect_floats("grey", folder / "y.exr");
  write_halves(folder / "rg.exr", size, {"R", "G"}, Imf::ZIP_COMPRESSION, finite_halves(area * 2));
  expect_floats("no blue", folder / "rg.exr");
  const Imf::Chromaticities ap1({0.713f, 0.293f}, {0.165f, 0.830f}, {0.128f, 0.044f}, {0.32168f, 0.33767f});
  write_halves(folder / "ap1.exr", size, {"R", "G", "B"}, Imf::ZIP_COMPRESSION, finite_halves(area * 3),
               [&](Imf::Header& header) { Imf::addChromaticities(header, ap1); });
  expect_floats("other primaries", folder / "ap1.exr");
  write_halves(folder / "z.exr", size, {"R", "G", "B", "Z"}, Imf::ZIP_COMPRESSION, finite_halves(area * 4));
  expect_floats("depth is asked for", folder / "z.exr", asking("depth"));
  expect_floats("another space", folder / "z.exr", in_space("slog3"));
  make_file(folder / "f.exr", {make_spec(6, 4, {"R", "G", "B"}, OIIO::TypeFloat)}, {marks(6, 4, 3)});
  expect_floats("floats", folder / "f.exr");
  make_file(folder / "p.png", {make_spec(6, 4, {"R", "G", "B"}, OIIO::TypeUInt8)}, {marks(6, 4, 3)});
  expect_floats("a PNG", folder / "p.png");
}

TEST(HalfColors, AreReadOnlyWhereThatIsAllowed) {
  const TemporaryFolder folder;
  write_halves(folder / "h.exr", {4, 4}, {"R", "G", "B"}, Imf::ZIP_COMPRESSION, finite_halves(48));
  EXPECT_TRUE(read_or_fail(folder / "h.exr").halves.empty());
  ReadOptions without_memory;
  without_memory.halves = true;
  EXPECT_TRUE(read_or_fail(folder / "h.exr", without_memory).halves.empty());
}

TEST(HalfColors, TheirMemoryIsUsedAgain) {
  const TemporaryFolder folder;
  write_halves(folder / "h.exr", {4, 4}, {"R", "G", "B"}, Imf::ZIP_COMPRESSION, finite_halves(48));
  PixelMemory memory;
  Diagnostics silent;
  ReadOptions options;
  options.halves = true;
  options.memory = &memory;
  Picture first = read_picture(folder / "h.exr", options, silent).value();
  const std::uint16_t* halves = first.halves.data();
  memory.give(std::move(first));
  EXPECT_EQ(read_picture(folder / "h.exr", options, silent).value().halves.data(), halves);
}

TEST(HalfColors, AHashTellsThemApart) {
  const TemporaryFolder folder;
  auto halves = finite_halves(48);
  const auto hash = [&] {
    write_halves(folder / "h.exr", {4, 4}, {"R", "G", "B"}, Imf::ZIP_COMPRESSION, halves);
    Read read(folder / "h.exr");
    note_content(read.picture);
    return read.picture.content.at("source");
  };
  const auto first = hash();
  EXPECT_EQ(hash(), first);
  halves[20] = 0x3555;
  EXPECT_NE(hash(), first);
}

WriteOptions of_type(SampleType type, const char* compression = "") {
  WriteOptions options;
  options.type = type;
  options.compression = compression;
  return options;
}

/// Whatever is written of them, from rows or from the whole: the same bytes.
TEST(HalfColors, FilesAreTheSame) {
  const TemporaryFolder folder;
  const Size size{37, 21};
  const auto area = static_cast<std::size_t>(size.area());
  for (const Names& names : {Names{"R", "G", "B"}, Names{"R", "G", "B", "A"}})
    for (const bool overscan : {false, true}) {
      auto halves = finite_halves(area * names.size());
      for (std::size_t i = 0; i < halves.size(); ++i)  // most of them as pictures have them, alpha from 0 to 1
        if (i % 5 != 0 || i >= 3 * area) halves[i] = static_cast<std::uint16_t>(i * 37 % 0x3c01);
      write_halves(folder / "h.exr", size, names, Imf::ZIP_COMPRESSION, halves, [&](Imf::Header& header) {
        if (overscan) header.displayWindow() = {{2, 1}, {30, 18}};
      });
      const Picture floats = read_or_fail(folder / "h.exr");
      const Read read(folder / "h.exr");
      ASSERT_FALSE(read.picture.halves.empty());
      Diagnostics silent;
      const auto expect_same = [&](const std::string& extension, const WriteOptions& options) {
        const auto of_floats = picture_bytes(floats, extension, options, silent);
        const auto of_halves = picture_bytes(read.picture, extension, options, silent);
        ASSERT_TRUE(of_floats) << of_floats.error().text();
        ASSERT_TRUE(of_halves) << of_halves.error().text();
        EXPECT_EQ(of_halves.value() == of_floats.value(), true) << extension << " " << names.size() << " " << overscan;
      };
      for (const auto type : {SampleType::half, SampleType::float32})
        for (const char* compression : {"none", "zip", "piz", "dwaa"}) expect_same("exr", of_type(type, compression));
      for (const auto type : {SampleType::uint8, SampleType::uint16}) {
        expect_same("png", of_type(type));
        // Its files have the time in them.
        ASSERT_TRUE(write_picture(floats, folder / "floats.tif", of_type(type), silent));
        ASSERT_TRUE(write_picture(read.picture, folder / "halves.tif", of_type(type), silent));
        EXPECT_EQ(read_or_fail(folder / "halves.tif").color.pixels, read_or_fail(folder / "floats.tif").color.pixels);
        expect_same("dpx", of_type(type));
      }
      for (const char* extension : {"jpg", "tga", "webp", "ppm", "pfm", "hdr"}) expect_same(extension, {});
    }
}

TEST(HalfColors, StoredValuesAreThoseOfFloats) {
  std::vector<std::uint16_t> halves(4 << 16);  // each at the place of each channel
  for (std::size_t i = 0; i < halves.size(); ++i) halves[i] = static_cast<std::uint16_t>(i / 4);
  std::vector<float> light(halves.size()), of_halves(halves.size()), of_light(halves.size());
  floats_from_halves(halves.data(), halves.size(), light.data());
  for (const InputSpace& space : input_spaces()) {
    const OutputSpace& out = OutputSpace::of(space);
    out.encode(light.data(), light.size() / 4, of_light.data());
    out.encode_colors(halves.data(), halves.size() / 4, of_halves.data());
    std::size_t others = 0;
    for (std::size_t i = 0; i < halves.size(); ++i)
      others += i % 4 != 3 && std::memcmp(&of_halves[i], &of_light[i], sizeof(float)) != 0;
    EXPECT_EQ(others, 0u) << space.name;
  }
}

}  // namespace
}  // namespace afterglow
