// SPDX-License-Identifier: MIT
// Signals, closed pipes, full devices and named pipes: what ends the program, what does not, and what is left behind.
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class Streams : public CliTest {
 protected:
  /// A command line of the shell; $AFTERGLOW is the program.
  Outcome shell(const std::string& command) const {
    RunOptions options;
    options.program = "/bin/sh";
    options.environment["AFTERGLOW"] = AFTERGLOW_PROGRAM;
    return run({"-c", command}, options);
  }
  bool has_temporaries() const {
    for (const auto& name : files())
      if (name.find(".tmp") != std::string::npos) return true;
    return false;
  }
};

TEST_F(Streams, MessagesThatNobodyReadsStopNoFrame) {
  make_preset("look.lua");
  for (int frame = 1; frame <= 3; ++frame) make_exr("in/a.000" + std::to_string(frame) + ".exr");
  // The reader is gone before the program begins to write.
  const Outcome outcome =
      shell("{ \"$AFTERGLOW\" run look.lua in/a.####.exr -o out.####.png -v --stats 2>&1; echo $? > code; } | true");
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_EQ(read("code"), "0\n");
  for (const char* name : {"out.0001.png", "out.0002.png", "out.0003.png"}) EXPECT_TRUE(fs::exists(path(name))) << name;
}

TEST_F(Streams, OutputThatCannotBeWrittenIsAnError) {
  make_preset("look.lua");
  make_exr("a.exr");
  for (const std::string command : {"effects", "effects --json", "graph look.lua --format json", "check look.lua",
                                    "--help", "--version", "run look.lua a.exr -o a.png --stats"}) {
    const Outcome outcome = shell("\"$AFTERGLOW\" " + command + " > /dev/full");
    EXPECT_EQ(outcome.exit_code, kFiles) << command;
    EXPECT_TRUE(is_one_error_line(outcome.err)) << command << ": " << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("standard output: error: cannot be written"));
  }
  EXPECT_TRUE(fs::exists(path("a.png"))) << "the picture was made";
}

TEST_F(Streams, AReaderThatHasEnoughIsNoError) {
  ASSERT_EQ(mkfifo(text("gone").c_str(), 0600), 0);
  for (const std::string words : {"effects --markdown", "run --help", "--version"}) {
    const Outcome outcome =
        shell("{ read line < gone; \"$AFTERGLOW\" " + words + "; echo $? > code; } | { exec <&-; echo > gone; }");
    EXPECT_EQ(outcome.exit_code, kDone) << words;
    EXPECT_THAT(outcome.err, IsEmpty()) << words;
    EXPECT_EQ(read("code"), "0\n") << words;
  }
}

TEST_F(Streams, NamedPipesAreNoFiles) {
  ASSERT_EQ(mkfifo(text("pipe.lua").c_str(), 0600), 0);
  ASSERT_EQ(mkfifo(text("pipe.exr").c_str(), 0600), 0);
  make_preset("look.lua");
  make_exr("a.exr");
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"check", "pipe.lua"},
                                                    {"run", "look.lua", "pipe.exr", "-o", "o.png"},
                                                    {"run", "look.lua", "a.exr", "--depth", "pipe.exr", "-o", "o.png"},
                                                    {"set", "pipe.lua", "bloom.intensity=1"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, arguments[1] == "look.lua" ? kFiles : kScript) << arguments.front() << outcome.err;
    EXPECT_THAT(outcome.err, ::testing::AnyOf(HasSubstr("is a pipe, not a file"), HasSubstr("is not a regular file")));
  }
}

TEST_F(Streams, CharactersThatTurnTextAreNotPrinted) {
  const std::string turned =
      "a\xE2\x80\xAE"
      "b\xE2\x80\xA8"
      "c\xE2\x81\xA6"
      "d\xE2\x80\x93.lua";
  const Outcome outcome = run({"check", turned});
  EXPECT_TRUE(is_one_error_line(outcome.err));
  EXPECT_THAT(outcome.err, HasSubstr("a b c d\xE2\x80\x93.lua")) << "a dash stays";
  write("name.lua",
        "return require(\"afterglow\").stack { name = \"a\\27[2Jb\\u{202E}c\\u{61C}d\", "
        "require(\"afterglow\").tone_mapping {} }\n");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"check", "name.lua"}, {"explain", "name.lua"}, {"graph", "name.lua"}}) {
    const Outcome named = run(arguments);
    EXPECT_EQ(named.exit_code, kDone) << named.err;
    EXPECT_THAT(named.out, HasSubstr("a [2Jb c d")) << arguments[0];
  }
}

TEST_F(Streams, FilesThatLookLikeOptionsAreNamed) {
  make_preset("look.lua");
  make_exr("-a.exr");
  const Outcome outcome = run({"run", "look.lua", "-a.exr", "-o", "o.png"});
  EXPECT_EQ(outcome.exit_code, kUsage);
  EXPECT_THAT(outcome.err, HasSubstr("'-a.exr' is read as an option; name the file ./-a.exr"));
  EXPECT_EQ(run({"run", "look.lua", "./-a.exr", "-o", "o.png"}).exit_code, kDone);
}

