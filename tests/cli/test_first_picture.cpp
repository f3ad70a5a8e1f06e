// SPDX-License-Identifier: MIT
// What a video takes of its first picture and of the video that it is made from: rate, shape of a pixel, marks.
#include <OpenImageIO/imageio.h>

#include <cstdint>

#include "video_out_test.h"

namespace afterglow::test {
namespace {

class FirstPicture : public VideoOut {
 protected:
  void SetUp() override {
    VideoOut::SetUp();
    fs::create_directory(path("in"));
  }
  void make_pictures(int rate, float aspect) const {
    for (int frame = 1; frame <= 4; ++frame) {
      OIIO::ImageSpec spec(kWidth, kHeight, 3, OIIO::TypeHalf);
      const int said[2] = {rate, 1};
      if (rate > 0) spec.attribute("FramesPerSecond", OIIO::TypeRational, said);
      spec.attribute("PixelAspectRatio", aspect);
      const std::uint32_t code[2] = {0x01000000u + static_cast<std::uint32_t>(frame), 0};
      spec.attribute("smpte:TimeCode", OIIO::TypeTimeCode, code);
      const std::string name = text("in/" + std::to_string(1000 + frame) + ".exr");
      const std::vector<float> grey(std::size_t{kWidth} * kHeight * 3, 0.2f);
      const auto output = OIIO::ImageOutput::create(name);
      ASSERT_TRUE(output && output->open(name, spec));
      ASSERT_TRUE(output->write_image(OIIO::TypeFloat, grey.data()) && output->close());
    }
  }
  Outcome make(const std::string& name, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"run", "look.lua", "in/####.exr", "-o", name};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return outcome;
  }
};

TEST_F(FirstPicture, SaysTheRateOfAVideo) {
  ASSERT_NO_FATAL_FAILURE(make_pictures(25, 1));
  EXPECT_THAT(make("a.mp4").err, IsEmpty());
  EXPECT_EQ(stream_of("a.mp4").at("r_frame_rate"), "25/1");
  EXPECT_THAT(make("b.mp4", {"-v"}).err, HasSubstr("b.mp4: 25 frames a second, as the first picture says"));
  make("c.mp4", {"--fps", "30"});
  EXPECT_EQ(stream_of("c.mp4").at("r_frame_rate"), "30/1");
  EXPECT_THAT(make("-").out.substr(0, 60), HasSubstr(" F25:1 "));
  // Settings that are animated by time go by the same rate.
  write("look.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.stack { fx.color_adjustments { post_exposure = function(t) return t.fps - 25 end } }\n");
  make("d.mkv", {"--codec", "ffv1"});
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.color_adjustments {} }\n");
  make("e.mkv", {"--codec", "ffv1"});
  EXPECT_TRUE(frames_of("d.mkv") == frames_of("e.mkv"));
}

/// One that cannot be read says nothing; the next one does.
TEST_F(FirstPicture, IsTheFirstThatCanBeRead) {
  ASSERT_NO_FATAL_FAILURE(make_pictures(25, 1));
  fs::resize_file(path("in/1001.exr"), 60);
  EXPECT_EQ(run({"run", "look.lua", "in/####.exr", "-o", "a.mp4"}).exit_code, kFiles);
  EXPECT_EQ(stream_of("a.mp4").at("r_frame_rate"), "25/1");
}

TEST_F(FirstPicture, SaysTheShapeOfAPixel) {
  ASSERT_NO_FATAL_FAILURE(make_pictures(0, 2));
  for (const char* name : {"a.mp4", "a.mov", "a.mkv"}) {
    make(name);
    EXPECT_EQ(stream_of(name).at("sample_aspect_ratio"), "2:1") << name;
    EXPECT_EQ(stream_of(name).at("r_frame_rate"), "24/1") << name;
  }
  EXPECT_THAT(make("-").out.substr(0, 60), HasSubstr(" A2:1 "));
  ASSERT_NO_FATAL_FAILURE(make_pictures(0, 4.0f / 3));
  make("b.mp4");
  EXPECT_EQ(stream_of("b.mp4").at("sample_aspect_ratio"), "4:3");
}

TEST_F(FirstPicture, WhereItFailsTheTimeCodeBeginsBeforeTheNext) {
  ASSERT_NO_FATAL_FAILURE(make_pictures(24, 1));
  write("in/1001.exr", "no picture");
  const Outcome outcome = run({"run", "look.lua", "in/####.exr", "-o", "a.mov"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_EQ(stream_of("a.mov").at("tags").at("timecode"), "01:00:00:01");
}

TEST_F(FirstPicture, PicturesOfAVideoStayItsDefault) {
  ASSERT_EQ(
      shell("ffmpeg -v error -f lavfi -i testsrc2=size=96x64:rate=24 -f lavfi -i sine -t 0.5 -c:v libx264 -c:a aac "
            "-y in.mp4")
          .exit_code,
      0);
  ASSERT_EQ(run({"run", "look.lua", "in.mp4", "-o", "a.mkv"}).exit_code, kDone);
  const auto probed = probe("a.mkv", "-show_streams");
  ASSERT_EQ(probed.at("streams").size(), 2u);
  for (const auto& stream : probed.at("streams"))
    EXPECT_EQ(stream.at("disposition").at("default"), 1) << stream.at("codec_type");
}

}  // namespace
}  // namespace afterglow::test
