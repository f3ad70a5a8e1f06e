// SPDX-License-Identifier: MIT
// Whose words count of a video's colours: the container's and the stream's.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "clips.h"

namespace afterglow {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using Tags = Clips;

std::string encoded(const std::string& codec) {
  const std::string pq = "color_primaries=bt2020:color_trc=smpte2084:colorspace=bt2020nc";
  return fmt::format(
      "-vf setparams={} -color_primaries bt2020 -color_trc smpte2084 -colorspace bt2020nc -movflags write_colr {}", pq,
      codec);
}

/// As editing programs write it: the frames say nothing, the container all.
TEST_F(Tags, OfTheContainerCountWhereTheStreamSaysNothing) {
  struct Kind {
    const char *from, *codec, *filter, *to;
  };
  const std::string x264 = "h264_metadata=colour_primaries=2:transfer_characteristics=2:matrix_coefficients=2";
  for (const Kind& kind :
       {Kind{"a.mov", "-c:v prores_ks -pix_fmt yuv422p10le",
             "prores_metadata=color_primaries=unknown:color_trc=unknown:colorspace=unknown", "b.mov"},
        {"c.mp4", "-c:v libx264 -preset veryfast -pix_fmt yuv420p", x264.c_str(), "d.mp4"},
        {"e.mkv", "-c:v libx264 -preset veryfast -pix_fmt yuv420p", x264.c_str(), "f.mkv"}}) {
    const std::string file = clip(kind.from, encoded(kind.codec), 2);
    ffmpeg(fmt::format("-i '{}' -c copy -bsf:v {} -movflags write_colr '{}'", file, kind.filter, path(kind.to)));
    const auto movie = open(path(kind.to));
    ASSERT_TRUE(movie);
    const MovieColor& color = movie->facts().color;
    EXPECT_EQ(color.primaries, 9) << kind.to;
    EXPECT_EQ(color.transfer, 16) << kind.to;
    EXPECT_EQ(color.matrix, 9) << kind.to;
    EXPECT_THAT(movie->facts().notes, Not(Contains(HasSubstr("does not say")))) << kind.to;
    EXPECT_THAT(movie->facts().warnings, testing::IsEmpty()) << kind.to;
  }
}

/// ISO/IEC 14496-12: the box overrides the bitstream. Matroska has no such rule.
TEST_F(Tags, WhereBothSpeakOneIsTakenAndTold) {
  for (const auto& [from, to, counts] : {std::tuple("a.mov", "b.mov", 16), {"c.mkv", "d.mkv", 1}}) {
    const std::string file = clip(from, encoded("-c:v libx264 -preset veryfast -pix_fmt yuv420p"), 2);
    ffmpeg(
        fmt::format("-i '{}' -c copy -movflags write_colr -bsf:v "
                    "h264_metadata=colour_primaries=1:transfer_characteristics=1:matrix_coefficients=1 '{}'",
                    file, path(to)));
    messages_.clear();
    const auto movie = open(path(to));
    ASSERT_TRUE(movie);
    EXPECT_EQ(movie->facts().color.transfer, counts);
    EXPECT_EQ(movie->facts().color.matrix, counts == 16 ? 9 : 1);
    EXPECT_THAT(messages_,
                Contains(HasSubstr("says primaries 9, transfer 16, matrix 9 (of H.273), its stream 1, 1, 1")));
  }
}

/// Frames of DNxHR that leave the matrix to the container are decoded as of BT.709.
TEST_F(Tags, TheMatrixOfDnxhrIsTheContainers) {
  const auto movie = open(clip("a.mov", encoded("-c:v dnxhd -profile:v dnxhr_hqx -pix_fmt yuv422p10le -s 256x128"), 2));
  ASSERT_TRUE(movie);
  EXPECT_EQ(movie->facts().color.matrix, 9);
  EXPECT_THAT(movie->facts().warnings, testing::IsEmpty());
}

}  // namespace
}  // namespace afterglow