/// Each as files hold them, one behind the other: none is dropped without a word.
TEST_F(Streams, SeveralPicturesOnStandardInput) {
  make_preset("look.lua");
  make_exr("a.exr", 64, 48);
  for (const std::string format : {"png", "exr", "tif", "dpx", "hdr", "cin", "webp"}) {
    ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", "one." + format}).exit_code, kDone) << format;
    EXPECT_EQ(shell("\"$AFTERGLOW\" run look.lua - -o alone.png <one." + format).exit_code, kDone) << format;
    const Outcome outcome =
        shell("cat one." + format + " one." + format + " | \"$AFTERGLOW\" run look.lua - -o out.####.png");
    EXPECT_EQ(outcome.exit_code, kFiles) << format;
    EXPECT_TRUE(is_one_error_line(outcome.err)) << format << ": " << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("s; frames come as PPM, PAM, PFM, Y4M, JPEG or a video")) << format;
  }
}

TEST_F(Streams, JpegsOnStandardInputAreFrames) {
  if (shell("command -v ffmpeg >/dev/null").exit_code != 0) GTEST_SKIP() << "the program ffmpeg is not installed";
  make_preset("look.lua");
  const auto frames = [&](const std::string& command, const std::string& name) {
    const Outcome outcome = shell(command + " | \"$AFTERGLOW\" run look.lua - -o " + name + ".##.png");
    if (outcome.exit_code == kDone)
      EXPECT_EQ(outcome.err, "");
    else
      EXPECT_THAT(outcome.err, HasSubstr("frame 10 is cut off"));
    int count = 0;
    while (fs::exists(path(name + (count < 9 ? ".0" : ".") + std::to_string(count + 1) + ".png"))) ++count;
    return count;
  };
  const std::string made = "ffmpeg -v error -f lavfi -i testsrc=size=64x48:rate=25:d=0.4 -f image2pipe -c:v mjpeg ";
  EXPECT_EQ(frames(made + "-", "small"), 10);
  ASSERT_EQ(shell(made + "-y all.mjpeg").exit_code, 0);
  EXPECT_EQ(frames("head -c -100 all.mjpeg", "cut"), 9);
  EXPECT_NE(read("small.01.png"), read("small.10.png"));
  EXPECT_EQ(read("small.09.png"), read("cut.09.png"));
}

class Signals : public Streams, public ::testing::WithParamInterface<int> {};

TEST_P(Signals, EndASequenceAndLeaveNothingHalfWritten) {
  make_preset("look.lua");
  for (int frame = 1; frame <= 60; ++frame) make_exr("in/a." + std::to_string(1000 + frame) + ".exr", 320, 180);
  RunOptions options;
  options.meanwhile = [&](int process) { return fs::exists(path("out.1002.exr")) && kill(process, GetParam()) == 0; };
  const Outcome outcome = run({"run", "look.lua", "in/a.####.exr", "-o", "out.####.exr"}, options);
  EXPECT_EQ(outcome.exit_code, kInterrupted);
  EXPECT_THAT(outcome.err, HasSubstr("interrupted"));
  EXPECT_FALSE(has_temporaries());
  EXPECT_FALSE(fs::exists(path("out.1060.exr")));
}

TEST_P(Signals, StayIgnoredWhereTheParentIgnoresThem) {
  make_preset("look.lua");
  for (int frame = 1; frame <= 20; ++frame) make_exr("in/a." + std::to_string(1000 + frame) + ".exr");
  RunOptions options{.ignored = GetParam()};
  options.meanwhile = [&](int process) { return fs::exists(path("out.1002.exr")) && kill(process, GetParam()) == 0; };
  const Outcome outcome = run({"run", "look.lua", "in/a.####.exr", "-o", "out.####.exr"}, options);
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_TRUE(fs::exists(path("out.1020.exr")));
}

/// A driver that draws or compiles for minutes.
TEST_P(Signals, EndWhatDoesNotListen) {
  write("shaders/slow/apply.glsl",
        "vec4 apply(vec4 color) {\n  float s = color.r;\n"
        "  for (int i = 0; i < 4000; ++i) s = sin(s * 1.7 + cos(s * float(i)) + exp(-s * s));\n"
        "  return vec4(s, s, s, color.a);\n}\n");
  write("effects/slow.lua",
        "local fx = require \"afterglow\"\nreturn fx.effect { name = \"slow\", settings = {}, build = function(g, s, "
        "source)\n  return g:pass { shader = \"slow/apply\", source = source }\nend }\n");
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.slow {} }\n");
  make_exr("a.exr", 4096, 2304);
  RunOptions options;
  // Two seconds of the processor's time: it is drawing by then, or about to.
  options.meanwhile = [&](int process) {
    std::string stat;
    std::getline(std::ifstream("/proc/" + std::to_string(process) + "/stat"), stat);
    std::istringstream words(stat.substr(stat.rfind(')') + 1));
    std::string word;
    for (int field = 3; field <= 14 && words >> word; ++field) continue;
    return std::atol(word.c_str()) > 2 * sysconf(_SC_CLK_TCK) && kill(process, GetParam()) == 0;
  };
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "o.exr"}, options);
  EXPECT_EQ(outcome.exit_code, kInterrupted);
  EXPECT_THAT(outcome.err, HasSubstr("interrupted"));
  EXPECT_FALSE(fs::exists(path("o.exr")));
  EXPECT_FALSE(has_temporaries());
}

INSTANTIATE_TEST_SUITE_P(Cli, Signals, ::testing::Values(SIGINT, SIGTERM, SIGHUP, SIGXCPU),
                         [](const auto& info) { return "signal" + std::to_string(info.param); });

}  // namespace
}  // namespace afterglow::test
