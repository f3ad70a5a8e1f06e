// SPDX-License-Identifier: MIT
// Files with which OpenImageIO 2.4 reads or writes beyond its memory, one test a fault: kept from it, in words that are
// true. Their like were found with its decoders built for AddressSanitizer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "make_files.h"
#include "raw_png.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {
using testing::HasSubstr, testing::StartsWith;

std::string number(std::uint64_t value, int bytes, bool big = false) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> 8 * (big ? bytes - 1 - i : i) & 255);
  return out;
}
std::string zeros(std::size_t count) { return std::string(count, '\0'); }

class ReaderFaults : public testing::Test {
 protected:
  std::string said(const std::string& bytes, const std::string& name = "picture", const ReadOptions& options = {}) {
    write_bytes(folder_ / name, bytes);
    Diagnostics silent;
    const auto picture = read_picture(folder_ / name, options, silent);
    return picture ? "ok" : picture.error().message;
  }
  /// A picture of 13×9 grey pixels.
  std::string made(const std::string& name, const std::vector<std::string>& channels = {"R", "G", "B"}) {
    make_file(folder_ / name, 13, 9, channels, OIIO::TypeUInt8);
    return file_bytes(folder_ / name);
  }
  TemporaryFolder folder_;
};

/// One of 13×9 pixels, each line a run of one number.
std::string packed_bmp(int bits, int side = 0, bool grey = true) {
  std::string table, lines;
  for (int i = 0; i < 256; ++i)
    table += number(grey ? 0x010101u * static_cast<unsigned>(i) : 0xff0000u + static_cast<unsigned>(i), 4);
  for (int y = 0; y < 9; ++y) lines += std::string{'\x0d', static_cast<char>(y * 20), '\0', static_cast<char>(y == 8)};
  const int width = side > 0 ? side : 13, height = side > 0 ? side : 9;
  return "BM" + number(54 + table.size() + lines.size(), 4) + zeros(4) + number(54 + table.size(), 4) + number(40, 4) +
         number(static_cast<unsigned>(width), 4) + number(static_cast<unsigned>(height), 4) + number(1, 2) +
         number(static_cast<unsigned>(bits), 2) + number(1, 4) + number(lines.size(), 4) + zeros(16) + table + lines;
}

TEST_F(ReaderFaults, PackedGreyBmpsAreReadAsColours) {
  write_bytes(folder_ / "grey.bmp", packed_bmp(8));
  Diagnostics silent;
  const auto picture = read_picture(folder_ / "grey.bmp", {}, silent);
  ASSERT_TRUE(picture) << picture.error().text();
  for (int y = 0; y < 9; ++y)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(picture->color.at(12, y)[c], picture->color.at(0, y)[0]) << y;
  EXPECT_GT(picture->color.at(0, 0)[0], picture->color.at(0, 8)[0]) << "the first line is the lowest";
}

/// Most programs end the last line as all others, and the picture behind it.
TEST_F(ReaderFaults, PackedBmpsMayEndEachLine) {
  write_bytes(folder_ / "usual.bmp", packed_bmp(8, 0, false));
  std::string ended = packed_bmp(8, 0, false);
  ended.back() = 0;
  write_bytes(folder_ / "ended.bmp", ended + std::string{'\0', '\1'});
  Diagnostics silent;
  const auto usual = read_picture(folder_ / "usual.bmp", {}, silent);
  const auto picture = read_picture(folder_ / "ended.bmp", {}, silent);
  ASSERT_TRUE(usual) << usual.error().text();
  ASSERT_TRUE(picture) << picture.error().text();
  EXPECT_EQ(picture->color.pixels, usual->color.pixels);
  EXPECT_GT(picture->color.at(0, 0)[0], 0.9f) << "the red of the table";
}

