// SPDX-License-Identifier: MIT
// `afterglow run` over videos and pipes, as users run it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <random>

#include "clips.h"
#include "core/file.h"
#include "core/text.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

class RunVideos : public Clips {
 protected:
  void SetUp() override {
    Clips::SetUp();
    std::ofstream(path("look.lua")) << "local fx = require 'afterglow'\nreturn fx.stack { fx.exposure { ev = 0 } }\n";
  }
  /// A line of the shell in the test's folder, in which AFTERGLOW is the program; its messages are in `said_`.
  int shell(std::string line) {
    const std::string program =
        fmt::format("AFTERGLOW_CACHE='{}' '{}'", AFTERGLOW_BUILD_FOLDER "/test-cache", AFTERGLOW_PROGRAM);
    for (std::size_t at = 0; (at = line.find("AFTERGLOW ", at)) != std::string::npos; at += program.size())
      line.replace(at, 9, program);
    std::ofstream(path("line.sh")) << "set -o pipefail\n" << line << "\n";
    const int status = std::system(fmt::format("cd '{}' && bash line.sh 2>messages", path("")).c_str());
    said_ = read_file(path("messages")).value();
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  int number_in(const std::string& file) const {
    Diagnostics quiet;
    const auto picture = read_picture(path(file), {}, quiet);
    return picture ? number_of(*picture) : -1;
  }
  /// Values that ffprobe prints of a file, or of one of its streams.
  std::string probed(const std::string& entries, const std::string& file, const std::string& stream = "") {
    const std::string of = stream.empty() ? "" : "-select_streams " + stream;
    EXPECT_EQ(shell(fmt::format("ffprobe -v error {} -show_entries {} -of csv=p=0:nk=1 {} >probed", of, entries, file)),
              0)
        << said_;
    return trim(read_file(path("probed")).value());
  }
  std::string said_;
};

constexpr const char* kCodec = "-c:v libx264 -preset veryfast -crf 12 -g 12 -bf 3 -pix_fmt yuv420p";

TEST_F(RunVideos, FramesByNumberBecomeFiles) {
  clip("clip.mp4", kCodec, 30);
  ASSERT_EQ(shell("AFTERGLOW run look.lua clip.mp4 -o out.####.png --frames 28-30,5"), 0) << said_;
  for (const int frame : {5, 28, 29, 30}) EXPECT_EQ(number_in(fmt::format("out.{:04}.png", frame)), frame);
  EXPECT_FALSE(std::filesystem::exists(path("out.0006.png")));
  EXPECT_EQ(shell("mkdir many && AFTERGLOW run look.lua clip.mp4 -o many --frames 7 --format exr"), 0) << said_;
  EXPECT_EQ(number_in("many/clip.0007.exr"), 7);
  EXPECT_EQ(shell("AFTERGLOW run look.lua clip.mp4 -o out.####.png --frames 31"), 4);
  EXPECT_THAT(said_, HasSubstr("clip.mp4: error: has no frame 31; it has 30"));
  EXPECT_EQ(shell("AFTERGLOW run look.lua clip.mp4 -o one.png"), 2);
  EXPECT_THAT(said_, HasSubstr("30 frames cannot go into the one file one.png"));
  EXPECT_EQ(shell("AFTERGLOW run look.lua clip.mp4 -o many --frames 7"), 2);
  EXPECT_THAT(said_, HasSubstr("need --format"));
  // LeakSanitizer looks by ptrace, if the program was built for it.
  EXPECT_EQ(shell("ASAN_OPTIONS=detect_leaks=0 AFTERGLOW run look.lua clip.mp4 -o sandbox.png --frames 30 --sandbox"),
            0)
      << said_;
  EXPECT_EQ(number_in("sandbox.png"), 30);
}

/// Settings that are animated by time see the clip's stamps.
TEST_F(RunVideos, TimesAreTheClips) {
  clip("varies.mp4", std::string(kCodec) + " -vf \"setpts='if(lt(N,2),N,2+(N-2)*12)/24/TB'\" -vsync passthrough", 4);
  std::ofstream(path("time.lua")) << "local fx = require 'afterglow'\n"
                                     "return fx.stack { fx.exposure { ev = function(t) return t.time end } }\n";
  ASSERT_EQ(shell("AFTERGLOW run time.lua varies.mp4 -o t.####.exr --type float && "
                  "AFTERGLOW run look.lua varies.mp4 -o p.####.exr --type float"),
            0)
      << said_;
  const double times[] = {0, 1 / 24.0, 2 / 24.0, 14 / 24.0};
  for (int frame = 1; frame <= 4; ++frame) {
    Diagnostics quiet;
    const auto plain = read_picture(path(fmt::format("p.{:04}.exr", frame)), {}, quiet).value();
    const auto timed = read_picture(path(fmt::format("t.{:04}.exr", frame)), {}, quiet).value();
    EXPECT_NEAR(std::log2(timed.color.at(50, 60)[1] / plain.color.at(50, 60)[1]), times[frame - 1], 2e-3) << frame;
  }
}

/// The last one too, which may be shorter or longer than the others.
TEST_F(RunVideos, FramesShowAsLongAsTheyDid) {
  const auto length = [&](const std::string& name) {
    EXPECT_EQ(shell(fmt::format("ffprobe -v error -show_entries format=duration -of csv=p=0 {} >length", name)), 0)
        << said_;
    return std::stod(read_file(path("length")).value());
  };
  const std::string codec = std::string(kCodec) + " -bf 0 -vsync passthrough -video_track_timescale 24000";
  clip("two.mp4", codec + " -vf \"setpts='N*120/24/TB'\"", 2);
  clip("one.mp4", codec, 1);
  clip("four.mp4", codec, 4);
  for (const auto& [name, seconds] :
       {std::pair{"two", 5 + 1 / 24.0}, std::pair{"one", 1 / 24.0}, std::pair{"four", 4 / 24.0}}) {
    ASSERT_NEAR(length(fmt::format("{}.mp4", name)), seconds, 2e-3) << name;
    for (const char* extension : {"mp4", "mkv"}) {
      ASSERT_EQ(shell(fmt::format("AFTERGLOW run look.lua {0}.mp4 -o {0}.out.{1} --codec h264", name, extension)), 0)
          << said_;
      EXPECT_NEAR(length(fmt::format("{}.out.{}", name, extension)), seconds, 2e-3) << name << extension;
    }
  }
  clip("slow.gif", "-vf \"setpts='N*10/24/TB'\" -final_delay 200", 3);
  ASSERT_EQ(shell("AFTERGLOW run look.lua slow.gif -o slow.mkv --codec ffv1"), 0) << said_;
  EXPECT_NEAR(length("slow.mkv"), 20 / 24.0 + 2, 0.03);
  for (const char* name : {"slow.out.gif", "slow.out.apng"}) {
    ASSERT_EQ(shell(fmt::format("AFTERGLOW run look.lua slow.gif -o {0} && ffprobe -v error -show_entries "
                                "packet=duration_time -of csv=p=0 {0} | tail -1 >length",
                                name)),
              0)
        << said_;
    EXPECT_NEAR(std::stod(read_file(path("length")).value()), 2, 0.03) << name;
  }
}

TEST_F(RunVideos, ATruncatedClipEndsWithExitCode4AndWhatIsWhole) {
  const std::string file = clip("whole.mp4", std::string(kCodec) + " -movflags +faststart");
  const std::string bytes = read_file(file).value();
  std::ofstream(path("cut.mp4"), std::ios::binary) << bytes.substr(0, bytes.size() * 6 / 10);
  EXPECT_EQ(shell("AFTERGLOW run look.lua cut.mp4 -o cut.####.png"), 4);
  EXPECT_THAT(said_, HasSubstr("is truncated: frames "));
  EXPECT_THAT(said_, HasSubstr("of 48 frames failed"));
  EXPECT_EQ(number_in("cut.0012.png"), 12);
  EXPECT_FALSE(std::filesystem::exists(path("cut.0048.png")));
}

/// The last frame that came stays to the end, and the sound goes on.
TEST_F(RunVideos, WhatFailsAtTheEndIsHeld) {
  const std::string file = clip("whole.mp4", std::string(kCodec) + " -movflags +faststart");
  const std::string bytes = read_file(file).value();
  std::ofstream(path("cut.mp4"), std::ios::binary) << bytes.substr(0, bytes.size() * 6 / 10);
  EXPECT_EQ(shell("AFTERGLOW run look.lua cut.mp4 -o out.mkv --codec ffv1"), 4);
  EXPECT_EQ(probed("format=duration", "out.mkv"), "2.000000");
}

std::string only_digits(std::string text) {
  std::erase_if(text, [](char c) { return (c < '0' || c > '9') && c != '.'; });
  return text;
}

/// Each container that is read becomes a video, with the sound that it has.
TEST_F(RunVideos, EveryContainerBecomesAVideo) {
  clip("a.mp4", std::string(kCodec) + " -an", 24);
  ffmpeg(
      fmt::format("-i \"{}\" -f lavfi -i sine=d=1 -c:v copy -c:a aac -shortest \"{}\"", path("a.mp4"), path("s.mp4")));
  for (const auto& [name, codec] :
       std::vector<std::pair<std::string, std::string>>{{"a.mov", "-c copy"},
                                                        {"a.mkv", "-c copy"},
                                                        {"a.nut", "-c copy"},
                                                        {"a.ts", "-c copy"},
                                                        {"a.flv", "-c copy"},
                                                        {"a.avi", "-c:v mpeg4 -c:a mp3"},
                                                        {"a.webm", "-c:v libvpx -b:v 1M -c:a libvorbis"},
                                                        {"a.mxf", "-c:v mpeg2video -r 25 -c:a pcm_s16le -ar 48000"},
                                                        {"a.mpg", "-c:v mpeg2video -r 25 -c:a mp2"},
                                                        {"a.asf", "-c:v mpeg4 -c:a aac"},
                                                        {"a.ogv", "-c:v libtheora -c:a libvorbis"},
                                                        {"a.ivf", "-an -c:v libvpx -b:v 1M"},
                                                        {"a.m1v", "-an -c:v mpeg1video -r 25"},
                                                        {"a.y4m", "-an"},
                                                        {"a.gif", "-an"},
                                                        {"a.apng", "-an"},
                                                        {"a.webp", "-an -c:v libwebp_anim"}}) {
    ffmpeg(fmt::format("-i \"{}\" {} \"{}\"", path("s.mp4"), codec, path(name)));
    EXPECT_EQ(shell("AFTERGLOW run look.lua " + name + " -o " + name + ".mkv --codec ffv1"), 0) << name << said_;
    const bool sounds = codec.find("-an") == std::string::npos;
    EXPECT_EQ(probed("stream=codec_type", name + ".mkv"), sounds ? "video\naudio" : "video") << name;
  }
}

/// A stream's own clock, which runs from anywhere, is not that of another file's sound.
TEST_F(RunVideos, SoundOfAnotherFileBeginsWithThePictures) {
  clip("a.mp4", kCodec, 48);
  ffmpeg(fmt::format("-i \"{}\" -c copy -output_ts_offset 20 \"{}\"", path("a.mp4"), path("late.ts")));
  ffmpeg(fmt::format("-f lavfi -i sine=d=2 -c:a pcm_s16le \"{}\"", path("two.wav")));
  ASSERT_EQ(shell("AFTERGLOW run look.lua late.ts -o whole.mov --codec prores --audio two.wav"), 0) << said_;
  EXPECT_NEAR(std::stod(only_digits(probed("stream=duration", "whole.mov", "a:0"))), 2, 0.03);
  ASSERT_EQ(shell("AFTERGLOW run look.lua late.ts -o part.mov --codec prores --audio two.wav --frames 25-48"), 0)
      << said_;
  EXPECT_NEAR(std::stod(only_digits(probed("stream=duration", "part.mov", "a:0"))), 1, 0.03);
}

/// Milliseconds of Matroska are no rate that changes, and stills of a video say its rate.
TEST_F(RunVideos, RoundedTimesOfAnEvenVideoAreEvenAgain) {
  ffmpeg(fmt::format("-f lavfi -i testsrc=s=64x36:r=30000/1001:d=1.5 -c:v ffv1 \"{}\"", path("a.mkv")));
  ASSERT_EQ(shell("AFTERGLOW run look.lua a.mkv -o a.mov --codec prores"), 0) << said_;
  EXPECT_EQ(probed("stream=avg_frame_rate,time_base", "a.mov"), "30000/1001,1/30000");
  ffmpeg(fmt::format("-itsoffset 0.51 -i \"{}\" -f lavfi -i sine=d=2 -c:v copy -c:a pcm_s16le \"{}\"", path("a.mkv"),
                     path("late.mkv")));
  ASSERT_EQ(shell("AFTERGLOW run look.lua late.mkv -o late.mov --codec prores"), 0) << said_;
  EXPECT_EQ(probed("stream=avg_frame_rate", "late.mov", "v:0"), "30000/1001");
  EXPECT_NEAR(std::stod(only_digits(probed("stream=start_time", "late.mov", "v:0"))), 0.51,
              0.002);  // behind the sound's
  ASSERT_EQ(shell("AFTERGLOW run look.lua a.mkv -o part.mov --codec prores --frames 11-20"), 0) << said_;
  EXPECT_EQ(probed("stream=avg_frame_rate,duration_ts", "part.mov"), "30000/1001,10010");
  ffmpeg(fmt::format("-i \"{}\" -c:v mjpeg \"{}\"", path("a.mkv"), path("a.avi")));
  ASSERT_EQ(shell("AFTERGLOW run look.lua a.avi -o avi_####.png --frames 11-20"), 0) << said_;
  ASSERT_EQ(shell("AFTERGLOW run look.lua avi_####.png -o avi.mov --codec prores"), 0) << said_;
  EXPECT_EQ(probed("stream=avg_frame_rate", "avi.mov"), "30000/1001");
  for (const std::string format : {"exr", "png"}) {
    ASSERT_EQ(shell("AFTERGLOW run look.lua a.mkv -o still_####." + format + " --frames 11-20"), 0) << said_;
    ASSERT_EQ(shell("AFTERGLOW run look.lua still_####." + format + " -o " + format + ".mov --codec prores"), 0)
        << said_;
    EXPECT_EQ(probed("stream=avg_frame_rate", format + ".mov"), "30000/1001");
  }
  ffmpeg(fmt::format("-i \"{}\" -vf \"select=not(eq(n\\,7))\" -fps_mode passthrough -c:v ffv1 \"{}\"", path("a.mkv"),
                     path("hole.mkv")));
  ASSERT_EQ(shell("AFTERGLOW run look.lua hole.mkv -o hole.mov --codec prores"), 0) << said_;
  EXPECT_NE(probed("stream=avg_frame_rate", "hole.mov"), "30000/1001");
}

/// YUV has codes that are no colour of RGB; `--gamut keep` brings them all back, also below black and above white.
TEST_F(RunVideos, CodesBeyondBlackAndWhiteCanStay) {
  for (const std::string pixels : {"yuv444p", "yuv444p10le"}) {
    std::string raw(static_cast<std::size_t>(64) * 64 * 3 * (pixels == "yuv444p" ? 1 : 2), '\0');
    std::mt19937 random(4);
    for (std::size_t i = 0; i < raw.size(); ++i)
      raw[i] = static_cast<char>(random() % (pixels == "yuv444p" ? 256 : i % 2 == 0 ? 256 : 4));
    std::ofstream(path("in.raw"), std::ios::binary) << raw;
    ffmpeg(
        fmt::format("-f rawvideo -pix_fmt {} -s 64x64 -i \"{}\" -color_range tv -colorspace bt709 -color_trc bt709 "
                    "-color_primaries bt709 -c:v ffv1 \"{}\"",
                    pixels, path("in.raw"), path("in.mkv")));
    const auto written = [&](const std::string& options) {
      EXPECT_EQ(shell("AFTERGLOW run look.lua in.mkv -o out.mkv --codec ffv1 --pix-fmt " + pixels + options), 0)
          << said_;
      ffmpeg(fmt::format("-i \"{}\" -f rawvideo -pix_fmt {} \"{}\"", path("out.mkv"), pixels, path("out.raw")));
      return read_file(path("out.raw")).value();
    };
    EXPECT_TRUE(written(" --dither none --gamut keep") == raw) << pixels;
    EXPECT_FALSE(written(" --dither none") == raw) << pixels;
  }
}

/// Sound that was made for a sequence begins with its first frame, not with the first that is taken.
TEST_F(RunVideos, APartOfASequenceHasTheSoundOfThatPart) {
  clip("a.mp4", kCodec, 48);
  ffmpeg(fmt::format("-i \"{}\" -start_number 1001 \"{}\"", path("a.mp4"), path("shot.%04d.png")));
  ffmpeg(fmt::format("-f lavfi -i \"aevalsrc=if(lt(t\\,1)\\,0\\,0.5):s=48000:d=2.5\" -c:a pcm_s16le \"{}\"",
                     path("late.wav")));
  const auto sound_of = [&](const std::string& frames) {
    EXPECT_EQ(
        shell("AFTERGLOW run look.lua shot.####.png -o part.mov --codec prores --fps 24 --audio late.wav" + frames), 0)
        << said_;
    ffmpeg(fmt::format("-i \"{}\" -ac 1 -f s16le \"{}\"", path("part.mov"), path("part.raw")));
    const std::string bytes = read_file(path("part.raw")).value();
    std::vector<std::int16_t> samples(bytes.size() / 2);
    std::memcpy(samples.data(), bytes.data(), samples.size() * 2);
    const auto loud = std::ranges::find_if(samples, [](std::int16_t v) { return v > 8000; });
    // Seconds before it is loud, and all.
    return std::pair(static_cast<double>(loud - samples.begin()) / 48000, static_cast<double>(samples.size()) / 48000);
  };
  const auto expect = [&](const std::string& frames, double quiet, double all) {
    const auto [before, length] = sound_of(frames);
    EXPECT_NEAR(before, quiet, 0.05) << frames;
    EXPECT_NEAR(length, all, 0.05) << frames;
  };
  expect("", 1, 2.5);
  expect(" --frames 1013-1036", 0.5, 1);
  expect(" --frames 1030-1040", 0, 11.0 / 24);
  expect(" --frames 1025-1048", 0, 1.5);       // to the end of both
  expect(" --frames 1013-1048x2", 0.5, 0.75);  // as long as the pictures
}

/// Chapters and subtitles end with the part; a subtitle that shows where it begins shows from there on.
TEST_F(RunVideos, APartKeepsWhatBelongsToIt) {
  std::ofstream(path("texts.srt")) << "1\n00:00:00,500 --> 00:00:01,500\nfirst\n\n2\n00:00:01,600 --> 00:00:01,900\n"
                                      "second\n\n";
  std::ofstream(path("chapters"))
      << ";FFMETADATA1\n[CHAPTER]\nTIMEBASE=1/1000\nSTART=0\nEND=1250\ntitle=one\n[CHAPTER]\n"
         "TIMEBASE=1/1000\nSTART=1250\nEND=2000\ntitle=two\n";
  clip("a.mp4", kCodec, 48);
  ffmpeg(fmt::format("-i \"{}\" -i \"{}\" -i \"{}\" -map 0 -map 1 -map_metadata 2 -c copy -c:s mov_text \"{}\"",
                     path("a.mp4"), path("texts.srt"), path("chapters"), path("told.mp4")));
  ASSERT_EQ(shell("AFTERGLOW run look.lua told.mp4 -o first.mkv --frames 1-24 && "
                  "AFTERGLOW run look.lua told.mp4 -o last.mkv --frames 25-48"),
            0)
      << said_;
  EXPECT_EQ(probed("chapter=start_time,end_time", "first.mkv"), "0.000000,1.000000");
  EXPECT_EQ(probed("chapter=start_time,end_time", "last.mkv"), "0.000000,0.250000\n0.250000,1.000000");
  EXPECT_EQ(probed("packet=pts_time,duration_time", "first.mkv", "s:0"), "0.500000,0.500000");
  EXPECT_EQ(probed("packet=pts_time,duration_time", "last.mkv", "s:0"), "0.000000,0.500000\n0.600000,0.300000");
}

TEST_F(RunVideos, WhatIsLeftOutOfAVideoIsTold) {
  clip("a.mp4", kCodec, 24);
  ffmpeg(fmt::format("-i \"{0}\" -i \"{0}\" -map 0 -map 1 -c:v:0 copy -c:v:1 mjpeg \"{1}\"", path("a.mp4"),
                     path("two.mkv")));
  EXPECT_EQ(shell("AFTERGLOW run look.lua two.mkv -o one.mkv"), 0);
  EXPECT_THAT(said_, HasSubstr("of the pictures of two.mkv one stream is worked on; video 2 (mjpeg) is left out"));
  EXPECT_EQ(shell("AFTERGLOW run look.lua a.mp4 -o one.mkv --fps 24"), 0);
  EXPECT_EQ(said_, "");
  EXPECT_EQ(shell("AFTERGLOW run look.lua a.mp4 -o one.mkv --fps 12"), 0);
  EXPECT_THAT(said_, HasSubstr("a.mp4: frames of a video keep their own times (24 a second)"));
}

TEST_F(RunVideos, FramesComeThroughPipes) {
  const std::string file = clip("clip.mkv", "-c:v ffv1 -level 3 -pix_fmt gbrp", 7);
  ASSERT_EQ(shell("AFTERGLOW run look.lua clip.mkv -o file.####.png"), 0) << said_;
  const struct {
    const char* name;
    const char* output;  ///< of ffmpeg
    const char* more;
  } kPipes[] = {{"y4m", "-pix_fmt yuv444p -f yuv4mpegpipe", ""},
                {"raw", "-pix_fmt rgb48le -f rawvideo", "--raw 192x96:rgb48le:24"},
                {"nut", "-c:v rawvideo -pix_fmt rgb24 -f nut", ""},
                {"mkv", "-c:v libx264 -crf 5 -f matroska", ""},
                {"ts", "-c:v libx264 -crf 5 -pix_fmt yuv420p -f mpegts", ""},
                {"ppm", "-f image2pipe -c:v ppm", ""},
                {"pam", "-f image2pipe -c:v pam -pix_fmt rgba", ""}};
  for (const auto& pipe : kPipes) {
    EXPECT_EQ(shell(fmt::format(
                  "ffmpeg -nostdin -loglevel error -i clip.mkv {} - | AFTERGLOW run look.lua - {} -o {}.####.png",
                  pipe.output, pipe.more, pipe.name)),
              0)
        << said_;
    for (int frame = 1; frame <= 7; ++frame)
      EXPECT_EQ(number_in(fmt::format("{}.{:04}.png", pipe.name, frame)), frame) << pipe.name;
    EXPECT_FALSE(std::filesystem::exists(path(fmt::format("{}.0008.png", pipe.name))));
  }
  // Without loss they are the pixels of the file.
  const auto pixels_of = [&](const std::string& name) {
    ffmpeg(fmt::format("-i \"{}\" -f rawvideo \"{}\"", path(name + ".0004.png"), path("pixels")));
    return read_file(path("pixels")).value();
  };
  for (const char* name : {"nut", "ppm"}) EXPECT_TRUE(pixels_of(name) == pixels_of("file")) << name;
}

/// PFM holds light; one picture may come too, of any format.
TEST_F(RunVideos, SinglePicturesComeThroughPipes) {
  clip("clip.mkv", "-c:v ffv1 -level 3 -pix_fmt gbrp", 2);
  ASSERT_EQ(shell("AFTERGLOW run look.lua clip.mkv -o a.exr --frames 2 --type float && "
                  "AFTERGLOW run look.lua a.exr -o b.exr --type float && AFTERGLOW run look.lua - -o c.exr --type "
                  "float <a.exr"),
            0)
      << said_;
  EXPECT_EQ(number_in("c.exr"), 2);
  Diagnostics quiet;
  EXPECT_EQ(read_picture(path("b.exr"), {}, quiet).value().color.pixels,
            read_picture(path("c.exr"), {}, quiet).value().color.pixels);
  ASSERT_EQ(shell("AFTERGLOW run look.lua a.exr -o a.png && AFTERGLOW run look.lua - -o d.png <a.png"), 0) << said_;
  EXPECT_EQ(number_in("d.png"), 2);
  // A video that has to be sought in is one too.
  clip("clip.mp4", kCodec, 5);
  ASSERT_EQ(shell("cat clip.mp4 | AFTERGLOW run look.lua - -o m.png --frames 4"), 0) << said_;
  EXPECT_EQ(number_in("m.png"), 4);
}

TEST_F(RunVideos, WhatComesOnStandardInputIsCalledThat) {
  const std::string file = clip("whole.mp4", std::string(kCodec) + " -movflags +faststart", 24);
  const std::string bytes = read_file(file).value();
  std::ofstream(path("cut.mp4"), std::ios::binary) << bytes.substr(0, bytes.size() * 8 / 10);
  EXPECT_EQ(shell("cat cut.mp4 | AFTERGLOW run look.lua - -o cut.####.pfm --report report"), 4);
  EXPECT_THAT(said_, HasSubstr("-: is truncated: "));
  EXPECT_THAT(said_, HasSubstr("-: error: frame 24 is missing"));
  EXPECT_THAT(said_ + read_file(path("report")).value(), testing::Not(HasSubstr("/proc/self")));
  EXPECT_EQ(shell("head -c 300 whole.mp4 | AFTERGLOW run look.lua - -o cut.####.pfm"), 4);
  EXPECT_THAT(said_, HasSubstr("-: error: "));
  EXPECT_THAT(said_, testing::Not(HasSubstr("/proc/self")));
}

TEST_F(RunVideos, GifHoldsHundredthsOfASecond) {
  clip("clip.mkv", "-c:v ffv1 -level 3 -pix_fmt gbrp", 5);
  ASSERT_EQ(shell("AFTERGLOW run look.lua clip.mkv -o f.####.pfm"), 0) << said_;
  ASSERT_EQ(shell("AFTERGLOW run look.lua f.####.pfm -o a.gif --fps 50"), 0) << said_;
  EXPECT_EQ(said_, "");
  ASSERT_EQ(shell("AFTERGLOW run look.lua f.####.pfm -o b.gif --fps 60"), 0) << said_;
  EXPECT_THAT(said_,
              HasSubstr("warning: b.gif: GIF holds hundredths of a second, and players show delays below 2 as 10"));
  EXPECT_EQ(shell("AFTERGLOW run look.lua f.####.pfm -o c.gif --fps 120"), 2);
  EXPECT_THAT(said_, HasSubstr("c.gif: error: GIF tells the times of frames in hundredths of a second"));
  EXPECT_THAT(said_, HasSubstr("allowed: up to 100 frames a second"));
  ffmpeg(fmt::format("-r 60 -i '{}' -c:v ffv1 '{}'", path("f.%04d.pfm"), path("sixty.mkv")));
  ASSERT_EQ(shell("AFTERGLOW run look.lua sixty.mkv -o d.gif"), 0) << said_;
  EXPECT_THAT(said_, HasSubstr("players show delays below 2 as 10"));
  ASSERT_EQ(shell("AFTERGLOW run look.lua clip.mkv -o e.gif"), 0) << said_;
  EXPECT_EQ(said_, "");
}

/// What a folder holds beside the sequence is told.
TEST_F(RunVideos, FilesThatAreLeftOutAreTold) {
  clip("clip.mkv", "-c:v ffv1 -level 3 -pix_fmt gbrp", 6);
  ASSERT_EQ(shell("AFTERGLOW run look.lua clip.mkv -o f.####.pfm && mkdir in && mv f.0001.pfm in/f.-0003.pfm && mv "
                  "f.0002.pfm in/f.-0002.pfm && mv f.0003.pfm in/f.-0001.pfm && mv f.0004.pfm in/f.0000.pfm && mv "
                  "f.0005.pfm in/f.0001.pfm && mv f.0006.pfm in/f.0002.pfm"),
            0)
      << said_;
  ASSERT_EQ(shell("AFTERGLOW run look.lua in/ -o out/ --format png"), 0) << said_;
  EXPECT_EQ(said_, "");
  for (const char* name : {"out/f.-0003.png", "out/f.-0001.png", "out/f.0002.png"})
    EXPECT_TRUE(std::filesystem::exists(path(name))) << name;
  ASSERT_EQ(shell("AFTERGLOW run look.lua 'in/f.####.pfm' -o v.mkv --codec ffv1"), 0) << said_;
  const auto movie = open(path("v.mkv"));
  ASSERT_TRUE(movie);
  ASSERT_EQ(movie->frames(), 6);
  for (int frame = 0; frame < 6; ++frame) EXPECT_EQ(number_of(read(movie, frame).value()), frame + 1);
  ASSERT_EQ(
      shell("cp in/f.0001.pfm in/f.20261122001.pfm && cp in/f.0001.pfm in/f.00005.pfm && AFTERGLOW run look.lua in/ "
            "-o out/ --format png"),
      0)
      << said_;
  EXPECT_THAT(said_, HasSubstr("warning: in/f.####.pfm: f.00005.pfm and 1 more are left out: numbers have 4 digits, "
                               "or more without zeros in front here, and go to 2147483647"));
}

/// A frame of another size is one that fails: its place stays empty.
TEST_F(RunVideos, AFrameOfAnotherSizeLeavesItsPlaceEmpty) {
  clip("clip.mkv", "-c:v ffv1 -level 3 -pix_fmt gbrp", 9);
  ASSERT_EQ(shell("AFTERGLOW run look.lua clip.mkv -o f.####.pfm && AFTERGLOW run look.lua f.0005.pfm -o s.pfm "
                  "--size 96x48 && mv s.pfm f.0005.pfm"),
            0)
      << said_;
  EXPECT_EQ(shell("AFTERGLOW run look.lua f.####.pfm -o w.mkv --codec ffv1"), 4);
  EXPECT_THAT(said_,
              HasSubstr("f.0005.pfm: error: frame 5 has 96x48 pixels, the first had 192x96; a video has one size"));
  EXPECT_THAT(said_, HasSubstr("1 of 9 frames failed"));
  const auto movie = open(path("w.mkv"));
  ASSERT_TRUE(movie);
  ASSERT_EQ(movie->frames(), 8);
  EXPECT_EQ(number_of(read(movie, 3).value()), 4);
  EXPECT_EQ(number_of(read(movie, 4).value()), 6);
  EXPECT_NEAR(movie->time(4), 5 / 24.0, 1e-3);
  EXPECT_EQ(shell("AFTERGLOW run look.lua f.####.pfm -o - | ffmpeg -nostdin -v error -i - -f framecrc - | grep -c ^0, "
                  ">count"),
            4)
      << said_;
  EXPECT_EQ(read_file(path("count")).value(), "9\n");
  EXPECT_EQ(shell("AFTERGLOW run look.lua f.####.pfm -o x.mkv --codec ffv1 --fail-fast"), 4);
  EXPECT_FALSE(std::filesystem::exists(path("x.mkv")));
}

/// In containers too: in a frame, or in the sound beside it.
TEST_F(RunVideos, AStreamThatIsCutOffEndsWithExitCode4) {
  const std::string sound = "-f lavfi -i sine=d=1 -c:a pcm_s16le ";
  for (const auto& [name, arguments] :
       {std::pair{"a.y4m", std::string("-an -pix_fmt yuv444p -f yuv4mpegpipe")},
        std::pair{"a.mkv", sound + "-c:v ffv1 -f matroska"},
        std::pair{"b.mkv", std::string("-an -c:v ffv1 -f matroska")}, std::pair{"a.nut", sound + "-c:v ffv1 -f nut"},
        std::pair{"a.ts", sound + "-c:v mpeg2video -r 25 -c:a mp2 -f mpegts"}}) {
    const std::string file = clip(name, arguments, 24);
    EXPECT_EQ(shell(fmt::format("cat {0} | AFTERGLOW run look.lua - -o whole.{0}.####.pfm", name)), 0) << said_;
    EXPECT_TRUE(std::filesystem::exists(path(fmt::format("whole.{}.0024.pfm", name)))) << name;
    for (const std::size_t percent : {50, 71}) {
      const std::size_t size = read_file(file).value().size() * percent / 100 / 188 * 188 + 94;
      const std::string out = fmt::format("cut.{}.{}", name, percent);
      EXPECT_EQ(shell(fmt::format("head -c {} {} | AFTERGLOW run look.lua - -o {}.####.pfm", size, name, out)), 4)
          << name << " " << percent;
      EXPECT_THAT(said_, testing::ContainsRegex("-: error: frame [0-9]+ is (cut off|damaged)")) << name;
      EXPECT_TRUE(std::filesystem::exists(path(out + ".0008.pfm"))) << name;
      EXPECT_FALSE(std::filesystem::exists(path(out + ".0021.pfm"))) << name;
    }
  }
}

TEST_F(RunVideos, APipeThatEndsWithinAFrameEndsWithExitCode4) {
  const std::string raw = numbered_frames(3);
  EXPECT_EQ(shell(fmt::format("head -c 130000 '{}' | AFTERGLOW run look.lua - --raw 192x96:rgb24 -o r.####.png", raw)),
            4);
  EXPECT_THAT(said_, HasSubstr("-: error: frame 3 is cut off"));
  EXPECT_EQ(number_in("r.0002.png"), 2);
  EXPECT_FALSE(std::filesystem::exists(path("r.0003.png")));
  EXPECT_EQ(shell("AFTERGLOW run look.lua - -o r.png </dev/null"), 4);
  EXPECT_THAT(said_, HasSubstr("-: error: nothing comes on standard input"));
  EXPECT_EQ(shell("echo nonsense | AFTERGLOW run look.lua - -o r.png"), 4);
  EXPECT_EQ(shell("AFTERGLOW run look.lua - --raw 192:rgb24 -o r.png </dev/null"), 2);
  EXPECT_THAT(said_, HasSubstr("--raw: error: '192:rgb24' is no format of raw frames; allowed: WIDTHxHEIGHT:PIXELS"));
  EXPECT_EQ(shell("AFTERGLOW run look.lua clip.exr --raw 4x4:rgb24 -o r.png"), 2);
  EXPECT_THAT(said_, HasSubstr("--raw is for frames on standard input: give - as the input"));
  EXPECT_EQ(shell(fmt::format("AFTERGLOW run look.lua - --raw 192x96:rgb24 -o one.png <'{}'", raw)), 2);
  EXPECT_THAT(said_, HasSubstr("more than one frame comes on standard input"));
}

}  // namespace
}  // namespace afterglow
