// SPDX-License-Identifier: MIT
// Videos that are written, as the programs ffmpeg and ffprobe see them.
#include <sys/mount.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli_test.h"

namespace afterglow::test {
namespace {

constexpr int kWidth = 96, kHeight = 64, kBits = 8, kBarRows = 16;
constexpr std::size_t kFrameBytes = std::size_t{kWidth} * kHeight * 3;

bool has_ffmpeg() { return std::system("command -v ffmpeg >/dev/null && command -v ffprobe >/dev/null") == 0; }

class VideoOut : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    if (!has_ffmpeg()) GTEST_SKIP() << "the program ffmpeg is not installed";
    write("look.lua",
          "local fx = require \"afterglow\"\nreturn fx.stack { name = \"nothing\", fx.color_adjustments {} }\n");
  }

  /// 8-bit sRGB: bars that say the number, above a smooth picture that moves.
  static std::string codes_of(int number, int width = kWidth, int height = kHeight) {
    std::string codes;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (y < kBarRows) {
          codes.append(3, static_cast<char>(number >> (x * kBits / width) & 1 ? 220 : 30));
          continue;
        }
        for (const double phase : {0.0, 1.0, 2.1})
          codes +=
              static_cast<char>(std::lround(128 + 90 * std::sin((x + number) / 30.0 + phase) * std::cos(y / 25.0)));
      }
    return codes;
  }
  static int number_of(const std::string& codes) {
    int number = 0;
    for (int bit = 0; bit < kBits; ++bit) {
      const int x = bit * kWidth / kBits + kWidth / kBits / 2;
      const auto value =
          static_cast<std::uint8_t>(codes[(std::size_t{kBarRows} / 2 * kWidth + static_cast<std::size_t>(x)) * 3]);
      number |= (value > 128 ? 1 : 0) << bit;
    }
    return number;
  }
  void make_frames(int count, int width = kWidth, int height = kHeight) const {
    for (int frame = 1; frame <= count; ++frame) {
      std::ostringstream head;
      head << "P6\n" << width << " " << height << "\n255\n";
      write("in/" + std::to_string(1000 + frame) + ".ppm", head.str() + codes_of(frame, width, height));
    }
  }
  Outcome make_video(const std::string& name, std::vector<std::string> more = {},
                     const RunOptions& options = {}) const {
    std::vector<std::string> arguments{"run", "look.lua", "in/####.ppm", "-o", name, "--output-space", "srgb"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, options);
  }
  Outcome shell(const std::string& command) const {
    RunOptions options;
    options.program = "/bin/sh";
    options.environment["AFTERGLOW"] = AFTERGLOW_PROGRAM;
    return run({"-c", command}, options);
  }
  /// Frames as 8-bit RGB.
  std::vector<std::string> frames_of(const std::string& name) const {
    const Outcome outcome = shell("ffmpeg -v error -i " + name +
                                  " -vsync passthrough -sws_flags accurate_rnd+full_chroma_int+bicubic -pix_fmt rgb24 "
                                  "-f rawvideo -y decoded.raw");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::string raw = read("decoded.raw");
    EXPECT_EQ(raw.size() % kFrameBytes, 0u);
    std::vector<std::string> frames;
    for (std::size_t at = 0; at < raw.size(); at += kFrameBytes) frames.push_back(raw.substr(at, kFrameBytes));
    return frames;
  }
  nlohmann::json probe(const std::string& name, const std::string& what) const {
    const Outcome outcome = shell("ffprobe -v error -of json " + what + " " + name);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  }
  nlohmann::json stream_of(const std::string& name) const {
    return probe(name, "-select_streams v -show_streams").at("streams").at(0);
  }
  /// Root of the mean of squares, in codes.
  static double difference(const std::string& a, const std::string& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double d = static_cast<std::uint8_t>(a[i]) - static_cast<std::uint8_t>(b[i]);
      sum += d * d;
    }
    return std::sqrt(sum / static_cast<double>(a.size()));
  }
  bool has_leftovers() const {
    for (const auto& name : files())
      if (name.find(".tmp") != std::string::npos) return true;
    return false;
  }
};

