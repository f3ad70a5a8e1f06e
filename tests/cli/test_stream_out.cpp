// SPDX-License-Identifier: MIT
// Frames that are written into pipes.

#include "video_out_test.h"

namespace afterglow::test {
namespace {

class StreamOut : public VideoOut {};

TEST_F(StreamOut, FramesGoThroughPipes) {
  make_frames(8);
  const Outcome outcome = shell(
      "\"$AFTERGLOW\" run look.lua in/####.ppm -o - --output-space srgb --dither none --stats | ffmpeg -v error -i - "
      "-c:v ffv1 "
      "-y a.mkv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("frames: 8 done")) << "--stats goes to standard error";
  const auto frames = frames_of("a.mkv");
  ASSERT_EQ(frames.size(), 8u);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(number_of(frames[i]), static_cast<int>(i) + 1);
    EXPECT_LE(difference(frames[i], codes_of(static_cast<int>(i) + 1)), 1.2);
  }
}

TEST_F(StreamOut, BetweenTwoFfmpegs) {
  make_frames(8);
  const Outcome outcome = shell(
      "ffmpeg -v error -framerate 25 -start_number 1001 -i in/%04d.ppm -pix_fmt yuv444p -f yuv4mpegpipe - | "
      "\"$AFTERGLOW\" run look.lua - -o - | ffmpeg -v error -i - -c:v ffv1 -y a.mkv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  const auto frames = frames_of("a.mkv");
  ASSERT_EQ(frames.size(), 8u);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(number_of(frames[i]), static_cast<int>(i) + 1);
    EXPECT_LE(difference(frames[i], codes_of(static_cast<int>(i) + 1)), 2);
  }
  EXPECT_EQ(stream_of("a.mkv").at("r_frame_rate"), "25/1");
}

TEST_F(StreamOut, RawAndPicturesAreExact) {
  make_frames(3);
  std::string all;
  for (int frame = 1; frame <= 3; ++frame) all += codes_of(frame);
  ASSERT_EQ(make_video("-", {"--format", "raw", "--dither", "none"}).out, all);
  const std::string ppm = make_video("-", {"--format", "ppm", "--dither", "none"}).out;
  EXPECT_EQ(ppm, read("in/1001.ppm") + read("in/1002.ppm") + read("in/1003.ppm"));
  const Outcome exr = run({"run", "look.lua", "in/1001.ppm", "-o", "-", "--format", "exr"});
  EXPECT_EQ(exr.exit_code, kDone);
  write("a.exr", exr.out);
  EXPECT_EQ(pixels_of("a.exr").size(), kFrameBytes);
}

/// zimg makes the same YUV of the same codes, within one.
TEST_F(StreamOut, YuvIsZimgs) {
  make_frames(1);
  for (const auto& [ours, theirs] : {std::pair("yuv444p10", "yuv444p10le"), std::pair("yuv422p16", "yuv422p16le"),
                                     std::pair("yuv420p12", "yuv420p12le"), std::pair("yuv420p", "yuv420p")}) {
    const Outcome outcome = make_video("-", {"--format", "raw", "--pix-fmt", ours, "--dither", "none"});
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    ASSERT_EQ(
        shell(std::string("ffmpeg -v error -i in/1001.ppm -vf format=gbrp,zscale=m=470bg:min=gbr:rin=full:r=limited:"
                          "c=left:f=bilinear,format=") +
              theirs + " -f rawvideo -y theirs.raw")
            .exit_code,
        0);
    const std::string expected = read("theirs.raw");
    ASSERT_EQ(outcome.out.size(), expected.size()) << ours;
    const bool wide = std::string(theirs).ends_with("le");
    int most = 0;
    for (std::size_t i = 0; i + 1 < expected.size(); i += wide ? 2 : 1) {
      const auto code = [&](const std::string& bytes) {
        return static_cast<std::uint8_t>(bytes[i]) + (wide ? 256 * static_cast<std::uint8_t>(bytes[i + 1]) : 0);
      };
      most = std::max(most, std::abs(code(outcome.out) - code(expected)));
    }
    EXPECT_LE(most, std::string(ours) == "yuv422p16" ? 3 : 1) << ours;
  }
}

TEST_F(StreamOut, AClosedPipeEndsTheRun) {
  make_frames(100);
  const Outcome outcome =
      shell("{ \"$AFTERGLOW\" run look.lua in/####.ppm -o -; echo $? > code; } | head -c 1000 >/dev/null");
  EXPECT_EQ(read("code"), "4\n");
  EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("standard output: error: cannot be written: Broken pipe; whoever was reading it"));
  EXPECT_FALSE(has_leftovers());
}

TEST_F(StreamOut, AFrameThatFailsIsHeldByTheOneBefore) {
  make_frames(4);
  write("in/1001.ppm", "P6\n96 64\n255\n");
  write("in/1003.ppm", "P6\n96 64\n255\n");
  const Outcome outcome = make_video("-", {"--format", "raw", "--dither", "none"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_EQ(outcome.out, codes_of(2) + codes_of(2) + codes_of(2) + codes_of(4));
}

/// A stream of pictures says it once, as the file of one does.
TEST_F(StreamOut, TransparencyThatIsPutOnBlackIsTold) {
  const std::string half_clear("\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x20\x28\x40\x40\x40\x80", 22);
  for (const char* name : {"in/1.tga", "in/2.tga"}) write(name, half_clear);
  const Outcome outcome = run({"run", "look.lua", "in/#.tga", "-o", "-", "--format", "ppm"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  const std::string said = "standard output: ppm files have no alpha; the picture is put on black";
  const std::size_t at = outcome.err.find(said);
  ASSERT_NE(at, std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find(said, at + 1), std::string::npos) << outcome.err;
}

TEST_F(StreamOut, WhatCannotGoIntoAPipe) {
  make_frames(2);
  for (const auto& [more, message] : std::vector<std::pair<std::vector<std::string>, const char*>>{
           {{"--format", "exr"}, "takes one picture of this format; allowed: y4m, raw, png, ppm, pam, pfm for several"},
           {{"--format", "y4n"}, "'.y4n' is not a format that is written; allowed: y4m, raw, .exr"},
           {{"--pix-fmt", "rgb24"}, "y4m has no pixel format 'rgb24'; allowed: yuv420p, "},
           {{"--format", "raw", "--pix-fmt", "rgb25"}, "did you mean 'rgb24'?"},
           {{"--resume"}, "--resume goes on with files of their own"}}) {
    std::vector<std::string> arguments{"run", "look.lua", "in/####.ppm", "-o", "-"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kUsage) << message;
    EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(message));
    EXPECT_THAT(outcome.out, IsEmpty());
  }
}

}  // namespace
}  // namespace afterglow::test
