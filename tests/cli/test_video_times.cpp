// SPDX-License-Identifier: MIT
// Times of a video's frames: what is told where they cannot be kept, or not be changed.
#include "video_out_test.h"

namespace afterglow::test {
namespace {

class VideoTimes : public VideoOut {
 protected:
  void SetUp() override {
    VideoOut::SetUp();
    make_frames(24);
    ASSERT_EQ(shell("ffmpeg -v error -framerate 24 -start_number 1001 -i in/%04d.ppm -c:v ffv1 even.mkv").exit_code, 0);
  }
  /// What is said when it becomes this.
  std::string said(const std::string& from, const std::string& to, const std::string& more = "") const {
    const Outcome outcome = shell("\"$AFTERGLOW\" run look.lua " + from + " -o " + to + " " + more);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return outcome.err;
  }
};

TEST_F(VideoTimes, ARateForAVideoIsTold) {
  const std::string own =
      "warning: even.mkv: frames of a video keep their own times (24 a second); --fps is for pictures\n";
  for (const std::string to : {"out.mkv", "out.####.png", "- >out.y4m"}) {
    EXPECT_EQ(said("even.mkv", to, "--fps 12"), own) << to;
    EXPECT_EQ(said("even.mkv", to, "--fps 24"), "") << to;
  }
  EXPECT_THAT(said("-", "out.####.png", "--fps 12 <out.y4m"), HasSubstr("keep their own times (24 a second)"));
  EXPECT_EQ(said("in/####.ppm", "out.mkv", "--fps 12"), "");
  EXPECT_EQ(stream_of("out.mkv").at("avg_frame_rate"), "12/1");
}

/// Pictures and streams have no times.
TEST_F(VideoTimes, ThoseThatAreLostAreTold) {
  ASSERT_EQ(shell("ffmpeg -v error -i even.mkv -vf \"select=not(between(n\\,7\\,9))\" -fps_mode passthrough -c:v ffv1 "
                  "hole.mkv")
                .exit_code,
            0);
  for (const auto& [to, word] : {std::pair("out.####.png", "pictures"), {"- >out.y4m", "a stream"}}) {
    EXPECT_EQ(said("hole.mkv", to), std::string("warning: hole.mkv: its frames come at no even rate, which ") + word +
                                        " cannot say; .mp4, .mov and .mkv keep the times, and ffmpeg -fps_mode cfr "
                                        "makes the rate even before\n");
    EXPECT_EQ(said("even.mkv", to), "");
  }
  EXPECT_EQ(said("hole.mkv", "part.####.png", "--frames 10-20"), "") << "these are even";
  EXPECT_EQ(said("hole.mkv", "out.mkv"), "");
}

/// EXR and DPX have two bits for the tens.
TEST_F(VideoTimes, ATimeCodeThatDoesNotFitIsTold) {
  ASSERT_EQ(shell("ffmpeg -v error -framerate 50 -start_number 1001 -i in/%04d.ppm -c:v prores_ks -timecode "
                  "01:02:03:30 fast.mov")
                .exit_code,
            0);
  for (const std::string format : {"exr", "dpx"}) {
    const std::string told = said("fast.mov", "fast.####." + format);  // several are written at a time
    EXPECT_EQ(std::ranges::count(told, '\n'), 1) << told;
    EXPECT_THAT(told, ::testing::StartsWith("warning: fast.00"));
    EXPECT_THAT(told, HasSubstr("." + format + ": the time code 01:02:03:4"));
    EXPECT_THAT(told, HasSubstr(" is left out: EXR and DPX hold frame numbers up to 39; PNG and videos hold all\n"));
  }
  EXPECT_EQ(said("fast.mov", "fast.####.png"), "");
  EXPECT_EQ(said("fast.mov", "few.####.exr", "--frames 1-10"), "");
  EXPECT_EQ(said("fast.####.png", "again.mov", "--frames 11-20"), "");
  EXPECT_EQ(stream_of("again.mov").at("tags").at("timecode"), "01:02:03:40");
}

TEST_F(VideoTimes, SeveralVideosAreToldBeforeAnyWork) {
  ASSERT_EQ(shell("cp even.mkv more.mkv").exit_code, 0);
  const auto refused = [&](const std::vector<std::string>& arguments, int code) {
    std::vector<std::string> all{"run", "look.lua"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Outcome outcome = run(all);
    EXPECT_EQ(outcome.exit_code, code) << outcome.err;
    return outcome.err;
  };
  EXPECT_EQ(refused({"even.mkv", "more.mkv", "-o", "out.mkv"}, kUsage),
            "afterglow run: error: even.mkv and more.mkv are videos, and one video is made of one; allowed: a run for "
            "each; ffmpeg -f concat joins what they make\n");
  EXPECT_EQ(refused({"even.mkv", "more.mkv", "-o", "out.####.png"}, kUsage),
            "afterglow run: error: even.mkv and more.mkv would both be written to out.0001.png; allowed: a folder like "
            "out/, where frames have the names of their videos; a run for each\n");
  EXPECT_EQ(refused({"nofile.exr", "-o", "out.png", "--frames", "1-3"}, kFiles), "nofile.exr: error: no such file\n");
  EXPECT_EQ(refused({"evem.mkv", "-o", "out.png", "--frames", "3"}, kFiles),
            "evem.mkv: error: no such file; did you mean 'even.mkv'?\n");
}

}  // namespace
}  // namespace afterglow::test