/// Two codes a byte, codes as they are, and steps over what stays colour 0.
TEST_F(ReaderFaults, BmpsOfFourBitsAreUnpacked) {
  const auto colors = [] {
    std::string table;
    for (unsigned i = 0; i < 16; ++i) table += number(i == 0 ? 0 : 0xffu << (8 * (i % 3)), 4);
    return table;
  }();
  const std::string lines = std::string("\x03\x12\0\0", 4) +             // 1 2 1 on the lowest line
                            std::string("\0\x03\x31\x20\0\0", 6) +       // 3 1 2 as they are
                            std::string("\0\x02\x01\0\x01\x30\0\1", 8);  // a step to the right, then 3
  const std::string bytes = "BM" + number(54 + 64 + lines.size(), 4) + zeros(4) + number(54 + 64, 4) + number(40, 4) +
                            number(3, 4) + number(3, 4) + number(1, 2) + number(4, 2) + number(2, 4) +
                            number(lines.size(), 4) + zeros(16) + colors + lines;
  write_bytes(folder_ / "four.bmp", bytes);
  Diagnostics silent;
  const auto picture = read_picture(folder_ / "four.bmp", {}, silent);
  ASSERT_TRUE(picture) << picture.error().text();
  const int want[3][3] = {{0, 3, 0}, {3, 1, 2}, {1, 2, 1}};
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x)
      for (int c = 0; c < 3; ++c)  // the table holds blue first
        EXPECT_EQ(picture->color.at(x, y)[c], want[y][x] != 0 && want[y][x] % 3 == 2 - c ? 1 : 0) << x << y << c;
}

TEST_F(ReaderFaults, PackedBmpsOfOtherPixelsOrTooLarge) {
  EXPECT_THAT(said(packed_bmp(24)), HasSubstr("only pictures of 4 or 8 bits"));
  ReadOptions small;
  small.max_bytes = 64u << 20;
  EXPECT_THAT(said(packed_bmp(8, 16000), "picture", small), HasSubstr("more than the 64 MiB allowed"));
}

/// 8×8 pixels, numbers of a table of two colours.
std::string numbered_targa(bool packed, const std::string& pixels, int bits = 8) {
  return number(0, 1) + number(1, 1) + number(packed ? 9 : 1, 1) + number(0, 2) + number(2, 2) + number(24, 1) +
         zeros(4) + number(8, 2) + number(8, 2) + number(static_cast<unsigned>(bits), 1) + number(0, 1) +
         "\x10\x20\x30\x40\x50\x60" + pixels;
}
const std::string kTargaEnd = zeros(8) + "TRUEVISION-XFILE." + zeros(1);

TEST_F(ReaderFaults, TargaColoursBeyondTheTable) {
  const std::string last(1, '\x02');
  EXPECT_EQ(said(numbered_targa(false, zeros(63) + "\x01") + kTargaEnd), "ok");
  EXPECT_THAT(said(numbered_targa(false, zeros(63) + last) + kTargaEnd),
              HasSubstr("a colour that its table does not hold"));
  std::string runs, raw;
  for (int y = 0; y < 8; ++y) runs += "\x87\x01", raw += "\x07" + zeros(8);
  EXPECT_EQ(said(numbered_targa(true, runs) + kTargaEnd), "ok");
  runs.back() = '\x02', raw.back() = '\x02';
  EXPECT_THAT(said(numbered_targa(true, runs) + kTargaEnd), HasSubstr("a colour that its table"));
  EXPECT_THAT(said(numbered_targa(true, raw) + kTargaEnd), HasSubstr("a colour that its table"));
  EXPECT_THAT(said(numbered_targa(false, zeros(64), 0) + kTargaEnd), HasSubstr("a colour that its table"))
      << "numbers of no bits: of the largest size it took a minute";
  EXPECT_THAT(said(numbered_targa(false, std::string(256, '\x7f'), 32) + kTargaEnd),
              HasSubstr("a colour that its table"));
}

