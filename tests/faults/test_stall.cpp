// SPDX-License-Identifier: MIT
// Inputs that give no more bytes, and never end: pipes whose writer hangs, files of a network that is gone.
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "fault_test.h"

namespace afterglow::test {
namespace {

constexpr const char* kTimeout = "AFTERGLOW_INPUT_TIMEOUT";

class Stall : public FaultTest {
 protected:
  void SetUp() override {
    FaultTest::SetUp();
    make_preset("look.lua");
    ASSERT_EQ(mkfifo(text("pipe").c_str(), 0600), 0);
    pipe_ = open(text("pipe").c_str(), O_RDWR | O_CLOEXEC);  // a writer that hangs
  }
  void TearDown() override {
    close(pipe_);
    FaultTest::TearDown();
  }
  Outcome shell(const std::string& command, RunOptions options = {}) const {
    options.program = "/bin/sh";
    options.environment["AFTERGLOW"] = AFTERGLOW_PROGRAM;
    return run({"-c", command}, std::move(options));
  }
  /// Frames of Y4M, and half of one more; less than a pipe holds.
  void put_frames(int count) const {
    constexpr int kWidth = 64, kHeight = 36;
    std::string bytes = "YUV4MPEG2 W64 H36 F24:1 C444\n";
    for (int i = 0; i <= count; ++i)
      bytes += "FRAME\n" + std::string(kWidth * kHeight * 3 / (i == count ? 2 : 1), static_cast<char>(60 + i));
    ASSERT_EQ(::write(pipe_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  bool is_drained() const {
    int left = -1;
    return ioctl(pipe_, FIONREAD, &left) == 0 && left == 0;
  }
  /// User's and system's time of the process, in ticks.
  static std::string time_of(int process) {
    std::string line, word, out;
    std::getline(std::ifstream("/proc/" + std::to_string(process) + "/stat"), line);
    std::istringstream words(line.substr(line.rfind(')') + 1));
    constexpr int kFirst = 12, kLast = 13;  // words behind the name
    for (int i = 1; i <= kLast && words >> word; ++i)
      if (i >= kFirst) out += word + " ";
    return out;
  }
  void make_clip(const std::string& arguments) const {
    if (std::system("command -v ffmpeg >/dev/null") != 0) GTEST_SKIP() << "the program ffmpeg is not installed";
    const Outcome made = shell("ffmpeg -v error -f lavfi -i testsrc2=size=64x36:rate=24 -frames:v 12 " + arguments);
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  int pipe_ = -1;
};

TEST_F(Stall, APipeWhoseWriterHangsIsGivenUp) {
  put_frames(2);
  RunOptions options;
  options.environment[kTimeout] = "0.2";
  const Outcome outcome = shell("\"$AFTERGLOW\" run look.lua - -o out.####.exr < pipe", options);
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("-: error: has given no bytes for 0.2 s (AFTERGLOW_INPUT_TIMEOUT says"));
  EXPECT_TRUE(fs::exists(path("out.0002.exr"))) << "what came before is written";
  EXPECT_FALSE(fs::exists(path("out.0003.exr")));
  expect_nothing_left_over();
}

TEST_F(Stall, NothingAtAllIsGivenUpToo) {
  RunOptions options;
  options.environment[kTimeout] = "0.2";
  for (const char* raw : {"", " --raw 64x36:rgb24"}) {
    const Outcome outcome = shell(std::string("\"$AFTERGLOW\" run look.lua -") + raw + " -o out.exr < pipe", options);
    EXPECT_EQ(outcome.exit_code, kFiles);
    EXPECT_THAT(outcome.err, HasSubstr("-: error: has given no bytes for 0.2 s"));
  }
  put_frames(0);
  const Outcome half = shell("\"$AFTERGLOW\" run look.lua - -o out.exr < pipe", options);
  EXPECT_EQ(half.exit_code, kFiles);
  EXPECT_THAT(half.err, HasSubstr("-: error: has given no bytes for 0.2 s"));
  EXPECT_FALSE(fs::exists(path("out.exr")));
}

TEST_F(Stall, CtrlCIsHeardWhileAPipeIsWaitedFor) {
  put_frames(5);
  RunOptions options;
  options.environment[kTimeout] = "0";
  options.meanwhile = [&](int process) {
    // By then all frames that came are read, and the next one is what is waited for.
    return is_drained() && fs::exists(path("out.0004.exr")) && kill(process, SIGINT) == 0;
  };
  const Outcome outcome = shell("exec \"$AFTERGLOW\" run look.lua - -o out.####.exr < pipe", options);
  EXPECT_EQ(outcome.exit_code, kInterrupted);
  EXPECT_THAT(outcome.err, HasSubstr("error: interrupted after "));
  expect_nothing_left_over();
}

TEST_F(Stall, AVideoOfAStreamThatWasGivenUpByHandDoesNotAppear) {
  put_frames(5);
  RunOptions options;
  options.environment[kTimeout] = "0";
  // Until all that came is done: it takes no more of the processor's time.
  std::string spent;
  int looks = 0;
  options.meanwhile = [&](int process) {
    const std::string now = time_of(process);
    looks = is_drained() && now == spent ? looks + 1 : 0;
    spent = now;
    return looks == 30 && kill(process, SIGTERM) == 0;
  };
  const Outcome outcome = shell("exec \"$AFTERGLOW\" run look.lua - -o out.mkv --codec ffv1 < pipe", options);
  EXPECT_EQ(outcome.exit_code, kInterrupted);
  EXPECT_FALSE(fs::exists(path("out.mkv")));
  expect_nothing_left_over();
}

TEST_F(Stall, AFileWhoseReadsDoNotComeBackIsGivenUp) {
  make_clip("-c:v ffv1 -y in.mkv");
  const Fault fault = file_fault("stall", path("in.mkv"));
  const std::vector<std::string> command{"run", "look.lua", "in.mkv", "-o", "out.####.exr"};
  const long last = places(command, fault);
  for (const auto& name : files())
    if (name.starts_with("out.")) fs::remove(path(name));
  environment_[kTimeout] = "0.2";
  const Outcome outcome = run_with(command, fault, last);
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("in.mkv: error: "));
  EXPECT_THAT(outcome.err, HasSubstr("has given no bytes for 0.2 s"));
  expect_nothing_left_over();
}

TEST_F(Stall, SoundWhoseReadsDoNotComeBackIsGivenUp) {
  if (std::system("command -v ffmpeg >/dev/null") != 0) GTEST_SKIP() << "the program ffmpeg is not installed";
  // Long enough to be read while frames are written.
  ASSERT_EQ(
      shell("ffmpeg -v error -f lavfi -i sine=duration=8:sample_rate=48000 -c:a pcm_f32le -y sound.wav").exit_code, 0);
  make_exr("in.0001.exr");
  const Fault fault = file_fault("stall", path("sound.wav"));
  const std::vector<std::string> command{"run",  "look.lua", "in.0001.exr", "-o",    "out.mkv", "--codec",
                                         "ffv1", "--audio",  "sound.wav",   "--fps", "1"};
  const long last = places(command, fault);
  environment_[kTimeout] = "0.2";
  for (const long place : {1L, last}) {
    fs::remove(path("out.mkv"));
    const Outcome outcome = run_with(command, fault, place);
    EXPECT_EQ(outcome.exit_code, kFiles) << place;
    EXPECT_THAT(outcome.err, HasSubstr("sound.wav: error: has given no bytes for 0.2 s"));
    EXPECT_FALSE(fs::exists(path("out.mkv")));
    expect_nothing_left_over();
  }
}

TEST_F(Stall, AFileThatNeverEndsIsGivenUp) {
  make_clip("-c:v libx264 -pix_fmt yuv420p -f mpegts -y in.ts");
  // Packets of nothing, behind the pictures: what is left of it when it comes again and again.
  std::string nothing = "\x47\x1f\xff\x10";
  nothing.resize(188, '\xff');
  write("in.ts", read("in.ts") + nothing + nothing);
  const Outcome outcome =
      run_with({"run", "look.lua", "in.ts", "-o", "out.####.exr"}, file_fault("circle", path("in.ts")), 0);
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("in.ts: error: has no frame within 64 MiB that were read"));
}

TEST_F(Stall, ATimeThatIsNoneIsRefused) {
  put_frames(1);
  RunOptions options;
  options.environment[kTimeout] = "soon";
  const Outcome outcome = shell("\"$AFTERGLOW\" run look.lua - -o out.####.exr < pipe", options);
  EXPECT_EQ(outcome.exit_code, kUsage);
  EXPECT_THAT(outcome.err, HasSubstr("AFTERGLOW_INPUT_TIMEOUT: error: 'soon' is no number of seconds"));
}

}  // namespace
}  // namespace afterglow::test
