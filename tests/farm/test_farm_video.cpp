// SPDX-License-Identifier: MIT
// Videos in and out of a farm: frames by number, and one file that chunks have made.
#include <csignal>
#include <set>
#include <sstream>

#include "farm_test.h"

namespace afterglow::test {
namespace {

class FarmVideo : public FarmTest {
 protected:
  void SetUp() override {
    FarmTest::SetUp();
    if (std::system("command -v ffmpeg >/dev/null && command -v ffprobe >/dev/null") != 0)
      GTEST_SKIP() << "the program ffmpeg is not installed";
    fs::create_directory(path("out"));
    fs::create_directory(path("one"));
  }
  Outcome shell(const std::string& command) const {
    RunOptions options;
    options.program = "/bin/sh";
    return run({"-c", command}, options);
  }
  /// Moving pictures with B-frames, sound, a chapter and a title.
  void make_clip(const std::string& name, int frames, const std::string& more = "") const {
    write("chapters.txt",
          ";FFMETADATA1\ntitle=the shot\n[CHAPTER]\nTIMEBASE=1/1000\nSTART=0\nEND=400\ntitle=one\n"
          "[CHAPTER]\nTIMEBASE=1/1000\nSTART=400\nEND=900\ntitle=two\n");
    const std::string seconds = std::to_string(frames / 24.0);
    const Outcome made = shell(
        "ffmpeg -v error -f lavfi -i testsrc2=size=256x144:rate=24 -f lavfi -i sine -i chapters.txt "
        "-map 0:v -map 1:a -map_metadata 2 -frames:v " +
        std::to_string(frames) + " -t " + seconds + " -c:v libx264 -bf 3 -g 12 -pix_fmt yuv420p -c:a aac " + more +
        " -y " + name);
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  /// A hash and the time stamp of every frame.
  std::string frames_of(const std::string& name) const {
    const Outcome outcome = shell("ffmpeg -v error -i " + name + " -map 0:v -copyts -f framemd5 -");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.out;
  }
  std::string packets_of(const std::string& name, const std::string& stream) const {
    return shell("ffprobe -v error -select_streams " + stream +
                 " -show_entries packet=pts_time,dts_time,duration_time,size,flags -of csv " + name)
        .out;
  }
  std::vector<std::string> key_frames(const std::string& name) const {
    std::istringstream lines(
        shell("ffprobe -v error -select_streams v -show_entries frame=key_frame -of csv=p=0 " + name).out);
    std::vector<std::string> keys;
    for (std::string line; std::getline(lines, line);)
      if (!line.empty()) keys.push_back(line.substr(0, 1));
    return keys;
  }
  nlohmann::json write_jobs(const std::vector<std::string>& words) const {
    std::vector<std::string> all = words;
    all.insert(all.end(), {"--jobs", "jobs.json"});
    const Outcome outcome = farm(all);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return nlohmann::json::parse(read("jobs.json"), nullptr, false);
  }
  Outcome run_line(const nlohmann::json& what) const {
    RunOptions options;
    options.program = "/bin/sh";
    options.folder = "/";
    return run({"-c", what["shell"].get<std::string>()}, options);
  }
  /// All chunks, the last one first.
  void run_chunks(const nlohmann::json& jobs) const {
    ASSERT_TRUE(jobs.contains("chunks"));
    for (auto chunk = jobs["chunks"].rbegin(); chunk != jobs["chunks"].rend(); ++chunk) {
      const Outcome made = run_line(*chunk);
      EXPECT_EQ(made.exit_code, kDone) << made.err;
    }
  }
  /// `video` by chunks and by one run; the chunks of the job.
  nlohmann::json make_both(const std::string& input, const std::string& video,
                           const std::vector<std::string>& more = {}) const {
    std::vector<std::string> whole{"run", "look.lua", input, "-o", "one/" + video};
    whole.insert(whole.end(), more.begin(), more.end());
    const Outcome one = run(whole);
    EXPECT_EQ(one.exit_code, kDone) << one.err;
    std::vector<std::string> parts{"look.lua", input, "-o", "out/" + video, "--chunk", "7"};
    parts.insert(parts.end(), more.begin(), more.end());
    const auto jobs = write_jobs(parts);
    run_chunks(jobs);
    EXPECT_FALSE(fs::exists(path("out/" + video)));
    const Outcome joined = run_line(jobs["join"]);
    EXPECT_EQ(joined.exit_code, kDone) << joined.err;
    return jobs;
  }
};

TEST_F(FarmVideo, NobodyIsWarnedOfARateThatNobodyGave) {
  make_clip("clip.mp4", 10, "-r 25");
  make_look_back();
  const auto jobs = write_jobs({"look.lua", "clip.mp4", "-o", "out/shot.mkv", "--codec", "ffv1", "--chunk", "5"});
  const Outcome made = run_line(jobs["chunks"][0]);
  EXPECT_EQ(made.exit_code, kDone) << made.err;
  EXPECT_THAT(made.err, Not(HasSubstr("--fps")));
}

TEST_F(FarmVideo, ChunksOfAClipMakeTheFramesOfOneRun) {
  make_clip("clip.mp4", 26);
  make_look_back();
  ASSERT_EQ(run({"run", "look.lua", "clip.mp4", "-o", "one/shot.####.exr"}).exit_code, kDone);
  const auto jobs = write_jobs({"look.lua", "clip.mp4", "-o", "out/shot.####.exr", "--chunk", "7"});
  ASSERT_EQ(jobs["chunks"].size(), 4u);
  EXPECT_EQ(jobs["chunks"][1]["frames"], "8-14");
  EXPECT_EQ(jobs["chunks"][1]["inputs"], nlohmann::json::array({text("clip.mp4")}));
  EXPECT_EQ(jobs["chunks"][3]["count"], 5);
  EXPECT_FALSE(jobs.contains("join"));
  run_chunks(jobs);
  expect_as_one_run("out", "one");
}

struct Intra {
  const char *file, *codec;
  bool same_file = true;  ///< FFmpeg 5 reads FFV1's header of an odd length back with one byte more
};
class FarmVideoIntra : public FarmVideo, public ::testing::WithParamInterface<Intra> {};

TEST_P(FarmVideoIntra, TheJoinedFileIsThatOfOneRunByteForByte) {
  make_clip("clip.mkv", 26);
  make_look_back();
  const auto& [file, codec, same_file] = GetParam();
  make_both("clip.mkv", file, {"--codec", codec});
  EXPECT_EQ(frames_of(std::string("out/") + file), frames_of(std::string("one/") + file));
  EXPECT_EQ(packets_of(std::string("out/") + file, "v"), packets_of(std::string("one/") + file, "v"));
  EXPECT_EQ(packets_of(std::string("out/") + file, "a"), packets_of(std::string("one/") + file, "a"));
  if (same_file) {
    EXPECT_TRUE(read(std::string("out/") + file) == read(std::string("one/") + file));
  }
  EXPECT_FALSE(fs::exists(job_of("out") / "pieces")) << "what was joined goes";
}
INSTANTIATE_TEST_SUITE_P(FarmVideo, FarmVideoIntra,
                         ::testing::Values(Intra{"a.mov", "prores"}, Intra{"a.mov", "prores4444"},
                                           Intra{"a.mov", "dnxhr"}, Intra{"a.mkv", "ffv1", false},
                                           Intra{"a.mkv", "prores"}),
                         [](const auto& info) {
                           return std::string(info.param.codec) + "_" +
                                  fs::path(info.param.file).extension().string().substr(1);
                         });

struct Inter {
  const char *file, *codec;
};
class FarmVideoInter : public FarmVideo, public ::testing::WithParamInterface<Inter> {};

TEST_P(FarmVideoInter, EachChunkBeginsWithAKeyFrameAndTimesAreThoseOfOneRun) {
  make_clip("clip.mkv", 26);
  make_look_back();
  const std::string file = GetParam().file, joined = "out/" + file, one = "one/" + file;
  make_both("clip.mkv", file, {"--codec", GetParam().codec});
  const auto keys = key_frames(joined);
  ASSERT_EQ(keys.size(), 26u);
  for (const std::size_t first : {0u, 7u, 14u, 21u}) EXPECT_EQ(keys[first], "1") << first;
  const auto times = [&](const std::string& name) {
    return shell("ffprobe -v error -select_streams v -show_entries frame=best_effort_timestamp_time -of csv=p=0 " +
                 name + " | tr -d , | grep .")
        .out;
  };
  EXPECT_EQ(times(joined), times(one));
  EXPECT_EQ(packets_of(joined, "a"), packets_of(one, "a"));
  // As near to what went in as one run.
  const auto quality = [&](const std::string& name) {
    const Outcome outcome = shell("ffmpeg -v info -i " + name +
                                  " -i clip.mkv -lavfi '[0:v][1:v]psnr' -f null - 2>&1 | "
                                  "grep -o 'average:[0-9.]*' | cut -d: -f2");
    return std::stod(outcome.out);
  };
  EXPECT_GT(quality(joined), quality(one) - 1);
}
INSTANTIATE_TEST_SUITE_P(FarmVideo, FarmVideoInter,
                         ::testing::Values(Inter{"a.mp4", "h264"}, Inter{"a.mkv", "h264"}, Inter{"a.mov", "h265"},
                                           Inter{"a.webm", "vp9"}, Inter{"a.mp4", "av1"}),
                         [](const auto& info) {
                           return std::string(info.param.codec) + "_" +
                                  fs::path(info.param.file).extension().string().substr(1);
                         });

TEST_F(FarmVideo, PicturesBecomeOneVideoToo) {
  make_frames("in", 1, 20, 64, 48);
  make_look_back();
  const auto jobs = make_both("in/shot.####.exr", "a.mov", {"--fps", "30", "--frames", "3-20"});
  EXPECT_TRUE(read("out/a.mov") == read("one/a.mov"));
  EXPECT_EQ(jobs["chunks"][0]["outputs"].size(), 1u) << "its piece";
  EXPECT_EQ(jobs["join"]["outputs"], nlohmann::json::array({text("out/a.mov")}));
  EXPECT_EQ(jobs["join"]["inputs"][0], jobs["chunks"][0]["outputs"][0]);
  const auto report = report_of("out");
  EXPECT_EQ(report["frames"].size(), 18u);
  EXPECT_EQ(report["frames"][0]["output"], text("out/a.mov"));
  EXPECT_THAT(farm({"status", "out"}).out, HasSubstr("18 of 18 frames, 3 chunks and the join: 4 done"));
}

TEST_F(FarmVideo, PlacesOfMissingPicturesAreHeldToo) {
  make_frames("in", 1, 20, 64, 48);
  for (const char* name : {"in/shot.0003.exr", "in/shot.0011.exr"}) ASSERT_TRUE(fs::remove(path(name)));
  make_look_back();
  make_both("in/shot.####.exr", "a.mov");
  EXPECT_TRUE(read("out/a.mov") == read("one/a.mov"));
}

TEST_F(FarmVideo, TheTimeCodeIsThatOfTheFirstPicture) {
  make_frames("in", 1, 16, 64, 48);
  for (int frame = 1; frame <= 16; ++frame) {
    const std::string name = fmt::format("in/shot.{:04}.exr", frame);
    ASSERT_EQ(
        shell(fmt::format("oiiotool {0} --attrib:type=timecode smpte:TimeCode 01:02:03:{1:02} -o {0}", name, frame + 2))
            .exit_code,
        0);
  }
  make_look_back();
  const auto code = [&](const std::string& file) {
    return shell("ffprobe -v error -select_streams v:0 -show_entries stream_tags=timecode -of csv=p=0 " + file).out;
  };
  for (const char* video : {"a.mov", "a.mkv"}) {
    make_both("in/shot.####.exr", video, {"--frames", "4-16"});
    EXPECT_EQ(code(std::string("one/") + video), "01:02:03:06\n") << video;
    EXPECT_EQ(code(std::string("out/") + video), "01:02:03:06\n") << video;
  }
}

TEST_F(FarmVideo, AlphaOfVp9AndSoundOfAnotherFileStay) {
  make_clip("clip.mkv", 20);
  make_look_back();
  const Outcome alpha_clip = shell(
      "ffmpeg -v error -f lavfi -i testsrc2=size=256x144:rate=24 -frames:v 20 -vf "
      "\"format=rgba,geq=r='r(X,Y)':g='g(X,Y)':b='b(X,Y)':a='X'\" -pix_fmt bgra -c:v ffv1 -y alpha.mkv");
  ASSERT_EQ(alpha_clip.exit_code, 0) << alpha_clip.err;
  make_both("alpha.mkv", "a.webm", {"--audio", "clip.mkv", "--codec", "vp9"});
  const auto probe = [&](const std::string& name) {
    return shell("ffprobe -v error -show_entries stream=codec_name,index:stream_tags=alpha_mode -of csv " + name).out;
  };
  EXPECT_EQ(probe("out/a.webm"), probe("one/a.webm"));
  const auto alpha = [&](const std::string& name) {
    return shell("ffmpeg -v error -c:v libvpx-vp9 -i " + name + " -vf alphaextract -f framemd5 -").out;
  };
  EXPECT_THAT(alpha("out/a.webm"), HasSubstr("0, "));
  EXPECT_EQ(std::ranges::count(alpha("out/a.webm"), '\n'), std::ranges::count(alpha("one/a.webm"), '\n'));
}

TEST_F(FarmVideo, WhatIsNotDoneIsNotJoined) {
  make_clip("clip.mp4", 20);
  make_look_back();
  const auto jobs = write_jobs({"look.lua", "clip.mp4", "-o", "out/a.mov", "--chunk", "8"});
  ASSERT_EQ(jobs["chunks"].size(), 3u);
  ASSERT_EQ(run_line(jobs["chunks"][0]).exit_code, kDone);
  ASSERT_EQ(run_line(jobs["chunks"][2]).exit_code, kDone);
  const Outcome early = run_line(jobs["join"]);
  EXPECT_EQ(early.exit_code, kFiles);
  EXPECT_THAT(early.err, HasSubstr("a.mov: error: waits for chunk 1, which is not done"));
  EXPECT_FALSE(fs::exists(path("out/a.mov")));
  expect_nothing_half_written("out");
  ASSERT_EQ(run_line(jobs["chunks"][1]).exit_code, kDone);
  // A piece that somebody has damaged or exchanged.
  const fs::path piece = jobs["chunks"][1]["outputs"][0].get<std::string>();
  const std::string name = fs::relative(piece, path("")).string(), good = read(name);
  const auto refused = [&](const std::string& content, const std::string& part) {
    write(name, content);
    const Outcome outcome = farm({"join", "out"});
    EXPECT_EQ(outcome.exit_code, kFiles) << part;
    EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(part));
    EXPECT_FALSE(fs::exists(path("out/a.mov")));
  };
  refused(good.substr(0, good.size() / 2), "pieces/1.mov: error: ");
  refused("no video", "pieces/1.mov: error: ");
  const std::string shorter = jobs["chunks"][2]["outputs"][0];
  refused(read(fs::relative(shorter, path("")).string()), "has 4 frames, not 8");
  ASSERT_EQ(
      run({"run", "look.lua", "clip.mp4", "-o", "other.mov", "--codec", "prores4444", "--frames", "9-16"}).exit_code,
      kDone);
  refused(read("other.mov"), "has other pixels than the first piece");
  write(name, good);
  RunOptions full;
  full.largest_file = 4096;
  const Outcome no_room = farm({"join", "out"}, full);
  EXPECT_EQ(no_room.exit_code, kFiles);
  EXPECT_THAT(no_room.err, HasSubstr("a.mov: error: cannot be written: File too large"));
  expect_nothing_half_written("out");
  EXPECT_EQ(farm({"join", "out"}).exit_code, kDone);
  EXPECT_EQ(key_frames("out/a.mov").size(), 20u);
}

TEST_F(FarmVideo, AVideoThatIsThereIsJoinedAndOneThatIsGoneIsMadeAgain) {
  make_clip("clip.mp4", 10);
  make_look_back();
  const auto jobs = write_jobs({"look.lua", "clip.mp4", "-o", "out/a.mov", "--chunk", "5"});
  run_chunks(jobs);
  ASSERT_EQ(run_line(jobs["join"]).exit_code, kDone);
  const std::string made = read("out/a.mov");
  EXPECT_EQ(run_line(jobs["join"]).exit_code, kDone) << "a scheduler may run it twice";
  EXPECT_TRUE(read("out/a.mov") == made);
  fs::remove(path("out/a.mov"));
  EXPECT_THAT(farm({"status", "out"}).out, ::testing::AllOf(HasSubstr("0 of 10 frames, 2 chunks and the join: 3 lost"),
                                                            HasSubstr("the video that was joined is gone")));
  run_chunks(jobs);
  EXPECT_THAT(farm({"status", "out"}).out, HasSubstr("10 of 10 frames, 2 chunks and the join: 2 done, 1 lost"));
  ASSERT_EQ(run_line(jobs["join"]).exit_code, kDone);
  EXPECT_EQ(key_frames("out/a.mov").size(), 10u);
  EXPECT_THAT(farm({"status", "out"}).out, HasSubstr("2 chunks and the join: 3 done"));
}

TEST_F(FarmVideo, WhatCannotBeJoinedIsRefusedBeforeAnyWork) {
  make_clip("clip.mp4", 6);
  make_look_back();
  const auto refused = [&](std::vector<std::string> words, int exit_code, const std::string& part) {
    words.insert(words.begin(), "look.lua");
    words.insert(words.end(), {"--jobs", "jobs.json"});
    const Outcome outcome = farm(words);
    EXPECT_EQ(outcome.exit_code, exit_code) << part;
    EXPECT_TRUE(is_one_error_line(outcome.err));
    EXPECT_THAT(outcome.err, HasSubstr(part));
  };
  refused({"clip.mp4", "-o", "out/a.gif"}, kUsage, "gif files cannot be joined from pieces");
  refused({"clip.mp4", "-o", "out/a.apng"}, kUsage, "apng files cannot be joined");
  refused({"clip.mp4", "-o", "out/a.mp4", "--codec", "prores"}, kUsage, "mp4 files do not hold prores");
  refused({"clip.mp4", "-o", "out/a.mp4", "--audio", "none.wav"}, kFiles, "none.wav: error: no such file");
  refused({"clip.mp4", "clip.mp4", "-o", "out/a.mp4"}, kUsage, "are videos, and one video is made of one");
  EXPECT_FALSE(fs::exists(path("out/.afterglow-farm")));
  ASSERT_EQ(farm({"look.lua", "clip.mp4", "-o", "out/####.exr", "--jobs", "jobs.json"}).exit_code, kDone);
  const Outcome join = farm({"join", "out"});
  EXPECT_EQ(join.exit_code, kUsage);
  EXPECT_THAT(join.err, HasSubstr("there is nothing to join"));
}

TEST_F(FarmVideo, OverFourNodesAVideoIsThatOfOneRun) {
  AFTERGLOW_NEEDS_CLUSTER();
  make_clip("clip.mkv", 60);
  make_look_back();
  ASSERT_EQ(run({"run", "look.lua", "clip.mkv", "-o", "one/a.mov"}).exit_code, kDone);
  const Outcome waited = farm({"look.lua", "clip.mkv", "-o", "out/a.mov", "--chunk", "4", "--wait"});
  ASSERT_EQ(waited.exit_code, kDone) << waited.err;
  EXPECT_THAT(waited.out, HasSubstr(": 15 chunks and the join"));
  EXPECT_TRUE(read("out/a.mov") == read("one/a.mov"));
  EXPECT_EQ(frames_of("out/a.mov"), frames_of("one/a.mov"));
  expect_nothing_half_written("out");
  EXPECT_THAT(farm({"status", "out"}).out, HasSubstr("60 of 60 frames, 15 chunks and the join: 16 done"));
  EXPECT_EQ(report_of("out")["frames"].size(), 60u);
}

TEST_F(FarmVideo, AChunkThatIsKilledIsMadeAgainBeforeTheJoin) {
  AFTERGLOW_NEEDS_CLUSTER();
  make_clip("clip.mkv", 60);
  make_look_back(300);
  ASSERT_EQ(run({"run", "look.lua", "clip.mkv", "-o", "one/a.mov"}).exit_code, kDone);
  ASSERT_EQ(farm({"look.lua", "clip.mkv", "-o", "out/a.mov", "--chunk", "30"}).exit_code, kDone);
  nlohmann::json caught;
  ASSERT_TRUE(wait_until([&] {
    bool writes = false;
    for (const auto& entry : fs::recursive_directory_iterator(job_of("out") / "pieces"))
      writes = writes || entry.path().filename().string().find(".tmp") != std::string::npos;
    const auto begun = attempts("out", ".begun");
    if (writes && !begun.empty())
      caught = nlohmann::json::parse(read(fs::relative(begun.front(), path("")).string()), nullptr, false);
    return caught.is_object();
  }));
  ASSERT_EQ(kill(caught["process"].get<int>(), SIGKILL), 0);
  const Outcome waited = farm({"status", "out", "--wait"});
  EXPECT_EQ(waited.exit_code, kDone) << waited.err;
  EXPECT_TRUE(read("out/a.mov") == read("one/a.mov"));
  expect_nothing_half_written("out");
}

TEST_F(FarmVideo, ABadFrameLeavesNoVideoUntilItIsMended) {
  AFTERGLOW_NEEDS_CLUSTER();
  make_frames("in", 1, 12, 64, 48);
  make_look_back();
  const std::string good = read("in/shot.0006.exr");
  ASSERT_EQ(run({"run", "look.lua", "in/shot.####.exr", "-o", "one/a.mov"}).exit_code, kDone);
  write("in/shot.0006.exr", good.substr(0, good.size() / 2));
  const Outcome waited =
      farm({"look.lua", "in/shot.####.exr", "-o", "out/a.mov", "--chunk", "4", "--retries", "0", "--wait"});
  EXPECT_EQ(waited.exit_code, kFiles) << waited.err;
  EXPECT_THAT(waited.err, HasSubstr("3 of 3 chunks and the join are not done (1 done, 3 failed)"))
      << "the third chunk looks back at the frame";
  EXPECT_THAT(waited.err, HasSubstr("in/shot.0006.exr: error: "));
  EXPECT_FALSE(fs::exists(path("out/a.mov")));
  write("in/shot.0006.exr", good);
  const Outcome retried = farm({"retry", "out", "--wait"});
  EXPECT_EQ(retried.exit_code, kDone) << retried.err;
  EXPECT_TRUE(read("out/a.mov") == read("one/a.mov"));
  EXPECT_EQ(attempts("out", ".exit-0").size(), 4u) << "three chunks and the join";
  EXPECT_EQ(attempts("out", ".exit-4").size(), 3u);
}

TEST_F(FarmVideo, ARetryMakesTheJoinWaitForItToo) {
  AFTERGLOW_NEEDS_CLUSTER();
  make_frames("in", 1, 8, 64, 48);
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.tone_mapping {} }\n");
  const std::string good = read("in/shot.0002.exr");
  ASSERT_EQ(run({"run", "look.lua", "in/shot.####.exr", "-o", "one/a.mov"}).exit_code, kDone);
  write("in/shot.0002.exr", good.substr(0, good.size() / 2));
  const Outcome submitted =
      farm({"look.lua", "in/shot.####.exr", "-o", "out/a.mov", "--chunk", "4", "--retries", "0", "--", "--hold"});
  ASSERT_EQ(submitted.exit_code, kDone) << submitted.err;
  // The first chunk fails while the second one and the join wait.
  const std::size_t id = submitted.out.find("slurm ") + 6;
  const std::string array = submitted.out.substr(id, submitted.out.find(',', id) - id);
  ASSERT_EQ(slurm("scontrol", {"release", array + "_0"}).exit_code, 0) << submitted.out;
  ASSERT_TRUE(wait_until([&] { return attempts("out", "0.1.exit-4").size() == 1; }));
  write("in/shot.0002.exr", good);
  ASSERT_TRUE(wait_until([&] { return farm({"status", "out"}).out.find("2 waiting, 1 failed") != std::string::npos; }));
  const Outcome retried = farm({"retry", "out"});
  ASSERT_EQ(retried.exit_code, kDone) << retried.err;
  EXPECT_THAT(retried.out, HasSubstr(": 1 chunks and the join"));
  std::istringstream waiting(slurm("squeue", {"--noheader", "--states=PENDING", "--format=%F"}).out);
  std::set<std::string> held;
  for (std::string line; std::getline(waiting, line);) held.insert(line);
  EXPECT_EQ(held.size(), 3u) << "what is left of the first array, the chunk that is tried again, and one join";
  for (const auto& id_of_array : held) slurm("scontrol", {"release", id_of_array});  // complains of the task that ended
  const Outcome waited = farm({"status", "out", "--wait"});
  EXPECT_EQ(waited.exit_code, kDone) << waited.err;
  EXPECT_TRUE(read("out/a.mov") == read("one/a.mov"));
  EXPECT_EQ(attempts("out", ".exit-0").size(), 3u) << "the join was tried once";
  EXPECT_EQ(attempts("out", ".exit-4").size(), 1u);
}

}  // namespace
}  // namespace afterglow::test