/// What OpenImageIO 2.4 takes for other colours than they are.
TEST_F(ReaderFaults, OrdersThatItsReaderDoesNotKnow) {
  std::string shifted = numbered_targa(false, zeros(64)) + kTargaEnd;
  shifted[3] = '\x01';
  EXPECT_THAT(said(shifted), HasSubstr("has a table of colours that does not begin at 0"));
  const auto bmp = [](unsigned red, unsigned blue) {
    return "BM" + number(74, 4) + zeros(4) + number(66, 4) + number(40, 4) + number(1, 4) + number(1, 4) +
           number(1, 2) + number(32, 2) + number(3, 4) + zeros(20) + number(red, 4) + number(0xff00, 4) +
           number(blue, 4) + "\x10\x20\x30\x40" + zeros(4);
  };
  EXPECT_EQ(said(bmp(0xff0000, 0xff)), "ok");
  EXPECT_THAT(said(bmp(0xff, 0xff0000)), HasSubstr("holds its channels in an order that is not read"));
  EXPECT_THAT(said(bmp(0xff0000, 0xff).substr(0, 60)), HasSubstr("is truncated"));
}

TEST_F(ReaderFaults, TargaTextsWithoutAnEnd) {
  const std::string picture = numbered_targa(false, zeros(64));
  const auto with = [&](std::size_t place) {
    std::string extension = number(495, 2) + zeros(493);
    extension.replace(place, 41, std::string(41, 'x'));
    return picture + extension + number(picture.size(), 4) + zeros(4) + "TRUEVISION-XFILE." + zeros(1);
  };
  for (const std::size_t place : {2, 379, 426})
    EXPECT_THAT(said(with(place)), HasSubstr("a text of its extension has no end"));
}

TEST_F(ReaderFaults, GifColoursBeyondTheTable) {
  // Codes of four bits: clear, a number, the end. Two colours of four.
  const auto gif = [&](unsigned value) {
    const unsigned codes = 4u | value << 3 | 5u << 6;
    return "GIF89a" + number(1, 2) + number(1, 2) + std::string("\x80\0\0", 3) + "\x10\x20\x30\x40\x50\x60" + "," +
           zeros(4) + number(1, 2) + number(1, 2) + zeros(1) + "\x02\x02" + number(codes, 2) + zeros(1) + ";";
  };
  EXPECT_EQ(said(gif(1)), "ok");
  EXPECT_THAT(said(gif(3)), HasSubstr("a colour that its table does not hold"));
}

std::string film_header(const std::string& magic, std::size_t size) { return magic + zeros(size - 4); }

std::string dpx(unsigned descriptor, unsigned bits, unsigned width, std::size_t bytes) {
  std::string head = film_header("SDPX", 2048);
  head.replace(4, 4, number(2048, 4, true));
  head.replace(768, 12, number(0, 2, true) + number(1, 2, true) + number(width, 4, true) + number(9, 4, true));
  head.replace(
      800, 12,
      number(descriptor, 1) + "\x02\x02" + number(bits, 1) + number(1, 2, true) + zeros(2) + number(2048, 4, true));
  return head + std::string(bytes, '\x55');
}

TEST_F(ReaderFaults, DpxLinesThatAreReadWrongly) {
  EXPECT_EQ(said(dpx(6, 10, 12, 9 * 16)), "ok");
  for (const unsigned width : {13u, 14u})
    EXPECT_THAT(said(dpx(6, 10, width, 9 * 20)), HasSubstr("is a 10-bit DPX of a width"));
  EXPECT_THAT(said(dpx(51, 10, 13, 9 * 72)), HasSubstr("is a 10-bit DPX of a width")) << "the last sample of RGBA";
  EXPECT_EQ(said(dpx(50, 10, 13, 9 * 52)), "ok");
  EXPECT_EQ(said(dpx(50, 10, 13, 9 * 52 - 1)), "is truncated");
  EXPECT_THAT(said(dpx(50, 20, 13, 9 * 200)), HasSubstr("has samples of other sizes"));
}

