// SPDX-License-Identifier: MIT
// Sound that a container does not take is encoded: clicks at known times are looked for in what comes out.
#include <cstring>
#include <map>
#include <tuple>

#include "video_out_test.h"

namespace afterglow::test {
namespace {

using ::testing::ElementsAre;
using ::testing::Pointwise;

/// In milliseconds.
MATCHER(IsNear, "") { return std::abs(std::get<0>(arg) - std::get<1>(arg)) < 1; }

class VideoSound : public VideoOut {
 protected:
  /// Bursts of two milliseconds around 300, 1300 and 2300 ms; three seconds, in every channel.
  static std::string clicks(int channels = 2, int rate = 48000) {
    std::string all;
    for (int i = 0; i < channels; ++i)
      all += std::string(i > 0 ? "|" : "") + "if(lt(mod(t+0.701\\,1)\\,0.002)\\,0.6*sin(2*PI*1000*t)\\,0)";
    return "-f lavfi -i \"aevalsrc='" + all + "':s=" + std::to_string(rate) + ":d=3\" ";
  }
  void make(const std::string& name, const std::string& inputs, const std::string& codecs) const {
    const Outcome made =
        shell("ffmpeg -v error -y -f lavfi -i testsrc=s=64x48:r=24:d=3 " + inputs + codecs + " " + name);
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  /// When they are heard behind the first picture, in milliseconds.
  std::vector<double> heard(const std::string& name) const {
    constexpr int kRate = 48000;
    const auto first = probe(name, "-select_streams v -show_frames -show_entries frame=pts_time").at("frames").at(0);
    const double begin = std::stod(first.at("pts_time").get<std::string>());
    EXPECT_EQ(shell("ffmpeg -v error -y -copyts -i " + name + " -map 0:a:0 -af aresample=" + std::to_string(kRate) +
                    ":async=1:first_pts=0 -ac 1 -f f32le heard.raw")
                  .exit_code,
              0);
    const std::string raw = read("heard.raw");
    std::vector<float> sound(raw.size() / sizeof(float));
    std::memcpy(sound.data(), raw.data(), sound.size() * sizeof(float));
    const auto power = [&](std::size_t i) { return double{sound[i]} * double{sound[i]}; };
    std::vector<double> times;
    for (std::size_t i = 0; i < sound.size(); ++i) {
      if (std::abs(sound[i]) < 0.1f) continue;
      double sum = 0, moment = 0;
      for (std::size_t k = i < 300 ? 0 : i - 300; k < std::min(i + 300, sound.size()); ++k) {
        sum += power(k);
        moment += power(k) * static_cast<double>(k);
      }
      times.push_back((moment / sum / kRate - begin) * 1000);
      i += kRate / 10;
    }
    return times;
  }
  void expect_heard(const std::string& name, const std::vector<double>& times) const {
    EXPECT_THAT(heard(name), Pointwise(IsNear(), times)) << name;
  }
  nlohmann::json sound_of(const std::string& name) const {
    return probe(name, "-select_streams a -show_streams").at("streams").at(0);
  }
  std::string encoded(const std::string& from, const std::string& to, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"run", "look.lua", from, "-o", to};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return outcome.err;
  }
};

TEST_F(VideoSound, WhatTheContainerDoesNotTakeIsEncodedInItsPlace) {
  struct Case {
    std::string from, inputs, codecs, to, codec;
    int channels, rate;
  };
  for (const auto& [from, inputs, codecs, to, codec, channels, rate] :
       {Case{"in.mov", clicks(), "-c:v prores_ks -c:a pcm_s16le", "out.mp4", "aac", 2, 48000},
        {"in.mov", clicks(1, 44100), "-c:v prores_ks -c:a pcm_s24le", "out.mp4", "aac", 1, 44100},
        {"in.mkv", clicks(6), "-c:v ffv1 -c:a pcm_s16le", "out.mp4", "aac", 6, 48000},
        {"in.mkv", clicks(2, 192000), "-c:v ffv1 -c:a pcm_f32le", "out.mp4", "aac", 2, 48000},
        {"in.mov", clicks(), "-c:v prores_ks -c:a pcm_s16le", "out.webm", "opus", 2, 48000},
        {"in.mp4", clicks(), "-c:v libx264 -c:a aac", "out.webm", "opus", 2, 48000},
        {"in.mp4", clicks(6), "-c:v libx264 -c:a aac", "out.webm", "opus", 6, 48000},
        {"in.mov", clicks(3), "-c:v prores_ks -c:a pcm_s16le", "out.webm", "opus", 3, 48000},
        {"in.mkv", clicks(3), "-c:v ffv1 -c:a pcm_s16le", "out.webm", "opus", 3, 48000},
        {"in.mov", clicks(4), "-c:v prores_ks -c:a pcm_s16le", "out.webm", "opus", 4, 48000},
        {"in.ts", clicks(2, 44100), "-c:v libx264 -bf 2 -c:a aac", "out.webm", "opus", 2, 48000},
        {"in.mkv", clicks(2, 44100), "-c:v ffv1 -c:a flac -sample_fmt s16", "out.mov", "pcm_s16le", 2, 44100},
        {"in.webm", clicks(), "-c:v libvpx -c:a libopus", "out.mov", "pcm_s24le", 2, 48000}}) {
    make(from, inputs, codecs);
    const std::vector<double> source = heard(from);
    ASSERT_EQ(source.size(), 3u);
    const std::string said = encoded(from, to);
    EXPECT_THAT(said, HasSubstr("warning: " + to + ": audio 2 ("));
    EXPECT_THAT(said, HasSubstr(" of " + from + " is encoded as " + codec + ", since "));
    EXPECT_EQ(std::ranges::count(said, '\n'), 1) << said;
    expect_heard(to, source);
    const auto sound = sound_of(to);
    EXPECT_EQ(sound.at("codec_name"), codec);
    EXPECT_EQ(sound.at("channels"), channels);
    EXPECT_EQ(sound.at("sample_rate"), std::to_string(rate));
  }
}

TEST_F(VideoSound, APartHasTheSamplesOfThatPart) {
  make("in.mov", clicks(), "-c:v prores_ks -c:a pcm_s16le");
  make("in.mp4", clicks(), "-c:v libx264 -g 12 -bf 2 -c:a aac");
  for (const auto& [from, to] : {std::pair{"in.mov", "out.mp4"}, {"in.mov", "out.webm"}, {"in.mp4", "out.webm"}}) {
    const std::vector<double> source = heard(from);
    ASSERT_EQ(source.size(), 3u);
    encoded(from, to, {"--frames", "26-48"});  // 1041.7 ms to 2000 ms
    expect_heard(to, {source[1] - 25000 / 24.0});
    EXPECT_NEAR(std::stod(probe(to, "-show_format").at("format").at("duration").get<std::string>()), 23 / 24.0, 0.03);
  }
}

TEST_F(VideoSound, SoundOfAnotherFileIsEncoded) {
  make_frames(60);
  ASSERT_EQ(shell("ffmpeg -v error " + clicks() + "a.wav").exit_code, 0);
  ASSERT_EQ(shell("ffmpeg -v error -i a.wav -c:a libmp3lame a.mp3").exit_code, 0);
  for (const auto& [from, to] : {std::pair{"a.wav", "out.mp4"}, {"a.wav", "out.webm"}, {"a.mp3", "out.webm"}}) {
    const Outcome outcome = make_video(to, {"--audio", from});
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(std::string("of ") + from + " is encoded as "));
    EXPECT_THAT(outcome.err, Not(HasSubstr("--audio copy")));
    expect_heard(to, {300, 1300, 2300});
    const Outcome part = make_video(to, {"--audio", from, "--frames", "1025-1048"});
    ASSERT_EQ(part.exit_code, kDone) << part.err;
    expect_heard(to, {300});
  }
}

TEST_F(VideoSound, APartOfAnotherFileIsHeardToItsEnd) {
  make_frames(48);
  const std::string tone = "ffmpeg -v error -y -f lavfi -i sine=r=48000:d=3 ";
  ASSERT_EQ(shell(tone + "a.wav").exit_code, 0);
  ASSERT_EQ(shell(tone + "-c:a libmp3lame a.mp3").exit_code, 0);
  for (const std::string from : {"a.wav", "a.mp3"}) {
    const Outcome part = make_video("out.webm", {"--audio", from, "--frames", "1013-1036"});
    ASSERT_EQ(part.exit_code, kDone) << part.err;
    ASSERT_EQ(shell("ffmpeg -v error -y -i out.webm -map 0:a -f s16le -ac 1 part.raw").exit_code, 0);
    EXPECT_EQ(read("part.raw").size() / 2, 48000u) << from;
  }
}

/// Sound that begins late, pauses, or has a stamp for each packet that is rounded to milliseconds.
TEST_F(VideoSound, HolesAreSilent) {
  make("late.mkv", "-itsoffset 0.2503 " + clicks(), "-c:v ffv1 -c:a pcm_s16le");
  make("hole.mkv", clicks(), "-filter:a \"aselect='not(between(t,0.5,0.9))'\" -c:v ffv1 -c:a pcm_s16le");
  for (const std::string from : {"late.mkv", "hole.mkv"}) {
    const std::vector<double> source = heard(from);
    ASSERT_GE(source.size(), 3u);
    for (const std::string to : {"out.mp4", "out.webm"}) {
      encoded(from, to);
      expect_heard(to, source);
    }
  }
}

/// Files of floats hold anything, and encoders refuse it.
TEST_F(VideoSound, WhatIsNoSoundIsSilentOrHeld) {
  for (const std::string wrong : {"0/0", "-1/0", "1e30"})
    for (const std::string kind : {"pcm_f32le", "pcm_f64le"}) {
      make("in.mkv", "-f lavfi -i \"aevalsrc='if(eq(n\\,40000)\\," + wrong + "\\,0.5*sin(n/20))':s=44100:d=3\" ",
           "-c:v ffv1 -c:a " + kind);
      for (const std::string to : {"out.mp4", "out.webm"}) {
        encoded("in.mkv", to);
        EXPECT_NEAR(std::stod(probe(to, "-show_format").at("format").at("duration").get<std::string>()), 3, 0.03);
      }
    }
}

TEST_F(VideoSound, MuchSilenceLiesBesideItsPictures) {
  ASSERT_EQ(shell("ffmpeg -v error -y -f lavfi -i testsrc=s=64x48:r=4:d=40 -itsoffset 30 -f lavfi -i sine=r=8000:d=10 "
                  "-c:v ffv1 -c:a pcm_s16le in.mkv")
                .exit_code,
            0);
  for (const std::string to : {"out.mp4", "out.webm"}) {
    encoded("in.mkv", to);
    double last = 0, behind = 0;
    int sounds = 0;
    const auto packets = probe(to, "-show_packets -show_entries packet=codec_type,pos,dts_time").at("packets");
    std::map<long long, std::pair<bool, double>> in_order;
    for (const auto& packet : packets)
      in_order[std::stoll(packet.at("pos").get<std::string>())] = {packet.at("codec_type") == "audio",
                                                                   std::stod(packet.at("dts_time").get<std::string>())};
    for (const auto& [pos, packet] : in_order) {
      const auto& [sound, time] = packet;
      sounds += sound ? 1 : 0;
      if (sound) behind = std::max(behind, last - time);
      if (!sound) last = std::max(last, time);
    }
    EXPECT_GT(sounds, 30);
    EXPECT_LT(behind, 2) << to;
    const Outcome silent = shell("ffmpeg -v info -i " + to + " -af silencedetect=d=5 -f null - 2>&1");
    const std::string ends = "silence_end: ";
    const std::size_t at = silent.out.find(ends);
    ASSERT_NE(at, std::string::npos) << silent.out;
    EXPECT_NEAR(std::stod(silent.out.substr(at + ends.size())), 30, 0.05) << to;
  }
}

TEST_F(VideoSound, SoundMayBeginHoursLate) {
  ASSERT_EQ(shell("ffmpeg -v error -y -f lavfi -i testsrc=s=64x48:r=4:d=1 -itsoffset 7500 -f lavfi -i sine=r=8000:d=1 "
                  "-c:v ffv1 -c:a pcm_s16le in.mkv")
                .exit_code,
            0);
  encoded("in.mkv", "out.mp4");
  EXPECT_NEAR(std::stod(sound_of("out.mp4").at("duration").get<std::string>()), 7501, 0.3);
}

TEST_F(VideoSound, WhatCanBeCopiedIsNotEncodedAndCopyLeavesTheRestOut) {
  make("in.mkv", clicks() + clicks() + "-map 0 -map 1 -map 2 ", "-c:v ffv1 -c:a:0 aac -c:a:1 pcm_s16le");
  EXPECT_EQ(encoded("in.mkv", "out.mp4"),
            "warning: out.mp4: audio 3 (pcm_s16le) of in.mkv is encoded as aac, since mp4 does not take it; .mov, .mkv "
            "take it; --audio copy does not encode\n");
  const auto hashes = [&](const std::string& name) {
    const Outcome outcome = shell("ffmpeg -v error -i " + name + " -map 0:a:0 -c copy -f md5 -");
    return outcome.out;
  };
  EXPECT_EQ(hashes("in.mkv"), hashes("out.mp4"));
  EXPECT_EQ(probe("out.mp4", "-select_streams a -show_streams").at("streams").size(), 2u);
  EXPECT_EQ(encoded("in.mkv", "copied.mp4", {"--audio", "copy"}),
            "warning: copied.mp4: audio 3 (pcm_s16le) of in.mkv is left out, since mp4 does not take it; .mov, .mkv "
            "take it\n");
  EXPECT_EQ(probe("copied.mp4", "-select_streams a -show_streams").at("streams").size(), 1u);
  EXPECT_EQ(encoded("in.mkv", "silent.mp4", {"--audio", "none"}), "");
  EXPECT_EQ(encoded("in.mkv", "again.mp4"), encoded("in.mkv", "out.mp4").replace(9, 3, "again"));
  EXPECT_EQ(read("again.mp4"), read("out.mp4")) << "the same frames, the same file";
}

TEST_F(VideoSound, MessagesTellOfEachCodecAndOfTooManyChannels) {
  make("in.mkv", clicks() + clicks() + "-map 0 -map 1 -map 2 ",
       "-c:v ffv1 -c:a:0 flac -sample_fmt:a:0 s16 -c:a:1 libopus");
  EXPECT_EQ(encoded("in.mkv", "out.mov"),
            "warning: out.mov: audio 2 (flac) of in.mkv is encoded as pcm_s16le, since mov does not take it; .mp4, "
            ".mkv take it; --audio copy does not encode\n"
            "warning: out.mov: audio 3 (opus) of in.mkv is encoded as pcm_s24le, since mov does not take it; .mp4, "
            ".mkv, .webm take it; --audio copy does not encode\n");
  make("in.mkv", clicks(10), "-c:v ffv1 -c:a pcm_s16le");
  const std::string left = " audio 2 (pcm_s16le) of in.mkv is left out, since ", takers = "; .mov, .mkv take it\n";
  EXPECT_EQ(encoded("in.mkv", "out.mp4"),
            "warning: out.mp4:" + left + "mp4 does not take it, and AAC holds at most 8 channels" + takers);
  EXPECT_EQ(encoded("in.mkv", "out.webm"),
            "warning: out.webm:" + left + "webm does not take it, and Opus holds at most 8 channels" + takers);
}

/// FFmpeg before 7 writes sound of Opus into Matroska 7 ms early.
TEST_F(VideoSound, OpusIsCopiedInItsPlace) {
  make("in.mp4", clicks(), "-c:v libx264 -c:a libopus");
  const std::vector<double> source = heard("in.mp4");
  for (const std::string to : {"out.mkv", "out.webm", "out.mp4"}) {
    EXPECT_EQ(encoded("in.mp4", to), "");
    expect_heard(to, source);
  }
}

}  // namespace
}  // namespace afterglow::test
