// SPDX-License-Identifier: MIT
// What cameras and retouching programs write beside sRGB: Adobe RGB told by Exif alone, raws, inks, Lab, places, odd
// numbers. The files are made here, byte by byte.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/file.h"
#include "image/metadata.h"
#include "image/writer.h"
#include "make_files.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Tag {
  int tag, type;  // 2: text, 3: 16 bits, 4: 32 bits
  std::uint32_t count, value;
};

/// Numbers in one order of bytes.
class Bytes {
 public:
  explicit Bytes(bool big) : big_(big) {}
  void put(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) text_ += static_cast<char>(value >> 8 * (big_ ? size - 1 - i : i) & 0xff);
  }
  void put(const std::string& text) { text_ += text; }
  /// The directory's offset is that of where it is put.
  void directory(const std::vector<Tag>& tags) {
    put(tags.size(), 2);
    for (const Tag& tag : tags) {
      put(static_cast<std::uint64_t>(tag.tag), 2);
      put(static_cast<std::uint64_t>(tag.type), 2);
      put(tag.count, 4);
      const int size = tag.type == 3 && tag.count == 1 ? 2 : 4;
      put(tag.value, size);
      put(0, 4 - size);
    }
    put(0, 4);
  }
  const std::string& text() const { return text_; }

 private:
  bool big_;
  std::string text_;
};

/// EXIF as cameras write it, with that index of interoperability.
std::string exif(bool big, const char* index, std::uint32_t orientation = 1, std::uint32_t space = 0xffff) {
  constexpr std::uint32_t kFirst = 8, kLength = 2 + 2 * 12 + 4, kInner = 2 + 2 * 12 + 4;
  Bytes out(big);
  out.put(big ? "MM" : "II");
  out.put(42, 2);
  out.put(kFirst, 4);
  out.directory({{0x0112, 3, 1, orientation}, {0x8769, 4, 1, kFirst + kLength}});
  out.directory({{0xa001, 3, 1, space}, {0xa005, 4, 1, kFirst + kLength + kInner}});
  std::uint32_t text = 0;
  for (int i = 0; i < 4; ++i)
    text |= static_cast<std::uint32_t>(static_cast<unsigned char>(index[i])) << 8 * (big ? 3 - i : i);
  out.directory({{1, 2, 4, text}});
  return out.text();
}

