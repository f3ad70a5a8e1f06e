// SPDX-License-Identifier: MIT
// What a video that is written takes from other files: sound, subtitles, chapters, attachments, times.

#include <cstring>
#include <tuple>

#include "video_out_test.h"

namespace afterglow::test {
namespace {

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

/// MOV and MP4 refuse some sound only at their head; FLAC goes into MP4.
TEST_F(VideoOut, SoundThatTheHeadRefusesIsLeftOut) {
  make_frames(3);
  for (const auto& [codec, encoder, held, takers] : {std::tuple("flac", "flac", "mp4", ".mp4, .mkv take it"),
                                                     {"opus", "libopus", "mp4", ".mp4, .mkv, .webm take it"},
                                                     {"truehd", "truehd -strict -2", "", ".mkv takes it"}}) {
    ASSERT_EQ(shell(std::string("ffmpeg -v error -y -framerate 24 -start_number 1001 -i in/%04d.ppm -f lavfi -i "
                                "sine=duration=0.2:sample_rate=48000,aformat=channel_layouts=stereo -c:v ffv1 -c:a ") +
                    encoder + " in.mkv")
                  .exit_code,
              0);
    for (const std::string container : {"mov", "mp4"}) {
      const Outcome outcome = run({"run", "look.lua", "in.mkv", "-o", "out." + container, "--audio", "copy"});
      EXPECT_EQ(outcome.exit_code, kDone) << codec << " in " << container << ": " << outcome.err;
      const auto sounds = probe("out." + container, "-show_streams -select_streams a").at("streams");
      const std::string left = "audio 2 (" + std::string(codec) + ") of in.mkv is left out, since " + container;
      if (container == held) {
        ASSERT_EQ(sounds.size(), 1u) << codec;
        EXPECT_EQ(sounds.at(0).at("codec_name"), codec);
        EXPECT_THAT(outcome.err, Not(HasSubstr("audio"))) << codec;
      } else {
        EXPECT_TRUE(sounds.empty()) << codec << " in " << container;
        EXPECT_THAT(outcome.err, HasSubstr(left + " does not take it; " + takers + "\n"));
      }
    }
  }
}

TEST_F(VideoOut, NoSoundIsCopiedWhereNoneIsAskedFor) {
  make_frames(3);
  write("text.srt", "1\n00:00:00,000 --> 00:00:00,100\nhello\n");
  ASSERT_EQ(shell("ffmpeg -v error -framerate 24 -start_number 1001 -i in/%04d.ppm -f lavfi -i sine=duration=0.2 "
                  "-i text.srt -c:v ffv1 -c:a flac in.mkv")
                .exit_code,
            0);
  const Outcome outcome = run({"run", "look.lua", "in.mkv", "-o", "out.mov", "--audio", "none"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  const auto streams = probe("out.mov", "-show_streams").at("streams");
  ASSERT_EQ(streams.size(), 2u);
  EXPECT_EQ(streams.at(1).at("codec_name"), "mov_text");
  EXPECT_EQ(make_video("sequence.mp4", {"--audio", "none"}).exit_code, kDone);
}

/// Names of chapters lie in a track of their own in MOV and MP4, which is no loss.
TEST_F(VideoOut, ChaptersOfQuickTimeAndTheLanguageOfPicturesStay) {
  make_frames(24);
  write("chapters.txt", ";FFMETADATA1\n[CHAPTER]\nTIMEBASE=1/1000\nSTART=0\nEND=1000\ntitle=one\n");
  for (const std::string name : {"in.mov", "in.mp4"}) {
    ASSERT_EQ(
        shell("ffmpeg -v error -framerate 24 -start_number 1001 -i in/%04d.ppm -i chapters.txt -map 0 -map_chapters 1 "
              "-metadata:s:v language=fra -c:v libx264 -pix_fmt yuv420p " +
              name)
            .exit_code,
        0);
    const Outcome outcome = run({"run", "look.lua", name, "-o", "out.mov"});
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_THAT(outcome.err, IsEmpty());
    EXPECT_EQ(probe("out.mov", "-show_chapters").at("chapters").at(0).at("tags").at("title"), "one");
    EXPECT_EQ(stream_of("out.mov").at("tags").at("language"), "fra");
  }
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

/// Streams that were joined.
class JoinedStreams : public VideoOut {
 protected:
  using Packets = std::vector<std::pair<std::string, double>>;

  /// part.ts of a second, of 24 pictures and sound.
  void make_part() {
    make_frames(24);
    ASSERT_EQ(shell("ffmpeg -v error -framerate 24 -start_number 1001 -i in/%04d.ppm -f lavfi -i "
                    "anoisesrc=duration=1:seed=1 -c:v libx264 -bf 2 -g 12 -c:a mp2 part.ts")
                  .exit_code,
              0);
  }
  /// What is in them, and when it shows.
  Packets packets(const std::string& name, const std::string& stream) {
    Packets all;
    const auto probed = probe(name, "-show_packets -show_data_hash md5 -select_streams " + stream);
    for (const auto& one : probed.at("packets"))
      all.emplace_back(one.at("data_hash").get<std::string>(), std::stod(one.at("pts_time").get<std::string>()));
    return all;
  }
  /// When the tenth packet of sound of each part is heard behind the first picture.
  std::vector<double> tenth_in(const std::string& name) {
    const std::string hash = packets("part.ts", "a").at(9).first;
    const double begin = packets(name, "v").front().second;
    std::vector<double> times;
    for (const auto& [own, time] : packets(name, "a"))
      if (own == hash) times.push_back(time - begin);
    return times;
  }
  std::vector<double> out_times(const std::string& name, const std::vector<std::string>& more,
                                const std::string& from = "joined.ts") {
    std::vector<std::string> arguments{"run", "look.lua", from, "-o", name, "--codec", "ffv1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return tenth_in(name);
  }
};

/// The sound of each part stays beside its pictures.
TEST_F(JoinedStreams, SoundFollowsAClockThatStartsAnew) {
  make_part();
  ASSERT_EQ(shell("cat part.ts part.ts part.ts > joined.ts").exit_code, 0);
  const double late = packets("part.ts", "a").at(9).second - packets("part.ts", "v").front().second;
  const std::vector<double> whole = out_times("whole.mkv", {});
  ASSERT_EQ(whole.size(), 3u);
  for (int part = 0; part < 3; ++part) EXPECT_NEAR(whole[static_cast<std::size_t>(part)], late + part, 2e-3);
  const std::vector<double> cut = out_times("cut.mkv", {"--frames", "19-40"});
  ASSERT_EQ(cut.size(), 1u);
  EXPECT_NEAR(cut[0], late + 1 - 18 / 24.0, 2e-3);
  EXPECT_EQ(packets("whole.mkv", "a").size(), 3 * packets("part.ts", "a").size());
}

/// Through a pipe they end the run, and say why.
TEST_F(JoinedStreams, AreReadOfFilesOnly) {
  make_part();
  const Outcome outcome = shell("cat part.ts part.ts | \"$AFTERGLOW\" run look.lua - -o out.mkv --codec ffv1");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_THAT(outcome.err, HasSubstr("where the stream's clock starts anew, which is read of files only"));
}

/// Sound of another file follows that file's clock; where it has no pictures, sound goes on behind sound.
TEST_F(JoinedStreams, SoundOfAnotherFileFollowsItsOwnClock) {
  make_part();
  ASSERT_EQ(shell("ffmpeg -v error -i part.ts -map 0:a -c copy sound.ts && cat part.ts part.ts part.ts > joined.ts && "
                  "cat sound.ts sound.ts sound.ts > sounds.ts && "
                  "ffmpeg -v error -f lavfi -i color=s=16x16:r=24:d=5 -c:v ffv1 long.mkv")
                .exit_code,
            0);
  const auto sound = packets("part.ts", "a");
  const double behind_picture = sound.at(9).second - packets("part.ts", "v").front().second,
               behind_sound = sound.at(9).second - sound.at(0).second;
  for (const auto& [from, first] : {std::pair("joined.ts", behind_picture), std::pair("sounds.ts", behind_sound)}) {
    const std::vector<double> times = out_times(std::string(from) + ".mkv", {"--audio", from}, "long.mkv");
    ASSERT_EQ(times.size(), 3u) << from;
    EXPECT_NEAR(times[0], first, 2e-3) << from;
    for (std::size_t part = 1; part < 3; ++part) EXPECT_NEAR(times[part] - times[part - 1], 1, 0.03) << from;
  }
}

/// The clock of MP3 in AVI counts packets of 24 ms: a cut is made by a finer one.
TEST_F(VideoOut, CutsAreNoRounderThanTheClockOfTheOutput) {
  make_frames(24);
  ASSERT_EQ(shell("ffmpeg -v error -framerate 24 -start_number 1001 -i in/%04d.ppm -f lavfi -i "
                  "anoisesrc=duration=1:seed=1:sample_rate=48000 -c:v mjpeg -c:a libmp3lame in.avi")
                .exit_code,
            0);
  const auto packets = [&](const std::string& name, const char* stream) {
    return probe(name, std::string("-show_packets -show_data_hash md5 -select_streams ") + stream).at("packets");
  };
  const auto time_of = [](const auto& packet) { return std::stod(packet.at("pts_time").template get<std::string>()); };
  const auto pictures = packets("in.avi", "v"), sounds = packets("in.avi", "a");
  for (const int first : {2, 8, 13}) {
    ASSERT_EQ(run({"run", "look.lua", "in.avi", "-o", "out.mkv", "--codec", "ffv1", "--frames",
                   std::to_string(first) + "-24"})
                  .exit_code,
              kDone);
    const double shift = time_of(pictures.at(static_cast<std::size_t>(first) - 1));
    const auto& wanted = sounds.at(30);
    double found = -1;
    for (const auto& packet : packets("out.mkv", "a"))
      if (packet.at("data_hash") == wanted.at("data_hash")) found = time_of(packet);
    EXPECT_NEAR(found, time_of(wanted) - shift, 1.1e-3) << first;
  }
}

/// Several pictures in a packet of a program stream, of which one says when it shows: sound stays beside them.
TEST_F(VideoOut, PicturesThatShareAPacketShowWhenTheySay) {
  make_frames(24);
  ASSERT_EQ(shell("ffmpeg -v error -framerate 24 -start_number 1001 -i in/%04d.ppm -f lavfi -i "
                  "anoisesrc=duration=1:seed=1 -s 32x32 -c:v mpeg2video -b:v 60k -bf 2 -g 12 -c:a mp2 part.mpg")
                .exit_code,
            0);
  const auto packets = probe("part.mpg", "-show_packets").at("packets");
  double picture = -1, sound = -1;
  int silent = 0;
  for (const auto& packet : packets) {
    const bool told = packet.contains("pts_time");
    double& first = packet.at("codec_type") == "video" ? picture : sound;
    if (told && first < 0) first = std::stod(packet.at("pts_time").get<std::string>());
    silent += told ? 0 : 1;
  }
  ASSERT_GT(silent, 5) << "pictures share packets";
  ASSERT_EQ(run({"run", "look.lua", "part.mpg", "-o", "out.mkv", "--codec", "ffv1"}).exit_code, kDone);
  const auto begin = [&](const char* stream) {
    const auto all = probe("out.mkv", std::string("-show_packets -select_streams ") + stream).at("packets");
    return std::stod(all.at(0).at("pts_time").get<std::string>());
  };
  EXPECT_NEAR(begin("a") - begin("v"), sound - picture, 2e-3);
}

/// What a container does not hold as it is becomes text that it does; attachments go where they can be named.
TEST_F(VideoOut, SubtitlesBecomeThoseOfTheContainer) {
  make_frames(24);
  write("text.srt", "1\n00:00:00,100 --> 00:00:00,400\nfirst <i>line</i>\n\n2\n00:00:00,500 --> 00:00:00,900\nlast\n");
  write("font.ttf", "no font, but its bytes stay");
  ASSERT_EQ(shell("ffmpeg -v error -framerate 24 -start_number 1001 -i in/%04d.ppm -i text.srt -map 0 -map 1 "
                  "-attach font.ttf -metadata:s:t mimetype=font/ttf -c:v ffv1 -c:s srt in.mkv")
                .exit_code,
            0);
  const auto cues = [&](const std::string& name) {
    const Outcome outcome = shell("ffmpeg -v error -i " + name + " -map 0:s -f srt -");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.out;
  };
  const std::string before = cues("in.mkv");
  ASSERT_THAT(before, HasSubstr("00:00:00,500 --> 00:00:00,900\nlast"));
  for (const auto& [name, codec] : {std::pair{"out.mp4", "mov_text"}, std::pair{"out.mov", "mov_text"}}) {
    const Outcome outcome = run({"run", "look.lua", "in.mkv", "-o", name});
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("attachment 3 (none) of in.mkv is left out, since m"));
    EXPECT_THAT(outcome.err, HasSubstr("; .mkv takes it\n"));
    EXPECT_EQ(probe(name, "-select_streams s -show_streams").at("streams").at(0).at("codec_name"), codec);
    EXPECT_EQ(cues(name), before) << name;
  }
  // And back: Matroska holds no mov_text.
  ASSERT_EQ(run({"run", "look.lua", "out.mp4", "-o", "again.mkv"}).exit_code, kDone);
  EXPECT_EQ(probe("again.mkv", "-select_streams s -show_streams").at("streams").at(0).at("codec_name"), "ass");
  EXPECT_EQ(cues("again.mkv"), before);
  const Outcome kept = run({"run", "look.lua", "in.mkv", "-o", "kept.mkv"});
  ASSERT_EQ(kept.exit_code, kDone);
  EXPECT_THAT(kept.err, IsEmpty());
  ASSERT_EQ(shell("ffmpeg -v error -dump_attachment:t:0 out.ttf -i kept.mkv -t 0 -f null -").exit_code, 0);
  EXPECT_EQ(read("out.ttf"), read("font.ttf"));
}

TEST_F(VideoOut, TheTimecodeIsThatOfTheFirstPicture) {
  make_frames(20);
  ASSERT_EQ(
      shell(
          "ffmpeg -v error -framerate 25 -start_number 1001 -i in/%04d.ppm -c:v prores_ks -timecode 09:59:59:20 in.mov")
          .exit_code,
      0);
  for (const auto& [frames, first] : {std::pair{"1-20", "09:59:59:20"}, std::pair{"8-20", "10:00:00:02"}}) {
    const Outcome outcome = run({"run", "look.lua", "in.mov", "-o", "out.mov", "--frames", frames});
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_THAT(outcome.err, IsEmpty());
    EXPECT_EQ(stream_of("out.mov").at("tags").at("timecode"), first);
  }
}

/// Pictures have it in their files: into a video goes that of the first, out of one each gets its own.
TEST_F(VideoOut, TimecodesGoBetweenPicturesAndVideos) {
  make_frames(30);
  ASSERT_EQ(shell("ffmpeg -v error -framerate 30000/1001 -start_number 1001 -i in/%04d.ppm -c:v prores_ks -timecode "
                  "'00:59:59;20' in.mov")
                .exit_code,
            0);
  ASSERT_EQ(run({"run", "look.lua", "in.mov", "-o", "out.####.exr"}).exit_code, kDone);
  // As EXR keeps it: decimal digits, and a bit that numbers are dropped.
  const auto code_of = [&](const std::string& name) {
    const std::string bytes = read(name), head("timecode\0\10\0\0\0", 13);
    std::uint32_t code = 0;
    if (const auto at = bytes.find(head); at != std::string::npos) std::memcpy(&code, &bytes[at + head.size()], 4);
    return code;
  };
  EXPECT_EQ(code_of("out.0001.exr"), 0x00595960u) << "00:59:59;20";
  EXPECT_EQ(code_of("out.0010.exr"), 0x00595969u) << "00:59:59;29";
  EXPECT_EQ(code_of("out.0011.exr"), 0x01000040u) << "01:00:00;00";
  for (const auto& [output, frames, first] :
       {std::tuple{"again.mov", "1-30", "00:59:59;20"}, std::tuple{"later.mp4", "11-30", "01:00:00;00"}}) {
    ASSERT_EQ(run({"run", "look.lua", "out.####.exr", "-o", output, "--frames", frames, "--fps", "29.97"}).exit_code,
              kDone);
    EXPECT_EQ(stream_of(output).at("tags").at("timecode"), first);
  }
  // At a rate at which no numbers are dropped it means nothing.
  ASSERT_EQ(run({"run", "look.lua", "out.####.exr", "-o", "other.mov", "--fps", "24"}).exit_code, kDone);
  EXPECT_FALSE(stream_of("other.mov").at("tags").contains("timecode"));
}

}  // namespace
}  // namespace afterglow::test