struct Kind {
  const char *container, *codec, *option, *format;  ///< FFmpeg's names of codec and pixel format
  const char* ffmpeg_codec;
  double off;  ///< what the codec may be off by, in codes
};
constexpr Kind kKinds[] = {
    {"mp4", "h264", "", "yuv420p", "h264", 4},
    {"mp4", "h264", "yuv444p10", "yuv444p10le", "h264", 2.5},
    {"mp4", "h265", "", "yuv420p", "hevc", 4.5},
    {"mp4", "h265", "yuv422p10", "yuv422p10le", "hevc", 4},
    {"mp4", "av1", "", "yuv420p10le", "av1", 5},
    {"mp4", "vp9", "", "yuv420p", "vp9", 5},
    {"mov", "prores", "", "yuv422p10le", "prores", 2.5},
    {"mov", "prores4444", "", "yuv444p12le", "prores", 1.5},
    {"mov", "h264", "", "yuv420p", "h264", 4},
    {"mov", "h265", "yuv420p10", "yuv420p10le", "hevc", 4.5},
    {"mkv", "h264", "", "yuv420p", "h264", 4},
    {"mkv", "h265", "yuv420p12", "yuv420p12le", "hevc", 4.5},
    {"mkv", "ffv1", "", "bgr0", "ffv1", 0},
    {"mkv", "ffv1", "gbrp16", "gbrp16le", "ffv1", 0.8},  // ffmpeg cuts the lower 8 bits off
    {"mkv", "ffv1", "yuv444p16", "yuv444p16le", "ffv1", 0.8},
    {"mkv", "prores", "", "yuv422p10le", "prores", 2.5},
    {"mkv", "prores4444", "", "yuv444p12le", "prores", 1.5},
    {"mkv", "vp9", "", "yuv420p", "vp9", 5},
    {"mkv", "av1", "yuv420p", "yuv420p", "av1", 5},
    {"webm", "vp9", "yuv444p12", "yuv444p12le", "vp9", 4},
    {"webm", "av1", "", "yuv420p10le", "av1", 5},
    {"apng", "apng", "", "rgb24", "apng", 0},
    {"gif", "gif", "", "bgra", "gif", 9},
};

class EveryCodec : public VideoOut, public ::testing::WithParamInterface<Kind> {};

