// SPDX-License-Identifier: MIT
// Videos that are written, as the programs ffmpeg and ffprobe see them.
#include <sys/mount.h>

#include <algorithm>
#include <csignal>
#include <fstream>

#include "video_out_test.h"

namespace afterglow::test {
namespace {

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

/// VP9 has no 10 bits beside alpha.
TEST_F(VideoOut, StepsThatAlphaBringsAreTold) {
  make_exr("alpha.exr");
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack {}\n");
  const auto told = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", "look.lua", "alpha.exr", "-o", "alpha.webm", "--output-space", "pq"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(told({}), HasSubstr("alpha.webm: vp9 with alpha has 8 bits, which show steps in this --output-space"));
  EXPECT_EQ(stream_of("alpha.webm").at("pix_fmt"), "yuv420p");  // as ffmpeg's own decoder sees it
  EXPECT_THAT(told({"--pix-fmt", "yuv420p10le"}), testing::Not(HasSubstr("show steps")));
}

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

TEST_F(VideoOut, CodesOfAViewAreNotSaidToBeSrgb) {
  make_frames(1);
  write("view.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.ocio_display { config = \"ocio/aces.ocio\" } }\n");
  ASSERT_EQ(run({"run", "view.lua", "in/1001.ppm", "-o", "v.mkv", "--codec", "ffv1"}).exit_code, kDone);
  const auto stream = stream_of("v.mkv");
  EXPECT_EQ(stream.value("color_transfer", "unknown"), "unknown");
  EXPECT_EQ(stream.value("color_primaries", "unknown"), "unknown");
  const Outcome made = run({"run", "view.lua", "in/1001.ppm", "-o", "v.webm", "-v"});
  EXPECT_THAT(made.err, HasSubstr("v.webm: the codes of the view are stored with 8 bits"));
}

TEST_F(VideoOut, PicturesThatMoveTellWhatTheyCannotSay) {
  make_frames(1);
  const auto told = [&](const char* space) {
    return run({"run", "look.lua", "in/1001.ppm", "-o", "a.apng", "--output-space", space}).err;
  };
  EXPECT_THAT(told("pq"), HasSubstr("do not say that they hold 'pq': players take them for sRGB, and 8 bits show"));
  EXPECT_THAT(told("display_p3"), HasSubstr("do not say that they hold 'display_p3': players take them for sRGB\n"));
  EXPECT_THAT(told("srgb"), IsEmpty());
}

/// In the frame's own header, which libavcodec leaves at BT.709, for those who ask it before the container.
TEST_F(VideoOut, DnxhrSaysItsMatrixInEachFrame) {
  make_frames(2, 256, 128);
  for (const auto& [space, layout, matrix] : {std::tuple("pq", "yuv422p10", "bt2020nc"),
                                              {"hlg", "yuv444p10", "bt2020nc"},
                                              {"rec709", "yuv422p10", "bt709"}}) {
    const Outcome made = run({"run", "look.lua", "in/####.ppm", "-o", "d.mov", "--codec", "dnxhr", "--pix-fmt", layout,
                              "--output-space", space});
    ASSERT_EQ(made.exit_code, kDone) << made.err;
    for (const auto& frame : probe("d.mov", "-select_streams v -show_frames").at("frames"))
      EXPECT_EQ(frame.at("color_space"), matrix) << space;
  }
}

TEST_F(VideoOut, LinearLightOfWidePrimariesIsTaggedAndRead) {
  make_frames(1);
  const struct {
    const char *space, *primaries, *matrix;
  } cases[] = {{"lin_rec2020", "bt2020", "bt2020nc"}, {"lin_p3d65", "smpte432", "bt709"}, {"linear", "bt709", "bt709"}};
  ASSERT_EQ(run({"run", "look.lua", "in/1001.ppm", "-o", "light.exr", "--type", "float"}).exit_code, kDone);
  for (const auto& [space, primaries, matrix] : cases) {
    ASSERT_EQ(run({"run", "look.lua", "in/1001.ppm", "-o", "light.mkv", "--codec", "ffv1", "--pix-fmt", "yuv444p16",
                   "--output-space", space})
                  .exit_code,
              kDone);
    const auto stream = stream_of("light.mkv");
    EXPECT_EQ(stream.at("color_transfer"), "linear") << space;
    EXPECT_EQ(stream.at("color_primaries"), primaries) << space;
    EXPECT_EQ(stream.at("color_space"), matrix) << space;
    ASSERT_EQ(run({"run", "look.lua", "light.mkv", "-o", "back.####.exr", "--type", "float"}).exit_code, kDone);
    const auto given = pixels_of("light.exr"), came = pixels_of("back.0001.exr");
    ASSERT_EQ(given.size(), came.size());
    for (std::size_t i = 0; i < given.size(); ++i) ASSERT_NEAR(given[i], came[i], 2e-3) << space << " " << i;
  }
}

TEST_F(VideoOut, StaticMetadataOfHdrIsToldWhereItGoes) {
  make_frames(2);
  ASSERT_EQ(
      shell("ffmpeg -v error -y -start_number 1001 -i in/%04d.ppm -vf format=yuv420p10le -c:v libx265 -x265-params "
            "'log-level=error:hdr10=1:master-display=G(13250,34500)B(7500,3000)R(34000,16000)WP(15635,16450)"
            "L(10000000,1):max-cll=1000,400' -color_trc smpte2084 -color_primaries bt2020 -colorspace bt2020nc "
            "hdr10.mp4")
          .exit_code,
      0);
  constexpr const char* kGone =
      "warning: pq.mp4: what the input says of its display and its brightest light (HDR10) is "
      "not kept";
  EXPECT_THAT(run({"run", "look.lua", "hdr10.mp4", "-o", "pq.mp4", "--codec", "h265", "--output-space", "pq"}).err,
              HasSubstr(kGone));
  EXPECT_THAT(run({"run", "look.lua", "hdr10.mp4", "-o", "sdr.mp4"}).err, Not(HasSubstr("HDR10")));
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

TEST_F(VideoOut, PicturesTakeNoOptionsOfVideos) {
  make_frames(2);
  fs::create_directory(path("out"));
  const auto before = files();
  const auto refused = [&](std::vector<std::string> output, const std::vector<std::string>& option) {
    std::vector<std::string> words{"run", "look.lua", "in/####.ppm", "-o"};
    words.insert(words.end(), output.begin(), output.end());
    words.insert(words.end(), option.begin(), option.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, kUsage) << option[0];
    EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(": error: " + option[0] + " is for videos; allowed: "));
  };
  const std::vector<std::string> pixels{"--pix-fmt", "rgb24"}, partial{"--keep-partial"};
  for (const std::vector<std::string>& option :
       {std::vector<std::string>{"--codec", "h264"}, {"--crf", "3"}, {"--bitrate", "8M"}, {"--audio", "in/1001.ppm"}}) {
    refused({"out/"}, option);
    refused({"-"}, option);
  }
  refused({"out/####.png"}, pixels);
  refused({"out/####.png"}, partial);
  refused({"-", "--format", "png"}, pixels);
  EXPECT_EQ(files(), before);
}

TEST_F(VideoOut, FramesOfTwoSizes) {
  make_frames(2);
  write("in/1003.ppm", "P6\n64 36\n255\n" + codes_of(3, 64, 36));
  const Outcome outcome = make_video("a.mp4");
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_EQ(make_video("-").exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("frame 1003 has 64x36 pixels, the first had 96x64; a video has one size"));
  EXPECT_TRUE(fs::exists(path("a.mp4")));
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

TEST_F(VideoOut, ReadOnlyFilesAreNotReplaced) {
  make_frames(2);
  write("a.mkv", "yesterday's");
  fs::permissions(path("a.mkv"), fs::perms::owner_read);
  const auto before = files();
  const Outcome outcome = make_video("a.mkv", {}, {.bound = true});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("a.mkv: error: cannot be written: Permission denied"));
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
  EXPECT_THAT(gone.err, HasSubstr(" of 250 frames\n")) << "there is no --resume for videos";
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
      if (alpha > 30) {
        ASSERT_NEAR(static_cast<std::uint8_t>(raw[i]), 200, c.off + 2) << c.name << " " << i;
      }
    }
  }
  const Outcome on_black = run({"run", "look.lua", "a#.png", "-o", "b.mp4"});
  EXPECT_EQ(on_black.exit_code, kDone);
  EXPECT_THAT(on_black.err, HasSubstr("b.mp4: h264 as yuv420p has no alpha; the pictures are put on black"));
  EXPECT_EQ(std::ranges::count(on_black.err, '\n'), 1) << on_black.err;
  // An alpha of 1 everywhere is nothing that gets lost.
  for (int i = 1; i <= 3; ++i) make_exr("opaque" + std::to_string(i) + ".exr");
  for (const char* output : {"c.mp4", "-"}) {
    const Outcome opaque = run({"run", "look.lua", "opaque#.exr", "-o", output});
    EXPECT_EQ(opaque.exit_code, kDone) << opaque.err;
    EXPECT_THAT(opaque.err, IsEmpty());
  }
}

TEST_F(VideoOut, DnxhrGoesIntoMov) {
  make_frames(3, 256, 120);
  for (const auto& [format, profile] :
       {std::pair{"", "DNXHR HQX"}, std::pair{"yuv422p", "DNXHR HQ"}, std::pair{"yuv444p10", "DNXHR 444"}}) {
    std::vector<std::string> more{"--codec", "dnxhr"};
    if (*format) more.insert(more.end(), {"--pix-fmt", format});
    const Outcome outcome = make_video("a.mov", more);
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_EQ(stream_of("a.mov").at("codec_name"), "dnxhd");
    EXPECT_EQ(stream_of("a.mov").at("profile"), profile);
    EXPECT_EQ(stream_of("a.mov").at("nb_frames"), "3");
  }
  make_frames(1);
  const Outcome small = make_video("b.mov", {"--codec", "dnxhr", "--frames", "1001"});
  EXPECT_EQ(small.exit_code, kUsage);
  EXPECT_THAT(small.err, HasSubstr("b.mov: error: dnxhd does not take 96x64 pixels"));
}

}  // namespace
}  // namespace afterglow::test