class Photographs : public testing::Test {
 protected:
  /// A grey-green JPEG of 8×4 pixels with these metadata.
  std::filesystem::path jpeg(const std::string& name, const std::string& metadata) {
    const auto file = folder_ / name;
    OIIO::ImageSpec spec = make_spec(8, 4, {"R", "G", "B"}, OIIO::TypeUInt8);
    spec.attribute("CompressionQuality", 100);
    std::vector<float> samples;
    for (int i = 0; i < 32; ++i) samples.insert(samples.end(), {0.4f, 0.8f, 0.2f});
    make_file(file, {spec}, {samples});
    std::string bytes = read_file(file).value();
    Bytes segment(true);
    segment.put(0xffe1, 2);
    segment.put(2 + 6 + metadata.size(), 2);
    segment.put(std::string("Exif\0\0", 6) + metadata);
    bytes.insert(2, segment.text());
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
  /// A TIFF of 2×2 pixels: these tags beside its size and place.
  std::filesystem::path tiff(const std::string& name, std::vector<Tag> tags, const std::string& pixels) {
    Bytes out(false);
    out.put("II");
    out.put(42, 2);
    out.put(8 + pixels.size(), 4);
    out.put(pixels);
    const auto size = static_cast<std::uint32_t>(pixels.size());
    tags.insert(tags.end(), {{256, 3, 1, 2}, {257, 3, 1, 2}, {273, 4, 1, 8}, {278, 3, 1, 2}, {279, 4, 1, size}});
    std::ranges::sort(tags, {}, &Tag::tag);
    out.directory(tags);
    const auto file = folder_ / name;
    std::ofstream(file, std::ios::binary) << out.text();
    return file;
  }
  std::string error_of(const std::filesystem::path& file) {
    const auto picture = read_picture(file, {}, messages_.diagnostics);
    return picture ? "" : picture.error().message;
  }

  TemporaryFolder folder_;
  Messages messages_;
};

/// DCF 2.0 and Adobe RGB (1998): a power of 2 + 51/256, and a green beyond that of Rec.709.
TEST_F(Photographs, AreAdobeRgbWhereExifSaysSo) {
  ReadOptions options;
  options.keep_negative = true;
  for (const bool big : {false, true}) {
    const Picture plain = read_or_fail(jpeg("plain.jpg", exif(big, "R98")), options);
    const Picture adobe = read_or_fail(jpeg("adobe.jpg", exif(big, "R03")), options);
    std::array<double, 3> light{};
    for (std::size_t c = 0; c < 3; ++c) {
      const double linear = plain.color.at(3, 2)[c];
      const double code = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
      light[c] = std::pow(code, 563.0 / 256);
    }
    // From the standard's primaries to those of Rec.709; both have the white of D65.
    const double want[3] = {1.39836 * light[0] - 0.39836 * light[1], light[1],
                            -0.04294 * light[1] + 1.04294 * light[2]};
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(adobe.color.at(3, 2)[c], want[c], 2e-5) << c;
    EXPECT_LT(adobe.color.at(3, 2)[0], 0) << "it is seen to be another green";
  }
}

TEST_F(Photographs, AreSrgbWhereExifSaysThatToo) {
  const float plain = read_or_fail(jpeg("plain.jpg", exif(false, "R98"))).color.at(0, 0)[1];
  EXPECT_EQ(read_or_fail(jpeg("both.jpg", exif(false, "R03", 1, 1))).color.at(0, 0)[1], plain);
}

TEST_F(Photographs, ExifThatEndsEarlyOrLeadsAstraySaysNothing) {
  const std::string whole = exif(false, "R03");
  const float plain = read_or_fail(jpeg("plain.jpg", exif(false, "R98"))).color.at(0, 0)[1];
  constexpr std::size_t kBehind = 4;  // where another directory would be
  for (std::size_t length = 8; length < whole.size() - kBehind; ++length) {
    const auto picture = read_picture(jpeg("cut.jpg", whole.substr(0, length)), {}, messages_.diagnostics);
    if (picture) {
      EXPECT_EQ(picture->color.at(0, 0)[1], plain) << length;
    }
  }
  std::string astray = whole;
  astray[8 + 2 + 12 + 8] = static_cast<char>(0xf0);  // the directory of EXIF
  astray[8 + 2 + 12 + 9] = static_cast<char>(0xff);
  EXPECT_EQ(read_or_fail(jpeg("astray.jpg", astray)).color.at(0, 0)[1], plain);
}

TEST_F(Photographs, StandAsStoredWhereTheirOrientationIsNone) {
  for (const std::uint32_t orientation : {0u, 9u, 255u, 65535u})
    EXPECT_EQ(read_or_fail(jpeg("o.jpg", exif(false, "R98", orientation))).color.width, 8) << orientation;
  EXPECT_EQ(read_or_fail(jpeg("o.jpg", exif(false, "R98", 6))).color.width, 4);
}

TEST_F(Photographs, RawsAreRefusedInPlaceOfTheirThumbnails) {
  const std::string grey(4, '\x7f');
  const std::vector<Tag> picture{{258, 3, 1, 8}, {259, 3, 1, 1}, {262, 3, 1, 1}, {277, 3, 1, 1}};
  const auto with = [&](std::vector<Tag> more) {
    more.insert(more.end(), picture.begin(), picture.end());
    return more;
  };
  EXPECT_EQ(error_of(tiff("plain.tif", picture, grey)), "");
  EXPECT_EQ(error_of(tiff("small.tif", with({{254, 4, 1, 1}}), grey)), "") << "small, but nothing within";
  EXPECT_THAT(error_of(tiff("raw.nef", with({{254, 4, 1, 1}, {330, 4, 1, 8}}), grey)), HasSubstr("is a camera raw"));
  EXPECT_THAT(error_of(tiff("raw.dng", with({{50706, 1, 4, 0x00000401}}), grey)), HasSubstr("is a camera raw"));
}

TEST_F(Photographs, WhatTheReaderWouldGuessIsRefused) {
  EXPECT_THAT(error_of(tiff("bits.tif", {{259, 3, 1, 1}, {262, 3, 1, 1}, {277, 3, 1, 1}}, std::string(4, '\x7f'))),
              HasSubstr("does not say how many bits a sample has (BitsPerSample)"));
  EXPECT_THAT(error_of(tiff("lab.tif", {{258, 3, 1, 8}, {259, 3, 1, 1}, {262, 3, 1, 8}, {277, 3, 1, 3}},
                            std::string(12, '\x40'))),
              HasSubstr("holds CIE Lab colours"));
}

TEST_F(Photographs, InksAreTold) {
  const auto file =
      tiff("inks.tif", {{258, 3, 1, 8}, {259, 3, 1, 1}, {262, 3, 1, 5}, {277, 3, 1, 4}}, std::string(16, '\x40'));
  EXPECT_EQ(error_of(file), "");
  EXPECT_THAT(messages_.warnings, ElementsAre(HasSubstr("inks.tif: is CMYK; its inks become RGB by a plain rule")));
}

TEST_F(Photographs, KeepTheirPlaceAndTheirDots) {
  OIIO::ImageSpec spec = make_spec(8, 4, {"R", "G", "B"}, OIIO::TypeUInt8);
  const float north[3] = {50, 56, 24.5f}, west[3] = {6, 57, 36};
  const OIIO::TypeDesc place(OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::SCALAR, 3);
  spec.attribute("GPS:Latitude", place, north);
  spec.attribute("GPS:Longitude", place, west);
  spec.attribute("GPS:LatitudeRef", "N");
  spec.attribute("GPS:LongitudeRef", "W");
  make_file(folder_ / "in.jpg", {spec}, {marks(8, 4, 3)});
  OIIO::ImageSpec dots = make_spec(8, 4, {"R", "G", "B"}, OIIO::TypeUInt8);
  dots.attribute("XResolution", 100.f);
  dots.attribute("YResolution", 100.f);
  dots.attribute("ResolutionUnit", "cm");
  make_file(folder_ / "in.tif", {dots}, {marks(8, 4, 3)});
  for (const char* name : {"in.jpg", "in.tif"}) {
    const auto out = folder_ / (std::string(name) + ".out.jpg");
    ASSERT_TRUE(write_picture(read_or_fail(folder_ / name), out, {}, messages_.diagnostics));
  }
  const auto photograph = OIIO::ImageInput::open((folder_ / "in.jpg.out.jpg").string());
  ASSERT_TRUE(photograph);
  float read[3] = {};
  ASSERT_TRUE(photograph->spec().getattribute("GPS:Latitude", place, read));
  EXPECT_THAT(read, ElementsAre(50, 56, testing::FloatNear(24.5f, 1e-4f)));
  ASSERT_TRUE(photograph->spec().getattribute("GPS:Longitude", place, read));
  EXPECT_THAT(read, ElementsAre(6, 57, 36));
  const auto scan = OIIO::ImageInput::open((folder_ / "in.tif.out.jpg").string());
  ASSERT_TRUE(scan);
  EXPECT_NEAR(scan->spec().get_float_attribute("XResolution"), 254, 0.5);
  EXPECT_EQ(scan->spec().get_string_attribute("ResolutionUnit"), "in");
}

/// Where the block of IPTC begins, behind its length; empty where there is none.
std::string iptc_of(const std::string& jpeg) {
  const std::string head("8BIM\x04\x04\0\0\0\0", 10);
  const std::size_t at = jpeg.find(head);
  if (at == std::string::npos) return "";
  const auto size = static_cast<unsigned char>(jpeg[at + 10]) * 256u + static_cast<unsigned char>(jpeg[at + 11]);
  const auto segment = static_cast<unsigned char>(jpeg[at - 16]) * 256u + static_cast<unsigned char>(jpeg[at - 15]);
  EXPECT_EQ(segment, 2 + 14 + 12 + size) << "both lengths";
  return jpeg.substr(at + 12, size);
}

/// IIM 4.2: without record 1:90 readers take texts for those of one-byte alphabets.
TEST_F(Photographs, NamesSayThatTheyAreUtf8) {
  for (const auto& [artist, told] : {std::pair("J\xc3\xbcrgen", true), {"Jurgen", false}}) {
    OIIO::ImageSpec spec = make_spec(40, 24, {"R", "G", "B"}, OIIO::TypeUInt8);
    spec.attribute("Artist", artist);
    make_file(folder_ / "in.png", {spec}, {marks(40, 24, 3)});
    ASSERT_TRUE(write_picture(read_or_fail(folder_ / "in.png"), folder_ / "out.jpg", {}, messages_.diagnostics));
    const std::string block = iptc_of(read_file(folder_ / "out.jpg").value());
    EXPECT_EQ(block.starts_with(std::string("\x1c\x01\x5a\0\x03\x1b%G", 8)), told) << artist;
    EXPECT_THAT(block, HasSubstr(std::string("\x1c\x02\x50", 3)));
    EXPECT_THAT(block, HasSubstr(artist));
    const Picture back = read_or_fail(folder_ / "out.jpg");
    EXPECT_EQ(back.color.width, 40);
    EXPECT_EQ(metadata_text(*find_metadata(back.facts->metadata, "Artist")), artist);
  }
}

}  // namespace
}  // namespace afterglow