TEST_P(EveryCodec, HoldsEveryFrameInOrder) {
  const Kind& kind = GetParam();
  constexpr int kFrames = 12;
  make_frames(kFrames);
  const std::string name = std::string("out.") + kind.container;
  std::vector<std::string> more{"--codec", kind.codec, "--fps", "25", "--dither", "none"};
  if (*kind.option) more.insert(more.end(), {"--pix-fmt", kind.option});
  const Outcome outcome = make_video(name, more);
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_FALSE(has_leftovers());

  const auto stream = stream_of(name);
  EXPECT_EQ(stream.at("codec_name"), kind.ffmpeg_codec);
  EXPECT_EQ(stream.at("pix_fmt"), kind.format);
  if (std::string(kind.container) != "gif" && std::string(kind.container) != "apng") {
    const bool rgb = std::string(kind.format)[0] != 'y';
    EXPECT_EQ(stream.at("color_transfer"), "iec61966-2-1");
    EXPECT_EQ(stream.at("color_primaries"), "bt709");
    EXPECT_EQ(stream.at("color_space"), rgb ? "gbr" : "bt709");
    // ProRes has no tag of its own for the range: it is always that of video, and newer FFmpegs say nothing.
    EXPECT_EQ(stream.value("color_range", "tv"), rgb ? "pc" : "tv");
  }
  const auto frames = frames_of(name);
  ASSERT_EQ(frames.size(), std::size_t{kFrames});
  for (int i = 0; i < kFrames; ++i) {
    const std::string& frame = frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(number_of(frame), i + 1);
    EXPECT_LE(difference(frame, codes_of(i + 1)), kind.off) << i;
  }
  const auto packets =
      probe(name, "-select_streams v -show_frames -show_entries frame=pts_time,best_effort_timestamp_time");
  for (std::size_t i = 0; i < kFrames; ++i) {
    const double time = std::stod(packets.at("frames").at(i).at("best_effort_timestamp_time").get<std::string>());
    EXPECT_NEAR(time, static_cast<double>(i) / 25, 0.0011) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(VideoOut, EveryCodec, ::testing::ValuesIn(kKinds), [](const auto& info) {
  const Kind& kind = info.param;
  return std::string(kind.container) + "_" + kind.codec + (*kind.option ? std::string("_") + kind.option : "");
});

TEST_F(VideoOut, UntoldColoursAreBt709) {
  make_frames(2);
  ASSERT_EQ(run({"run", "look.lua", "in/####.ppm", "-o", "out.mp4"}).exit_code, kDone);
  const auto stream = stream_of("out.mp4");
  for (const char* key : {"color_transfer", "color_primaries", "color_space"})
    EXPECT_EQ(stream.at(key), "bt709") << key;
  ASSERT_EQ(
      run({"run", "look.lua", "in/####.ppm", "-o", "hdr.mp4", "--codec", "h265", "--output-space", "pq"}).exit_code,
      kDone);
  const auto hdr = stream_of("hdr.mp4");
  EXPECT_EQ(hdr.at("color_transfer"), "smpte2084");
  EXPECT_EQ(hdr.at("color_primaries"), "bt2020");
  EXPECT_EQ(hdr.at("color_space"), "bt2020nc");
}

TEST_F(VideoOut, OptionsThatDoNotGoTogether) {
  make_frames(2);
  const auto before = files();
  struct Case {
    std::string name;
    std::vector<std::string> more;
    const char* message;
  };
  for (const Case& c : {
           Case{"a.mp4", {"--codec", "prores"}, "mp4 files do not hold prores; allowed: h264, h265, av1, vp9"},
           Case{"a.webm",
                {"--codec", "vp8"},
                "'vp8' is no codec that is written; allowed: vp9, av1; did you mean 'vp9'?"},
           Case{"a.mp4", {"--pix-fmt", "yuv420p12"}, "h264 has no pixel format 'yuv420p12'; allowed: yuv420p, "},
           Case{"a.mov", {"--crf", "3"}, "prores takes no --crf; allowed: h264, h265, vp9, av1"},
           Case{"a.mkv", {"--codec", "ffv1", "--bitrate", "8M"}, "ffv1 takes no --bitrate"},
           Case{"a.mp4", {"--crf", "52"}, "--crf 52 is no quality of h264; allowed: 0 (best) to 51"},
           Case{"a.mp4", {"--bitrate", "8X"}, "'8X' is no bit rate; allowed: 8M, 500k, 2500000"},
           Case{"a.mp4", {"--type", "uint8"}, "--type is for pictures; a video has --pix-fmt"},
           Case{"a.mp4", {"--resume"}, "--resume goes on with files of their own; a video or a stream is made whole"},
           Case{"a.mp4", {"--format", "mov"}, "a file name says its format itself"},
           Case{"a.####.mp4", {}, "a video takes all frames; a.####.mp4 would be one for each"},
           Case{"a.mp4",
                {"--size", "95x63"},
                "95x63 pixels do not go into yuv420p, whose colour has half the width and"},
       }) {
    const Outcome outcome = make_video(c.name, c.more);
    EXPECT_EQ(outcome.exit_code, kUsage) << c.message;
    EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(c.message));
  }
  EXPECT_EQ(files(), before);
  const Outcome nowhere = make_video("nowhere/a.mp4");
  EXPECT_EQ(nowhere.exit_code, kFiles);
  EXPECT_THAT(nowhere.err, HasSubstr("its folder 'nowhere' does not exist"));
}

TEST_F(VideoOut, FramesOfTwoSizes) {
  make_frames(2);
  write("in/1003.ppm", "P6\n64 36\n255\n" + codes_of(3, 64, 36));
  const Outcome outcome = make_video("a.mp4");
  EXPECT_EQ(outcome.exit_code, kUsage);
  EXPECT_THAT(outcome.err, HasSubstr("a frame has 64x36 pixels, the first had 96x64; a video has one size"));
  EXPECT_FALSE(fs::exists(path("a.mp4")));
  EXPECT_FALSE(has_leftovers());
}

TEST_F(VideoOut, AFrameThatFailsLeavesItsPlaceEmpty) {
  make_frames(6);
  write("in/1003.ppm", "P6\n96 64\n255\n");
  const Outcome outcome = make_video("a.mkv", {"--codec", "ffv1"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("1 of 6 frames failed"));
  const auto frames = frames_of("a.mkv");
  ASSERT_EQ(frames.size(), 5u);
  EXPECT_EQ(number_of(frames[2]), 4);
  const auto times = probe("a.mkv", "-show_frames -show_entries frame=pts_time");
  EXPECT_NEAR(std::stod(times.at("frames").at(2).at("pts_time").get<std::string>()), 3 / 24.0, 0.001);
  const Outcome stopped = make_video("b.mkv", {"--codec", "ffv1", "--fail-fast"});
  EXPECT_EQ(stopped.exit_code, kFiles);
  EXPECT_FALSE(fs::exists(path("b.mkv")));
  EXPECT_FALSE(has_leftovers());
}

TEST_F(VideoOut, FullDisk) {
  make_frames(60);
  write("a.mkv", "yesterday's");
  RunOptions options;
  options.largest_file = 100000;
  options.environment["AFTERGLOW_CACHE"] = text("no-cache/x");
  write("no-cache", "");
  const auto before = files();
  const Outcome outcome = make_video("a.mkv", {"--codec", "ffv1"}, options);
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("a.mkv: error: cannot be written: File too large"));
  EXPECT_EQ(files(), before);
  EXPECT_EQ(read("a.mkv"), "yesterday's");
}

class Interrupted : public VideoOut, public ::testing::WithParamInterface<const char*> {
 protected:
  /// Ends the run when some frames have gone into the temporary file.
  RunOptions interrupting() const {
    RunOptions options;
    options.meanwhile = [this](int process) {
      for (const auto& entry : fs::directory_iterator(path(".")))
        if (entry.path().string().find(".tmp") != std::string::npos && fs::file_size(entry.path()) > 300000)
          return kill(process, SIGINT) == 0;
      return false;
    };
    return options;
  }
};

TEST_P(Interrupted, LeavesNothingOrAWholeShorterVideo) {
  const std::string name = std::string("a.") + GetParam();
  constexpr int kFrames = 250;
  make_frames(kFrames);
  const std::vector<std::string> codec = {"--codec", name == "a.mkv" ? "ffv1" : "prores", "--dither", "none"};
  const Outcome gone = make_video(name, codec, interrupting());
  ASSERT_EQ(gone.exit_code, kInterrupted) << gone.err;
  EXPECT_FALSE(fs::exists(path(name)));
  EXPECT_FALSE(has_leftovers());
  auto keep = codec;
  keep.emplace_back("--keep-partial");
  const Outcome kept = make_video(name, keep, interrupting());
  ASSERT_EQ(kept.exit_code, kInterrupted) << kept.err;
  EXPECT_FALSE(has_leftovers());
  const auto frames = frames_of(name);
  ASSERT_GT(frames.size(), 1u);
  EXPECT_LT(frames.size(), std::size_t{kFrames});
  for (std::size_t i = 0; i < frames.size(); ++i) ASSERT_EQ(number_of(frames[i]), static_cast<int>(i + 1) & 255);
}

INSTANTIATE_TEST_SUITE_P(VideoOut, Interrupted, ::testing::Values("mkv", "mov"));

TEST_F(VideoOut, SoundOfAnotherFileIsCopied) {
  make_frames(24);
  ASSERT_EQ(shell("ffmpeg -v error -f lavfi -i sine=frequency=440:duration=1 -c:a aac sound.m4a").exit_code, 0);
  ASSERT_EQ(make_video("a.mp4", {"--audio", "sound.m4a"}).exit_code, kDone);
  const auto hashes = [&](const std::string& name) {
    std::vector<std::string> all;
    const auto packets = probe(name, "-select_streams a -show_packets -show_data_hash md5");
    for (const auto& packet : packets.at("packets"))
      all.push_back(packet.at("data_hash").get<std::string>() + " " + packet.at("pts_time").get<std::string>());
    return all;
  };
  const auto from = hashes("sound.m4a"), to = hashes("a.mp4");
  ASSERT_GT(from.size(), 40u);
  EXPECT_EQ(from, to);
  const Outcome none = make_video("b.mp4", {"--audio", "in/1001.ppm"});
  EXPECT_EQ(none.exit_code, kFiles);
  EXPECT_THAT(none.err, HasSubstr("in/1001.ppm: error: "));
  EXPECT_FALSE(fs::exists(path("b.mp4")));
}

TEST_F(VideoOut, AlphaWhereTheCodecCan) {
  for (int frame = 1; frame <= 3; ++frame) {
    std::string pixels;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      pixels += static_cast<char>(200);
      pixels += static_cast<char>(60 + 10 * frame);
      pixels += static_cast<char>(20);
      pixels += static_cast<char>(i % kWidth * 255 / (kWidth - 1));
    }
    write("raw", pixels);
    ASSERT_EQ(shell("ffmpeg -v error -f rawvideo -pix_fmt rgba -s 96x64 -i raw -y a" + std::to_string(frame) + ".png")
                  .exit_code,
              0);
  }
  struct Case {
    const char *name, *codec, *format;
    int off;
  };
  for (const Case& c : {Case{"a.mov", "prores4444", "", 2},
                        {"a.mkv", "ffv1", "", 0},
                        {"a.webm", "vp9", "-c:v libvpx-vp9", 6},
                        {"a.apng", "apng", "", 0}}) {
    const Outcome outcome = run(
        {"run", "look.lua", "a#.png", "-o", c.name, "--codec", c.codec, "--output-space", "srgb", "--dither", "none"});
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    ASSERT_EQ(shell(std::string("ffmpeg -v error ") + c.format + " -i " + c.name +
                    " -frames:v 1 -pix_fmt rgba -f rawvideo -y one.raw")
                  .exit_code,
              0);
    const std::string raw = read("one.raw");
    ASSERT_EQ(raw.size(), std::size_t{kWidth} * kHeight * 4);
    for (std::size_t i = 0; i < raw.size(); i += 4) {
      const int alpha = static_cast<int>(i / 4 % kWidth * 255 / (kWidth - 1));
      ASSERT_NEAR(static_cast<std::uint8_t>(raw[i + 3]), alpha, c.off) << c.name << " " << i;
      if (alpha > 30) ASSERT_NEAR(static_cast<std::uint8_t>(raw[i]), 200, c.off + 2) << c.name << " " << i;
    }
  }
  const Outcome opaque = run({"run", "look.lua", "a#.png", "-o", "b.mp4"});
  EXPECT_EQ(opaque.exit_code, kDone);
  EXPECT_THAT(opaque.err, HasSubstr("b.mp4: h264 as yuv420p has no alpha; the pictures are put on black"));
}