TEST_F(ReaderFaults, CineonElements) {
  const auto cineon = [](unsigned elements, unsigned bits, unsigned other, std::size_t bytes) {
    std::string head = film_header("\x80\x2a\x5f\xd7", 2048);
    head.replace(4, 4, number(2048, 4, true));
    head[193] = static_cast<char>(elements);
    for (std::size_t i = 0; i < 8; ++i)
      head.replace(196 + 28 * i, 12,
                   zeros(2) + number(i == 1 ? other : bits, 1) + zeros(1) + number(13, 4, true) + number(9, 4, true));
    head[681] = 5;
    return head + std::string(bytes, '\x55');
  };
  EXPECT_EQ(said(cineon(3, 10, 10, 9 * 52)), "ok");
  EXPECT_EQ(said(cineon(3, 10, 10, 9 * 52 - 1)), "is truncated");
  EXPECT_THAT(said(cineon(200, 10, 10, 9999)), HasSubstr("its header makes no sense"));
  EXPECT_THAT(said(cineon(3, 20, 20, 9999)), HasSubstr("has samples of other sizes"));
  EXPECT_THAT(said(cineon(3, 10, 16, 9999)), HasSubstr("channels of different sizes"));
}

TEST_F(ReaderFaults, HeifOfAnotherSizeThanItClaims) {
  std::string bytes = file_bytes(AFTERGLOW_TEST_FOLDER "/fuzz/found/image/found_heif_size");
  EXPECT_EQ(said(bytes, "a.avif"), "is damaged: it claims 600×600 pixels and holds 13×9");
  bytes.replace(bytes.find("ispe") + 8, 8, number(13, 4, true) + number(9, 4, true));
  EXPECT_EQ(said(bytes, "a.avif"), "ok");
  for (std::size_t cut = bytes.find("ispe"); cut < bytes.size() - 1; cut += 5)
    EXPECT_THAT(said(bytes.substr(0, cut), "a.avif"), StartsWith("cannot be read: ")) << cut;
}

TEST_F(ReaderFaults, Jpeg2000ChannelsOfDifferentSizes) {
  make_file(folder_ / "a.jp2", 128, 96, {"R", "G", "B"}, OIIO::TypeUInt8);
  const std::string bytes = file_bytes(folder_ / "a.jp2");
  const std::size_t sizes = bytes.find(std::string("\xff\x4f\xff\x51"));
  ASSERT_NE(sizes, std::string::npos);
  EXPECT_EQ(said(bytes), "ok");
  const auto with = [&](std::size_t place, const std::string& other) {
    return std::string(bytes).replace(sizes + place, other.size(), other);
  };
  EXPECT_THAT(said(with(42 + 3 + 2, "\x05")), HasSubstr("has channels of different sizes"));
  EXPECT_THAT(said(with(20, number(1, 4, true))), HasSubstr("does not begin at its first line"));
  ReadOptions small;
  small.max_bytes = 64u << 20;
  EXPECT_THAT(said(with(8, number(16000, 4, true) + number(16000, 4, true)), "picture", small),
              HasSubstr("more than the 64 MiB allowed"));
}

TEST_F(ReaderFaults, MetadataOfOtherFormats) {
  const std::string webp = made("a.webp").substr(12);
  const std::string size = number(12, 3) + number(8, 3), head = "VP8X" + number(10, 4) + "\x08" + zeros(3) + size;
  const auto riff = [](const std::string& content) {
    return "RIFF" + number(content.size() + 4, 4) + "WEBP" + content;
  };
  EXPECT_EQ(said(riff(webp)), "ok");
  EXPECT_THAT(said(riff(head + webp + "EXIF" + number(2, 4) + "II")), HasSubstr("its EXIF metadata"));
  const auto png = [](const std::string& kind, const std::string& data) {
    return RawPng(2, 1, 8, 2).chunk(kind, data).pixels({std::string(6, '\x40')}).finish();
  };
  std::string deep = "<rdf:Description>";
  for (int i = 0; i < 1000; ++i) deep += "<a b='</a>'><!-- </a> --><![CDATA[</a>]]>";
  const std::string key = "XML:com.adobe.xmp";
  EXPECT_THAT(said(png("tEXt", key + zeros(1) + deep)), HasSubstr("nested too deeply"));
  EXPECT_THAT(said(png("iTXt", key + zeros(5) + deep)), HasSubstr("nested too deeply"));
  EXPECT_THAT(said(png("eXIf", "II*")), HasSubstr("its EXIF metadata"));
  EXPECT_THAT(said(png("tEXt", "Raw profile type exif" + zeros(1) + "\nexif\n 8\n45786966000049492a\n")),
              HasSubstr("its EXIF metadata"));
  EXPECT_EQ(said(png("tEXt", key + zeros(1) + "<rdf:Description><a/></rdf:Description>")), "ok");
}

