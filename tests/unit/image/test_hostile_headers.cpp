// SPDX-License-Identifier: MIT
// Headers of the other formats that ask for more than they bring.
#include <array>
#include <map>

#include "hostile_headers.h"
#include "image/picture_format.h"
#include "raw_png.h"

namespace afterglow {
namespace {
using testing::AnyOf;
using testing::HasSubstr;

// ---- PNG, JPEG

TEST_F(HostileHeaders, InterlacedPngCountsItsWholePicture) {
  ReadOptions options;
  options.max_bytes = 1000 * 1000 * 16 + (1u << 20);  // enough for the picture and some rows
  std::string png = RawPng(1000, 1000, 16, 6).chunk("IDAT", std::string(4000, 'x')).finish();
  EXPECT_THAT(refused(png, options).message, testing::Not(HasSubstr("--max-memory"))) << "row by row it fits";
  png = RawPng(1000, 1000, 16, 6, true).chunk("IDAT", std::string(4000, 'x')).finish();
  EXPECT_THAT(refused(png, options).message, HasSubstr("--max-memory"));
}

TEST_F(HostileHeaders, PngChunksAreHeldToTheirChecksumsToTheLast) {
  const std::string whole = RawPng(1, 1, 8, 0).pixels({"x"}).finish();
  for (const char* type : {"IHDR", "IDAT", "IEND"}) {
    std::string bytes = whole;
    bytes[bytes.find(type) + 4] ^= 1;  // data of the chunk, or its checksum
    EXPECT_THAT(refused(bytes).message, HasSubstr("a checksum is wrong")) << type;
  }
}

TEST_F(HostileHeaders, PngChunksThatGrow) {
  // A text and a profile of 16 MiB of zeros each, and rows that go on after the last one.
  const std::string bomb = deflated(std::string(16u << 20, '\0'));
  ASSERT_LT(bomb.size(), 20'000u);
  const std::string rows = deflated(std::string(16u << 20, '\0'));
  const std::string png = RawPng(4, 4, 8, 2)
                              .chunk("iCCP", std::string("x\0\0", 3) + bomb)
                              .chunk("zTXt", std::string("x\0\0", 3) + bomb)
                              .chunk("IDAT", rows)
                              .finish();
  write_bytes(folder_ / "grow.png", png);
  const MemoryCap cap;
  Diagnostics silent;
  const auto picture = read_picture(folder_ / "grow.png", {}, silent);  // read or refused; nothing large is taken
  if (!picture) {
    EXPECT_EQ(picture.error().kind, ErrorKind::io);
  }
}

TEST_F(HostileHeaders, JpegThatIsTooSmallForItsPixels) {
  make_file(folder_ / "a.jpg", 16, 16, {"R", "G", "B"}, OIIO::TypeUInt8);
  std::string jpeg = file_bytes(folder_ / "a.jpg");
  const std::size_t frame = jpeg.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  jpeg[frame + 5] = jpeg[frame + 7] = 0x3f;
  EXPECT_THAT(refused(jpeg).message, HasSubstr("cannot hold its pixels"));
  // A second frame header, which decoders do not look at, does not hide the first.
  std::string twice = jpeg;
  twice.insert(frame + 19, jpeg.substr(frame, 19));
  twice[frame + 19 + 5] = twice[frame + 19 + 7] = 0;
  EXPECT_THAT(refused(twice).message, HasSubstr("malformed JPEG"));
}

TEST_F(HostileHeaders, ProgressiveJpegCountsItsCoefficients) {
  OIIO::ImageSpec spec = make_spec(600, 600, {"R", "G", "B"}, OIIO::TypeUInt8);
  make_file(folder_ / "plain.jpg", {spec}, {marks(600, 600, 3)});
  spec.attribute("jpeg:progressive", 1);
  make_file(folder_ / "progressive.jpg", {spec}, {marks(600, 600, 3)});
  ReadOptions options;
  options.max_bytes = 600 * 600 * 16 + 600 * 3 * 64 + 1000;
  Diagnostics silent;
  EXPECT_TRUE(read_picture(folder_ / "plain.jpg", options, silent));
  EXPECT_THAT(refused(file_bytes(folder_ / "progressive.jpg"), options).message, HasSubstr("--max-memory"));
  EXPECT_TRUE(read_picture(folder_ / "progressive.jpg", {}, silent));
}

// ---- what OpenImageIO reads

/// A TIFF of one directory: tag, type (3 short, 4 long), value.
std::string tiff(const std::vector<std::array<std::uint32_t, 3>>& tags) {
  std::string out = "II*" + std::string(1, '\0') + little(8, 4) + little(tags.size(), 2);
  for (const auto& [tag, type, value] : tags) out += little(tag, 2) + little(type, 2) + little(1, 4) + little(value, 4);
  return out + little(0, 4) + std::string(64, '\0');
}

TEST_F(HostileHeaders, TiffSidesTilesAndSamples) {
  const auto with = [](std::uint32_t width, std::uint32_t height, std::uint32_t samples, std::uint32_t tile) {
    std::vector<std::array<std::uint32_t, 3>> tags{{256, 4, width}, {257, 4, height}, {258, 3, 8},
                                                   {259, 3, 1},     {262, 3, 1},      {277, 3, samples}};
    if (tile > 0) {
      tags.push_back({322, 4, tile});
      tags.push_back({323, 4, tile});
      tags.push_back({324, 4, 8});
      tags.push_back({325, 4, 100});
    } else {
      tags.insert(tags.begin() + 5, {273, 4, 8});
      tags.push_back({278, 4, height});
      tags.push_back({279, 4, 100});
    }
    return tiff(tags);
  };
  EXPECT_THAT(refused(with(1u << 30, 4, 1, 0)).message,
              AnyOf(HasSubstr("larger than 16384"), HasSubstr("cannot be read")));
  EXPECT_THAT(refused(with(0xffffffff, 0xffffffff, 1, 0)).message,
              AnyOf(HasSubstr("larger than 16384"), HasSubstr("cannot be read"), HasSubstr("no pixels")));
  EXPECT_THAT(refused(with(64, 64, 65535, 0)).message, HasSubstr(""));
  EXPECT_THAT(refused(with(64, 64, 1, 1u << 30)).message,
              AnyOf(HasSubstr("--max-memory"), HasSubstr("cannot be read")));
  EXPECT_THAT(refused(with(64, 64, 60000, 1u << 30)).message,
              AnyOf(HasSubstr("--max-memory"), HasSubstr("cannot be read")));
}

TEST_F(HostileHeaders, HugeSidesInTheOtherFormats) {
  const std::string huge = little(0x7ffffff0, 4);
  const std::map<std::string, std::string> files{
      {"bmp", "BM" + little(100, 4) + little(0, 4) + little(54, 4) + little(40, 4) + huge + huge + little(1, 2) +
                  little(24, 2) + little(0, 24) + std::string(64, 'x')},
      {"pnm", "P6\n2000000000 2000000000\n255\nxxxxxxxxxxxxxxxx"},
      {"pfm", "PF\n2000000000 2000000000\n-1.0\nxxxxxxxxxxxxxxx"},
      {"hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2000000000 +X 2000000000\nxxxxxxxx"},
      {"gif",
       "GIF89a\xff\xff\xff\xff" + std::string("\0\0\0,\0\0\0\0\xff\xff\xff\xff\0\x02", 14) + std::string(20, 'x')},
      {"sgi", std::string("\x01\xda\x00\x01\x00\x03\xff\xff\xff\xff\x00\x03", 12) + std::string(600, '\0')},
      {"dpx", "SDPX" + std::string(764, '\0') + std::string("\0\0\0\1\x7f\xff\xff\xff\x7f\xff\xff\xff", 12) +
                  std::string(2000, '\0')},
      {"webp", "RIFF" + little(60, 4) + "WEBPVP8L" + little(40, 4) + "\x2f\xff\xff\xff\xff" + std::string(40, 'x')},
      {"targa",
       std::string("\0\0\2\0\0\0\0\0\0\0\0\0\xff\xff\xff\xff\x18\0", 18) + "TRUEVISION-XFILE." + std::string(1, '\0')},
  };
  for (const auto& [name, bytes] : files) {
    SCOPED_TRACE(name);
    EXPECT_THAT(refused(bytes).message, AnyOf(HasSubstr("larger than 16384"), HasSubstr("cannot be read"),
                                              HasSubstr("no pixels"), HasSubstr("--max-memory")));
  }
}

TEST_F(HostileHeaders, DpxUserDataThatTheFileDoesNotHold) {
  // 4 GB of it, found by the fuzzer: the library would make room for them before it reads the first byte.
  const std::string rest(2012, '\0');
  EXPECT_EQ(refused("XPDS" + std::string(28, '\0') + std::string("\0\0\0\xf7", 4) + rest).message, "is truncated");
  EXPECT_EQ(refused("SDPX" + std::string(28, '\0') + std::string("\xf7\0\0\0", 4) + rest).message, "is truncated");
  EXPECT_EQ(refused("SDPX").message, "is truncated");
}

TEST_F(HostileHeaders, CineonUserDataThatTheFileDoesNotHold) {
  // 1.7 GB of it, by the fuzzer too.
  const std::string rest(2012, '\0');
  EXPECT_EQ(refused("\x80\x2a\x5f\xd7" + std::string(12, '\0') + std::string("\x67\x65\x48\x69", 4) + rest).message,
            "is truncated");
}

TEST_F(HostileHeaders, SgiRowsThatTheFileDoesNotHold) {
  make_file(folder_ / "whole.sgi", 9, 7, {"R", "G", "B"}, OIIO::TypeUInt8);
  std::string bytes = file_bytes(folder_ / "whole.sgi");
  bytes[2] = 1;  // rows are packed, by tables of 21 places and lengths
  bytes.insert(512, std::string(21 * 8, '\0'));
  EXPECT_THAT(refused(bytes.substr(0, 512 + 21 * 8 - 1)).message, HasSubstr("is truncated"));
  std::string length = bytes, place = bytes;
  length[512 + 21 * 8 - 4] = '\x7f';  // of the last row
  EXPECT_EQ(refused(length).message, "is truncated");
  place[512] = '\xff';
  EXPECT_EQ(refused(place).message, "is truncated");
}

/// An SGI picture whose packed rows are all this one, which is stored once.
std::string packed_sgi(int unit, int width, int height, const std::string& row, int dimensions = 3, int planes = 3) {
  std::string out =
      "\x01\xda\x01" + big(unit, 1) + big(dimensions, 2) + big(width, 2) + big(height, 2) + big(planes, 2);
  out.resize(512);
  const int rows = height * planes;
  for (int i = 0; i < rows; ++i) out += big(512 + rows * 8, 4);
  for (int i = 0; i < rows; ++i) out += big(static_cast<int>(row.size()), 4);
  return out + row;
}

TEST_F(HostileHeaders, SgiRowsThatGiveOtherPixelsThanThePictureHas) {
  const auto read = [&](const std::string& bytes) {
    write_bytes(folder_ / "good.sgi", bytes);
    Diagnostics silent;
    const auto picture = read_picture(folder_ / "good.sgi", {}, silent);
    EXPECT_TRUE(picture) << picture.error().message;
    return picture ? picture->color.width * 100 + picture->color.height : 0;
  };
  using namespace std::string_literals;
  // Five pixels: three that are told and two that are alike.
  const std::string bytes = "\x83\x01\x02\x03\x02\xff\0"s, words = "\0\x83\0\x01\0\x02\0\x03\0\x02\xff\xff\0\0"s;
  EXPECT_EQ(read(packed_sgi(1, 5, 4, bytes)), 504);
  EXPECT_EQ(read(packed_sgi(2, 5, 4, words)), 504);
  EXPECT_EQ(read(packed_sgi(1, 5, 4, bytes.substr(0, 6))), 504);  // no end is told, none is needed
  const std::string damaged = "is damaged: a row has too few or too many pixels";
  for (const int unit : {1, 2}) {
    const std::string& row = unit == 1 ? bytes : words;
    EXPECT_EQ(refused(packed_sgi(unit, 4, 4, row)).message, damaged);
    EXPECT_EQ(refused(packed_sgi(unit, 6, 4, row)).message, damaged);
    // Of a run that the row does not hold the reader would take what lies behind it in memory.
    for (std::size_t left = 0; left < 6 * row.size() / 7; ++left)
      EXPECT_EQ(refused(packed_sgi(unit, 5, 4, row.substr(0, left))).message, damaged) << unit << " " << left;
  }
  EXPECT_EQ(refused(packed_sgi(2, 3, 4, "\0\x83\0\x01\0\x02\0"s)).message, damaged);  // the fuzzer's
  // The tables have no rows, but by its dimensions the picture has.
  EXPECT_EQ(refused(packed_sgi(1, 5, 4, std::string(600, 'x'), 2, 0)).message, "is a malformed SGI picture");
  EXPECT_EQ(refused(packed_sgi(1, 5, 0, std::string(600, 'x'), 1, 3)).message, "is a malformed SGI picture");
  EXPECT_EQ(refused(packed_sgi(3, 5, 4, bytes)).message, "is a malformed SGI picture");
  EXPECT_EQ(refused(packed_sgi(1, 5, 4, bytes, 4)).message, "is a malformed SGI picture");
  EXPECT_EQ(refused(packed_sgi(1, 5, 4, bytes, 3, 33)).message, "has 33 channels, more than the 32 that are read");
  EXPECT_EQ(refused(packed_sgi(1, 0, 4, bytes)).message, "has no pixels");
}

TEST_F(HostileHeaders, SgiRowsThatLieInEachOtherAreNotReadAgainAndAgain) {
  // 3,000 good rows in a file of 65 kB: 236 runs of 127 pixels, from each of 3,000 bytes on.
  const std::string one(40000, '\xff');
  std::string all = packed_sgi(1, 236 * 127, 1000, one);
  const auto put = [&](std::size_t at, std::size_t value) {
    for (std::size_t i = 0; i < 4; ++i) all[at + i] = static_cast<char>(value >> (24 - 8 * i));
  };
  for (std::size_t i = 0; i < 3000; ++i) {
    put(512 + i * 4, all.size() - one.size() + i);
    put(512 + (3000 + i) * 4, std::size_t{236} * 128);
  }
  EXPECT_EQ(refused(all).message, "is damaged: its rows overlap");
}

TEST_F(HostileHeaders, PicturesThatReadersDecodeWholeWhenTheyOpenThem) {
  // Sizes that are allowed, of more memory than is: the readers of these formats take it before they tell the size.
  const std::string vp8 = little(0x2a019d, 3) + little(16000, 2) + little(16000, 2);
  const auto box = [](const std::string& type, const std::string& content) {
    return big(content.size() + 8, 4) + type + content;
  };
  const std::string avif = box("ftyp", "avif" + big(0, 4) + "avif"), side = big(16000, 4);
  const auto properties = [&](const std::string& width) {
    return box("iprp", box("ipco", box("ispe", big(0, 4) + width + width)));
  };
  const auto meta = [&](const std::string& boxes) { return avif + box("meta", big(0, 4) + boxes); };
  // An item that is put together from others on a canvas, told in `idat`, from its second byte on, in two extents.
  const auto made = [&](const std::string& type, const std::string& told) {
    const std::string place = big(0x4400, 2) + big(1, 2) + big(7, 2) + big(1, 2) + big(0, 2) + big(2, 2);
    return meta(box("idat", "x" + told) + properties(big(64, 4)) +
                box("iinf", big(0, 4) + big(1, 2) + box("infe", big(2 << 24, 4) + big(7, 2) + big(0, 2) + type)) +
                box("iloc", big(1 << 24, 4) + place + big(1, 4) + big(3, 4) + big(4, 4) + big(told.size() - 3, 4)));
  };
  const std::map<std::string, std::string> files{
      {"gif", "GIF89a" + little(16000, 2) + little(16000, 2) + std::string(40, '\0')},
      {"webp, lossy", "RIFF" + little(60, 4) + "WEBPVP8 " + little(48, 4) + little(0x000250, 3) + vp8},
      {"webp, lossless", "RIFF" + little(60, 4) + "WEBPVP8L" + little(48, 4) + "\x2f" + little(15999 | 15999 << 14, 4)},
      {"webp, extended",
       "RIFF" + little(60, 4) + "WEBPVP8X" + little(10, 4) + little(0, 4) + little(15999, 3) + little(15999, 3)},
      {"avif", meta(properties(side))},
      {"avif, behind 4 KiB", meta(box("free", std::string(5000, 'x')) + properties(side))},
      {"avif, grid", made("grid", big(0, 4) + big(16000, 2) + big(16000, 2))},
      {"avif, overlay", made("iovl", big(1, 2) + big(0, 8) + side + side)},
  };
  ReadOptions options;
  for (const auto& [name, bytes] : files) {
    SCOPED_TRACE(name);
    options.max_bytes = 256u << 20;
    const Error error = refused(bytes + std::string(64, '\0'), options);
    EXPECT_THAT(error.message, HasSubstr("to decode, more than the 256 MiB allowed (--max-memory)"));
    options.max_bytes = 6ull << 30;
    options.max_side = 15999;
    EXPECT_EQ(refused(bytes + std::string(64, '\0'), options).message,
              "its picture is 16000×16000, larger than 15999 a side");
    options.max_side = 16384;
  }
  options.max_bytes = 256u << 20;
  EXPECT_THAT(refused(made("grid", big(0, 4) + big(0x3e00, 2) + big(0x3e, 1)), options).message,
              HasSubstr("to decode, more than the 256 MiB allowed"));  // zeros follow what ends early
}

TEST_F(HostileHeaders, SgiOfThousandsOfChannels) {
  const auto sgi = [](int packed, int channels) {
    return "\x01\xda" + big(packed, 1) + big(1, 1) + big(3, 2) + big(9, 2) + big(7, 2) + big(channels, 2) +
           std::string(1000, '\0');
  };
  for (const int packed : {0, 1})
    EXPECT_EQ(refused(sgi(packed, 65535)).message, "has 65535 channels, more than the 32 that are read");
}

TEST_F(HostileHeaders, OnlyKnownFormatsReachALibrary) {
  // Formats of old and odd programs, playlists that name other files, and configurations that look like file names.
  for (const std::string bytes :
       {"DDS |\0\0\0", "FORM....ILBM", "SIMPLE  =                    T", "\x53\x80\xf6\x34", "#EXTM3U\nhttp://x/",
        "ffconcat version 1.0\nfile /etc/passwd", "v=0\nc=IN IP4 1.2.3.4\n", "<svg/>", "P7\nWIDTH 1\n", "8BPS"}) {
    const Error error = refused(bytes + std::string(600, ' '));
    EXPECT_EQ(error.message, "is not a picture in a format that is known") << bytes;
    EXPECT_EQ(error.allowed, kPictureFormats);
  }
}

}  // namespace
}  // namespace afterglow