/// Times, sound, subtitles and chapters of a video stay with it.
TEST_F(VideoOut, VideoToVideo) {
  make_frames(40);
  write("chapters.txt",
        ";FFMETADATA1\ntitle=A "
        "shot\n[CHAPTER]\nTIMEBASE=1/1000\nSTART=0\nEND=700\ntitle=one\n[CHAPTER]\nTIMEBASE=1/1000\n"
        "START=700\nEND=1600\ntitle=two\n");
  write("text.srt", "1\n00:00:00,200 --> 00:00:00,900\nhello\n");
  // Every third frame is gone: the rate varies.
  ASSERT_EQ(
      shell(
          "ffmpeg -v error -framerate 25 -start_number 1001 -i in/%04d.ppm -f lavfi -i sine=frequency=440:duration=1.6 "
          "-i text.srt -i chapters.txt -map 0 -map 1 -map 2 -map_metadata 3 -map_chapters 3 -vf "
          "\"select='mod(n,3)'\" -vsync vfr -c:v libx264 -bf 2 -g 10 -pix_fmt yuv444p -crf 5 -c:a aac -c:s srt in.mkv")
          .exit_code,
      0);
  const Outcome outcome = run({"run", "look.lua", "in.mkv", "-o", "out.mkv", "--codec", "ffv1"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  const auto texts = [&](const std::string& name, const std::string& what, const char* list, const char* key) {
    std::vector<std::string> all;
    const auto probed = probe(name, what);
    for (const auto& one : probed.at(list)) all.push_back(one.at(key).get<std::string>());
    return all;
  };
  const std::string times = "-select_streams v -show_frames -show_entries frame=pts_time";
  EXPECT_EQ(texts("in.mkv", times, "frames", "pts_time"), texts("out.mkv", times, "frames", "pts_time"));
  for (const char* stream : {"a", "s"}) {
    const std::string what = std::string("-show_packets -show_data_hash md5 -select_streams ") + stream;
    EXPECT_EQ(texts("in.mkv", what, "packets", "data_hash"), texts("out.mkv", what, "packets", "data_hash")) << stream;
    EXPECT_EQ(texts("in.mkv", what, "packets", "pts_time"), texts("out.mkv", what, "packets", "pts_time")) << stream;
  }
  EXPECT_EQ(texts("out.mkv", "-show_chapters", "chapters", "start_time"),
            texts("in.mkv", "-show_chapters", "chapters", "start_time"));
  const auto frames = frames_of("out.mkv"), before = frames_of("in.mkv");
  ASSERT_EQ(frames.size(), before.size());
  for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(number_of(frames[i]), number_of(before[i])) << i;

  const Outcome mp4 = run({"run", "look.lua", "in.mkv", "-o", "out.mp4"});
  EXPECT_EQ(mp4.exit_code, kDone) << mp4.err;
  EXPECT_THAT(mp4.err, HasSubstr("out.mp4: subtitle 3 (subrip) of in.mkv cannot be held by mp4 and is left out"));

  // A part begins at 0, with the sound beside it.
  const Outcome part = run({"run", "look.lua", "in.mkv", "-o", "part.mkv", "--codec", "ffv1", "--frames", "11-20"});
  ASSERT_EQ(part.exit_code, kDone) << part.err;
  const auto some = frames_of("part.mkv");
  ASSERT_EQ(some.size(), 10u);
  EXPECT_EQ(number_of(some[0]), number_of(before[10]));
  const auto all = texts("in.mkv", times, "frames", "pts_time"), ten = texts("part.mkv", times, "frames", "pts_time");
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_NEAR(std::stod(ten[i]), std::stod(all[10 + i]) - std::stod(all[10]), 0.0011) << i;
  const auto sound = texts("part.mkv", "-show_packets -select_streams a", "packets", "pts_time");
  ASSERT_FALSE(sound.empty());
  EXPECT_GE(std::stod(sound.front()), 0);
  EXPECT_LT(std::stod(sound.front()), 0.03);
  EXPECT_LT(std::stod(sound.back()), std::stod(ten.back()) + 0.09);
}

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