/// A profile with one tag, of 12 bytes.
std::string profile(const std::string& kind, std::uint32_t place, std::uint32_t size, const std::string& rest = "") {
  std::string out = zeros(128);
  out.replace(36, 4, "acsp");
  out += number(1, 4, true) + "desc" + number(place, 4, true) + number(size, 4, true) + kind + rest;
  return out.replace(0, 4, number(out.size(), 4, true));
}

TEST_F(ReaderFaults, MetadataOfJpeg) {
  const std::string jpeg = made("a.jpg");
  const auto with = [&](unsigned marker, const std::string& segment) {
    return jpeg.substr(0, 2) + "\xff" + number(marker, 1) + number(segment.size() + 2, 2, true) + segment +
           jpeg.substr(2);
  };
  const std::string exif("Exif\0\0", 6), iptc = "Photoshop 3.0" + zeros(1) + "8BIM\x04\x04" + zeros(4);
  const std::string first = std::string("II*\0\x08\0\0\0\x01\0", 10);
  const std::string xmp = "http://ns.adobe.com/xap/1.0/" + zeros(1) + "<rdf:Description>";
  const std::map<std::string, std::string> damaged{
      {"no number of the name", with(0xe1, std::string("Exif\0", 5))},
      {"exif without a header", with(0xe1, exif + "II*")},
      {"no values", with(0xe1, exif + first + number(0x0112, 2) + number(3, 2) + zeros(8) + zeros(4))},
      {"a directory at the last byte",
       with(0xe1, exif + first + number(0x8769, 2) + number(4, 2) + number(1, 4) + number(22, 4) + "x")},
      {"profile without its number", with(0xe2, "ICC_PROFILE" + zeros(1))},
      {"a tag that runs over", with(0xe2, "ICC_PROFILE" + zeros(1) + "\x01\x01" + profile("text", 0xffffff00u, 0x200))},
      {"a text that is too short", with(0xe2, "ICC_PROFILE" + zeros(1) + "\x01\x01" + profile("text", 144, 4))},
      {"a name beyond the end", with(0xe2, "ICC_PROFILE" + zeros(1) + "\x01\x01" +
                                               profile("mluc", 144, 28,
                                                       zeros(4) + number(1, 4, true) + number(12, 4, true) + "enUS" +
                                                           number(40, 4, true) + number(28, 4, true)))},
      {"iptc beyond its end", with(0xed, iptc + "\xff\xff\x1c\x02\x5a" + zeros(2))},
      {"iptc without a length", with(0xed, iptc)},
  };
  EXPECT_EQ(said(jpeg), "ok");
  for (const auto& [name, bytes] : damaged) EXPECT_THAT(said(bytes), HasSubstr("is damaged: its ")) << name;
  std::string deep = xmp, flat = xmp;
  for (int i = 0; i < 10000; ++i) deep += "<a>", flat += "<a/>";
  EXPECT_THAT(said(with(0xe1, deep + "</rdf:Description>")), HasSubstr("XMP metadata is nested too deeply"));
  EXPECT_EQ(said(with(0xe1, flat + "</rdf:Description>")), "ok");
  EXPECT_EQ(said(with(0xed, iptc + zeros(1) + "\x05\x1c\x02\x5a" + zeros(2))), "ok");
  EXPECT_EQ(said(with(0xe1, exif + first + number(0x0112, 2) + number(3, 2) + number(1, 4) + number(1, 4) + zeros(4))),
            "ok");
}

}  // namespace
}  // namespace afterglow
