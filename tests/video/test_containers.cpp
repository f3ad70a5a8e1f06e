// SPDX-License-Identifier: MIT
// What containers say of frames: edit lists, time stamps, rotation, the shape of pixels, fields.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <zlib.h>

#include <fstream>
#include <sstream>

#include "clips.h"
#include "core/file.h"
#include "image/srgb.h"
#include "play/footage.h"

namespace afterglow {
namespace {

using testing::Contains;
using testing::HasSubstr;
using Containers = Clips;

constexpr const char* kPlainX264 = "-c:v libx264 -preset veryfast -crf 12 -g 12 -bf 3 -pix_fmt yuv420p";

TEST_F(Containers, EditListsSayWhereAClipBegins) {
  const std::string whole = clip("whole.mp4", kPlainX264);
  ffmpeg(fmt::format("-ss 0.71 -i '{}' -c copy '{}'", whole, path("cut.mp4")));
  const auto movie = open(path("cut.mp4"));
  ASSERT_TRUE(movie);
  const std::vector<int> shown = numbers_by_ffmpeg(path("cut.mp4"));
  ASSERT_GT(shown.front(), 13) << "the clip is to begin within a group of pictures";
  ASSERT_EQ(movie->frames(), static_cast<int>(shown.size()));
  for (const int frame : {0, movie->frames() - 1, 1, 9, 0}) {
    const auto picture = read(movie, frame);
    ASSERT_TRUE(picture) << picture.error().text();
    EXPECT_EQ(number_of(*picture), shown[static_cast<std::size_t>(frame)]);
  }
  EXPECT_EQ(movie->time(0), 0);
}

/// Joined MPEG streams: the second begins when the first has ended, whatever its clock says.
TEST_F(Containers, ClocksThatStartAnewRunOn) {
  const std::string mpeg2 = "-c:v mpeg2video -q:v 2 -g 12 -bf 2 -pix_fmt yuv420p";
  for (const auto& [end, codec] : {std::pair("ts", std::string(kPlainX264)), {"ts", mpeg2}, {"mpg", mpeg2}})
    for (const char* offsets : {"0 0", "0 100", "100 0", "100 20", "95430 0", "95441"}) {
      const std::string name = fmt::format("{}: {} at {}", end, codec, offsets);
      std::string joined;
      std::istringstream in(offsets);
      for (int offset = 0; in >> offset;)
        joined += read_file(clip(fmt::format("{}.{}", offset, end),
                                 fmt::format("{} -output_ts_offset {}", codec, offset), 36))
                      .value();
      std::ofstream(path(fmt::format("joined.{}", end)), std::ios::binary) << joined;
      const auto movie = open(path(fmt::format("joined.{}", end)));
      ASSERT_TRUE(movie) << name;
      ASSERT_EQ(movie->frames() % 36, 0) << name;
      EXPECT_EQ(movie->frames(), std::string(offsets).find(' ') == std::string::npos ? 36 : 72) << name;
      for (const int frame : {0, 34, 35, 36, 37, 71, 20, 50}) {
        if (frame >= movie->frames()) continue;
        const auto picture = read(movie, frame);
        ASSERT_TRUE(picture) << name << ": " << picture.error().text();
        EXPECT_EQ(number_of(*picture), frame % 36 + 1) << name;
        EXPECT_NEAR(movie->time(frame), frame / 24.0, 1e-3) << name;
      }
    }
}

TEST_F(Containers, VariableRatesKeepTheirTimes) {
  const auto movie =
      open(clip("varies.mp4",
                std::string(kPlainX264) + " -vf \"setpts='if(lt(N,10),N,10+(N-10)*3)/24/TB'\" -vsync passthrough "
                                          "-video_track_timescale 24000",
                30));
  ASSERT_TRUE(movie);
  ASSERT_EQ(movie->frames(), 30);
  EXPECT_TRUE(movie->variable_rate());
  for (int frame = 0; frame < 30; ++frame) {
    EXPECT_NEAR(movie->time(frame), (frame < 10 ? frame : 10 + (frame - 10) * 3) / 24.0, 1e-4) << frame;
    EXPECT_EQ(number_of(read(movie, frame).value()), frame + 1);
  }
  FootageOptions options;
  options.inputs = {path("varies.mp4")};
  Diagnostics quiet;
  const auto footage = Footage::open(options, quiet);
  ASSERT_TRUE(footage) << footage.error().text();
  // Turns as long as the shortest frame; later frames stay for three.
  EXPECT_NEAR((*footage)->fps().value(), 24, 1e-2);
  EXPECT_EQ((*footage)->frames(), 10 + 19 * 3 + 1);
  for (const auto& [position, number] : {std::pair{9, 10}, std::pair{10, 11}, std::pair{12, 11}, std::pair{13, 12}}) {
    EXPECT_EQ((*footage)->frame(position).number, number) << position;
    EXPECT_NEAR((*footage)->frame(position).time.value(), movie->time(number - 1), 1e-9);
  }
}

/// A movie whose track says how it is to be turned: the matrix (a, b; c, d) of its header.
std::string turned(const std::string& file, const std::array<int, 4>& axes) {
  std::string bytes = read_file(file).value();
  const std::size_t matrix = bytes.find("tkhd") + 4 + 40;
  const auto put = [&](std::size_t place, int value) {
    const auto fixed = static_cast<std::uint32_t>(value * 65536);
    for (std::size_t i = 0; i < 4; ++i) bytes[matrix + 4 * place + i] = static_cast<char>(fixed >> (24 - 8 * i));
  };
  put(0, axes[0]), put(1, axes[1]), put(3, axes[2]), put(4, axes[3]);
  const std::string out = file + fmt::format("{}{}{}{}.mov", axes[0], axes[1], axes[2], axes[3]);
  std::ofstream(out, std::ios::binary) << bytes;
  return out;
}

TEST_F(Containers, EveryRotationAndFlipIsApplied) {
  const std::string plain = clip("plain.mov", "-c:v png -pix_fmt rgb24", 3);
  for (const auto& axes :
       {std::array{1, 0, 0, 1}, std::array{0, 1, -1, 0}, std::array{-1, 0, 0, -1}, std::array{0, -1, 1, 0},
        std::array{-1, 0, 0, 1}, std::array{1, 0, 0, -1}, std::array{0, 1, 1, 0}, std::array{0, -1, -1, 0}}) {
    const std::string file = turned(plain, axes);
    const auto movie = open(file);
    ASSERT_TRUE(movie);
    const auto picture = read(movie, 1);
    ASSERT_TRUE(picture) << picture.error().text();
    const Size size = picture->color.size();
    EXPECT_EQ(size.width, axes[0] == 0 ? kClipHeight : kClipWidth);
    const std::string raw = path("turned.raw");
    ffmpeg(fmt::format("-i '{}' -f rawvideo -pix_fmt rgb24 '{}'", file, raw));
    const std::string bytes = read_file(raw).value();
    const auto* codes = reinterpret_cast<const std::uint8_t*>(bytes.data()) + size.area() * 3;
    int differ = 0;
    for (long long i = 0; i < size.area(); ++i)
      for (int c = 0; c < 3; ++c) {
        const double v = codes[i * 3 + c] / 255.0;
        const double light = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
        differ += std::abs(picture->color.pixels[static_cast<std::size_t>(i * 4 + c)] - light) > 1e-5;
      }
    EXPECT_EQ(differ, 0) << file;
  }
}

TEST_F(Containers, PixelsAreMadeSquare) {
  const auto wide = open(clip("wide.mp4", std::string(kPlainX264) + " -vf setsar=2/1", 3));
  ASSERT_TRUE(wide);
  EXPECT_EQ(wide->facts().size, (Size{2 * kClipWidth, kClipHeight}));
  EXPECT_THAT(messages_, Contains(HasSubstr("its pixels are 2:1; 192x96 is scaled to 384x96 square ones")));
  const auto picture = read(wide, 2).value();
  EXPECT_EQ(picture.color.size(), (Size{2 * kClipWidth, kClipHeight}));
  EXPECT_EQ(number_of(picture), 3);
  const auto tall = open(clip("tall.mkv", std::string(kPlainX264) + " -vf setsar=1/2", 3));
  ASSERT_TRUE(tall);
  EXPECT_EQ(read(tall, 1).value().color.size(), (Size{kClipWidth, 2 * kClipHeight}));
}

TEST_F(Containers, InterlacedMaterialIsTold) {
  ASSERT_TRUE(
      open(clip("fields.ts", "-c:v mpeg2video -q:v 2 -flags +ilme+ildct -vf setfield=tff -pix_fmt yuv420p", 5)));
  EXPECT_THAT(messages_, Contains(HasSubstr("is interlaced")));
}

TEST_F(Containers, WhatAVideoDoesNotSayIsNoted) {
  ASSERT_TRUE(open(clip("untold.mkv", "-c:v ffv1 -pix_fmt yuv420p", 2)));
  EXPECT_THAT(messages_, Contains(HasSubstr("does not say its matrix, primaries, transfer; BT.601")));
}

/// The chunks in front count for all frames, as for a PNG that does not move.
TEST_F(Containers, APngThatMovesHasTheColoursOfItsHead) {
  const std::string file = clip("a.png", "-f apng -plays 0 -pix_fmt rgb24", 3);
  std::string bytes = read_file(file).value();
  const auto number = [](std::uint32_t value) {
    std::string out;
    for (int i = 3; i >= 0; --i) out += static_cast<char>(value >> (8 * i) & 255);
    return out;
  };
  const auto chunk = [&](const std::string& type, const std::string& data) {
    const std::string checked = type + data;
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
    return number(static_cast<std::uint32_t>(data.size())) + checked + number(static_cast<std::uint32_t>(sum));
  };
  const std::string exif("II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0", 26);
  constexpr std::size_t kBehindHead = 33;  // signature and IHDR
  // Others of the kind that FFmpeg has written go.
  for (const std::string type : {"gAMA", "cHRM", "sRGB", "iCCP", "cICP"})
    if (const std::size_t at = bytes.find(type); at != std::string::npos)
      bytes.erase(at - 4, 12 + static_cast<unsigned char>(bytes[at - 1]));
  bytes.insert(kBehindHead, chunk("gAMA", number(100000)) + chunk("eXIf", exif));
  std::ofstream(path("b.apng"), std::ios::binary) << bytes;
  const auto plain = open(file), linear = open(path("b.apng"));
  ASSERT_TRUE(plain && linear);
  const Picture a = read(plain, 1).value(), b = read(linear, 1).value();
  ASSERT_EQ(b.color.size(), (Size{a.color.height, a.color.width})) << "turned";
  // The corner at the lower left is at the upper left now.
  const float* stored = a.color.at(0, a.color.height - 1);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(srgb_to_linear(b.color.at(0, 0)[c]), stored[c], 1e-5) << c;
}

/// Of a matrix that is said, primaries that go with it and no other.
TEST_F(Containers, APartlyTaggedVideoDoesNotContradictItself) {
  for (const auto& [matrix, primaries] : {std::pair("bt2020nc", 9), {"bt709", 1}, {"smpte170m", 5}}) {
    const auto movie =
        open(clip(fmt::format("{}.mkv", matrix), fmt::format("-c:v ffv1 -pix_fmt yuv420p -colorspace {}", matrix), 2));
    ASSERT_TRUE(movie);
    EXPECT_EQ(movie->facts().color.primaries, primaries) << matrix;
  }
  EXPECT_THAT(messages_, Contains(HasSubstr("does not say its primaries, transfer; BT.2020, as the rest, is taken")));
}

/// AVIF and HEIF sequences keep their alpha in another track, which is not the picture however large it is.
TEST_F(Containers, TheFirstTrackOfAPictureSequenceIsThePicture) {
  ffmpeg(
      fmt::format("-f lavfi -i color=red:s=64x64:r=10 -f lavfi -i nullsrc=s=64x64:r=10,geq=lum='random(0)*255' "
                  "-frames:v 4 -map 0 -map 1 -c:v libaom-av1 -cpu-used 8 -crf 10 -pix_fmt:v:0 yuv420p "
                  "-pix_fmt:v:1 gray -f mp4 -brand avis '{}'",
                  path("moves.avif")));
  const auto movie = open(path("moves.avif"));
  ASSERT_TRUE(movie);
  const auto picture = read(movie, 1).value();
  EXPECT_GT(picture.color.pixels[0], 0.5f);
  EXPECT_LT(picture.color.pixels[1], 0.1f);
  EXPECT_THAT(messages_, Contains(HasSubstr("its alpha is in a track of its own, which is not read")));
}

TEST_F(Containers, OtherFilesAreNeverOpened) {
  const std::string whole = clip("whole.mov", "-c:v png -pix_fmt rgb24", 2);
  // A QuickTime file whose samples lie in another one: its data reference is no longer its own.
  std::string bytes = read_file(whole).value();
  const std::size_t at = bytes.find("url \0\0\0\1", bytes.find("dref"), 8);
  ASSERT_NE(at, std::string::npos);
  bytes[at + 7] = 0;
  std::ofstream(path("elsewhere.mov"), std::ios::binary) << bytes;
  const auto movie = try_open(path("elsewhere.mov"));
  if (movie) {  // its own samples, at the most
    EXPECT_EQ(number_of(read(*movie, 0).value()), 1);
  }
  // Playlists are no containers that are read.
  std::ofstream(path("list.m3u8")) << "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\n" << whole << "\n";
  EXPECT_EQ(movie_format(path("list.m3u8")), "");
  std::ofstream(path("list.ffconcat")) << "ffconcat version 1.0\nfile " << whole << "\n";
  EXPECT_EQ(movie_format(path("list.ffconcat")), "");
}

TEST_F(Containers, StillPicturesAreNoVideos) {
  ffmpeg(
      fmt::format("-f lavfi -i color=red:s=32x32 -frames:v 1 '{}' -frames:v 1 '{}'", path("one.gif"), path("one.png")));
  EXPECT_EQ(movie_format(path("one.gif")), "");
  EXPECT_EQ(movie_format(path("one.png")), "");
  clip("moves.apng", "-f apng -c:v apng", 3);
  EXPECT_EQ(movie_format(path("moves.apng")), "apng");
}

}  // namespace
}  // namespace afterglow
