// SPDX-License-Identifier: MIT
// Any frame by number is that of a decode from the beginning: by the numbers burnt in and by hash.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <random>

#include "clips.h"

namespace afterglow {
namespace {

struct ClipKind {
  const char* name;
  const char* arguments;
  bool alpha = false;
  int count = 48;
};

void PrintTo(const ClipKind& kind, std::ostream* out) { *out << kind.name; }

class EveryKind : public Clips, public testing::WithParamInterface<ClipKind> {};

/// Numbers of frames in an order that makes a decoder go back and forth.
std::vector<int> hard_order(int frames) {
  std::vector<int> order{0, frames - 1, 0};
  for (int key = 12; key < frames; key += 12)
    for (const int near : {key - 1, key, key + 1, key - 2}) order.push_back(std::min(near, frames - 1));
  std::mt19937 random(7);
  for (int i = 0; i < 12; ++i) order.push_back(static_cast<int>(random() % static_cast<unsigned>(frames)));
  for (int frame = frames - 1; frame >= 0; --frame) order.push_back(frame);
  return order;
}

TEST_P(EveryKind, FramesByNumberAreThoseOfADecodeFromTheBeginning) {
  const ClipKind& kind = GetParam();
  const std::string file = clip(kind.name, kind.arguments, kind.count, kind.alpha);
  const auto movie = open(file);
  ASSERT_TRUE(movie);
  ASSERT_EQ(movie->frames(), kind.count);
  std::vector<Hash> hashes;
  for (int frame = 0; frame < movie->frames(); ++frame) {
    const auto picture = read(movie, frame);
    ASSERT_TRUE(picture) << picture.error().text();
    ASSERT_EQ(number_of(*picture), frame + 1) << "frame " << frame;
    EXPECT_EQ(picture->has_alpha, kind.alpha);
    EXPECT_NEAR(movie->time(frame), frame / 24.0, 1.1e-3) << frame;
    hashes.push_back(hash_of(movie, frame));
  }
  EXPECT_NEAR(movie->fps(), 24, 0.02);
  EXPECT_FALSE(movie->variable_rate());
  for (const int frame : hard_order(movie->frames()))
    ASSERT_EQ(hash_of(movie, frame), hashes[static_cast<std::size_t>(frame)]) << "frame " << frame;
  // A reader that begins there, without anything in memory.
  for (const int frame : {kind.count - 1, 13, 11, 12, 1}) {
    const auto fresh = open(file);
    ASSERT_TRUE(fresh);
    ASSERT_EQ(hash_of(fresh, frame), hashes[static_cast<std::size_t>(frame)]) << "anew at " << frame;
  }
}

constexpr const char* kX264 = "-c:v libx264 -preset veryfast -crf 12 -g 12 -bf 3 -pix_fmt yuv420p";

INSTANTIATE_TEST_SUITE_P(
    Video, EveryKind,
    testing::Values(
        ClipKind{"h264.mp4", kX264}, ClipKind{"h264.mov", kX264}, ClipKind{"h264.mkv", kX264},
        ClipKind{"h264.ts", kX264}, ClipKind{"h264.avi", kX264},
        ClipKind{
            "h264_open.mp4",
            "-c:v libx264 -preset veryfast -crf 12 -g 12 -bf 3 -x264-params open-gop=1:bframes=3 -pix_fmt yuv420p"},
        ClipKind{
            "h264_open.ts",
            "-c:v libx264 -preset veryfast -crf 12 -g 12 -bf 3 -x264-params open-gop=1:bframes=3 -pix_fmt yuv420p"},
        ClipKind{"h264_refresh.ts",
                 "-c:v libx264 -preset veryfast -crf 12 -g 12 -x264-params intra-refresh=1 -pix_fmt yuv420p"},
        ClipKind{"h264_fragments.mp4",
                 "-c:v libx264 -preset veryfast -crf 12 -g 12 -movflags frag_keyframe+empty_moov -pix_fmt yuv420p"},
        ClipKind{"h265.mp4",
                 "-c:v libx265 -preset ultrafast -crf 12 -pix_fmt yuv420p10le -x265-params "
                 "keyint=12:bframes=3:open-gop=1:log-level=none"},
        ClipKind{"h265.mkv",
                 "-c:v libx265 -preset ultrafast -crf 12 -pix_fmt yuv422p12le -x265-params "
                 "keyint=12:bframes=3:log-level=none"},
        ClipKind{
            "vp9.webm",
            "-c:v libvpx-vp9 -crf 15 -b:v 0 -g 12 -deadline realtime -cpu-used 8 -auto-alt-ref 1 -lag-in-frames 16"},
        ClipKind{"vp9.mp4", "-c:v libvpx-vp9 -crf 15 -b:v 0 -g 12 -deadline realtime -cpu-used 8"},
        ClipKind{"vp8.webm",
                 "-c:v libvpx -crf 8 -b:v 2M -g 12 -deadline realtime -cpu-used 8 -auto-alt-ref 1 -lag-in-frames 16"},
        ClipKind{
            "vp9_alpha.webm",
            "-c:v libvpx-vp9 -crf 15 -b:v 0 -g 12 -deadline realtime -cpu-used 8 -auto-alt-ref 0 -pix_fmt yuva420p",
            true},
        ClipKind{"av1.mp4", "-c:v libaom-av1 -crf 15 -b:v 0 -g 12 -cpu-used 8 -usage realtime -pix_fmt yuv420p"},
        ClipKind{"av1.mkv", "-c:v libaom-av1 -crf 15 -b:v 0 -g 12 -cpu-used 8 -lag-in-frames 16 -pix_fmt yuv420p10le"},
        ClipKind{"prores.mov", "-c:v prores_ks -profile:v hq -pix_fmt yuv422p10le"},
        ClipKind{"prores4444.mov", "-c:v prores_ks -profile:v 4444 -pix_fmt yuva444p10le", true},
        ClipKind{"dnxhr.mxf", "-vf scale=1920:1080:flags=neighbor -c:v dnxhd -profile:v dnxhr_hq -pix_fmt yuv422p",
                 false, 14},
        ClipKind{"dnxhr.mov", "-vf scale=384:192:flags=neighbor -c:v dnxhd -profile:v dnxhr_444 -pix_fmt gbrp10le"},
        ClipKind{"ffv1.mkv", "-c:v ffv1 -level 3 -g 1 -pix_fmt gbrp16le"},
        ClipKind{"ffv1_gop.mkv", "-c:v ffv1 -level 3 -g 12 -pix_fmt bgra", true},
        ClipKind{"mjpeg.avi", "-c:v mjpeg -q:v 2 -pix_fmt yuvj422p"},
        ClipKind{"mjpeg.mov", "-c:v mjpeg -q:v 2 -pix_fmt yuvj420p"},
        ClipKind{"mpeg2.mpg", "-c:v mpeg2video -q:v 2 -g 12 -bf 2 -pix_fmt yuv420p"},
        ClipKind{"mpeg2.ts", "-c:v mpeg2video -q:v 2 -g 12 -bf 2 -pix_fmt yuv420p"},
        ClipKind{"clip.y4m", "-pix_fmt yuv444p"}, ClipKind{"raw.nut", "-c:v rawvideo -pix_fmt rgb48be"},
        ClipKind{"raw.avi", "-c:v rawvideo -pix_fmt bgr24"}, ClipKind{"utvideo.mkv", "-c:v utvideo -pix_fmt gbrp"},
        ClipKind{"grey.mkv", "-c:v ffv1 -level 3 -pix_fmt gray10le"},
        ClipKind{"qtrle.mov", "-c:v qtrle -pix_fmt argb", true},
        ClipKind{"moves.apng", "-f apng -c:v apng -pix_fmt rgba", true}),
    [](const auto& info) {
      std::string name = info.param.name;
      for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
      return name;
    });

/// GIF has times in hundredths of a second and 256 colours.
TEST_F(Clips, GifMovesByItsOwnClock) {
  const auto movie =
      open(clip("moves.gif", "-filter_complex '[0]split[a][b];[a]palettegen[p];[b][p]paletteuse' -c:v gif", 30));
  ASSERT_TRUE(movie);
  ASSERT_EQ(movie->frames(), 30);
  for (const int frame : {0, 29, 7, 8, 3, 29}) {
    const auto picture = read(movie, frame);
    ASSERT_TRUE(picture) << picture.error().text();
    EXPECT_EQ(number_of(*picture), frame + 1);
    EXPECT_NEAR(movie->time(frame), frame / 24.0, 0.006);
  }
}

}  // namespace
}  // namespace afterglow
