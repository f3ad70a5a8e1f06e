// SPDX-License-Identifier: MIT
// What shells and `man` know of the program, and --version.
#include <regex>
#include <sstream>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class Completions : public CliTest {
 protected:
  std::string print(const std::vector<std::string>& arguments) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return outcome.out;
  }
  /// Long options of a command, as its help lists them.
  std::vector<std::string> options_of(const std::string& command) const {
    std::vector<std::string> out;
    std::istringstream lines(print({command, "--help"}));
    static const std::regex kOption("^  (?:-\\w,)?(--[a-z0-9-]+).*");
    for (std::string line; std::getline(lines, line);)
      if (std::smatch found; std::regex_match(line, found, kOption)) out.push_back(found[1]);
    return out;
  }
  std::vector<std::string> commands() const {
    std::vector<std::string> out;
    const std::string page = print({"man"});
    static const std::regex kReference("\\.BR afterglow\\\\-([a-z]+) ");
    for (std::sregex_iterator it(page.begin(), page.end(), kReference), end; it != end; ++it) out.push_back((*it)[1]);
    return out;
  }
  /// What bash offers for the last of these words.
  std::vector<std::string> offered(const std::string& words) const {
    write("offer.sh", "afterglow() { " AFTERGLOW_PROGRAM " \"$@\"; }\nsource completion.bash\nCOMP_WORDS=(afterglow " +
                          words +
                          ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_afterglow\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
    RunOptions options;
    options.program = "/bin/bash";
    const Outcome outcome = run({"offer.sh"}, options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    std::vector<std::string> out;
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);)
      if (!line.empty()) out.push_back(line);
    return out;
  }
};

TEST_F(Completions, EveryOptionOfEveryCommandIsInAllOfThem) {
  const std::string bash = print({"completion", "bash"}), zsh = print({"completion", "zsh"}),
                    fish = print({"completion", "fish"});
  ASSERT_GT(commands().size(), 12u);
  int options = 0;
  for (const std::string& command : commands()) {
    const std::string page = print({"man", command});
    EXPECT_THAT(page, HasSubstr(".SH SYNOPSIS\n\\fBafterglow " + command + "\\fR"));
    for (const std::string& option : options_of(command)) {
      ++options;
      std::string escaped = std::regex_replace(option, std::regex("-"), "\\-");
      EXPECT_THAT(page, HasSubstr("\\fB" + escaped + "\\fR")) << command;
      EXPECT_THAT(zsh, HasSubstr("'*" + option + "[")) << command;
      EXPECT_THAT(fish, HasSubstr("-l " + option.substr(2))) << command;
      EXPECT_THAT(bash, HasSubstr(option)) << command;
    }
  }
  EXPECT_GT(options, 100);
}

TEST_F(Completions, BashOffersCommandsOptionsAndValues) {
  write("completion.bash", print({"completion", "bash"}));
  EXPECT_THAT(offered("gra"), testing::ElementsAre("graph"));
  EXPECT_THAT(offered("graph --ban"), testing::ElementsAre("--bandwidth"));
  EXPECT_THAT(offered("graph --format s"), testing::ElementsAre("svg"));
  EXPECT_THAT(offered("run --nan-policy neigh"), testing::ElementsAre("neighbour"));
  fs::create_directories(path("folder"));
  write("folder.lua", "");
  EXPECT_THAT(offered("run --path fol"), testing::ElementsAre("folder"));
  fs::create_directories(path("my looks"));
  EXPECT_THAT(offered("run --path my"), testing::ElementsAre("my looks"));
  EXPECT_THAT(offered("run look.lua look"), IsEmpty()) << "files are the shell's own";
  EXPECT_THAT(offered("run --codec prores4"), testing::ElementsAre("prores4444"));
  EXPECT_THAT(offered("run --compression pxr"), testing::ElementsAre("pxr24"));
  EXPECT_THAT(offered("run --input-space acescg"), testing::ElementsAre("acescg"));
  write("neon_of_mine.lua", "");
  EXPECT_THAT(offered("run neon_n"), testing::ElementsAre("neon_night", "neon_noir"));
  EXPECT_THAT(offered("run neon_o"), testing::ElementsAre("neon_of_mine.lua"));
  EXPECT_THAT(offered("effects vign"), testing::ElementsAre("vignette"));
  EXPECT_THAT(offered("farm ret"), testing::ElementsAre("retry"));
  EXPECT_THAT(offered("completion z"), testing::ElementsAre("zsh"));
  EXPECT_THAT(offered("man expl"), testing::ElementsAre("explain"));
  EXPECT_THAT(offered("effects mask.lu"), testing::ElementsAre("mask.luma"));
  EXPECT_THAT(offered("run --format ti"), testing::ElementsAre("tif", "tiff"));
  for (const char* name : {"look.exr", "run.exr", "zebra.exr", "bloom.exr"}) write(name, "");
  EXPECT_THAT(offered("new lo"), testing::ElementsAre("look")) << "no files where words are meant";
  EXPECT_THAT(offered("man ru"), testing::ElementsAre("run"));
  EXPECT_THAT(offered("completion z"), testing::ElementsAre("zsh"));
  EXPECT_THAT(offered("effects blo"), testing::ElementsAre("bloom"));
}

TEST_F(Completions, BashOffersTheSettingsOfThePresetOnTheLine) {
  write("completion.bash", print({"completion", "bash"}));
  write("own.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.bloom { name = \"glow\" }, fx.exposure {} }\n");
  write("a.exr", "no picture");
  EXPECT_THAT(offered("run own.lua a.exr --set expo"),
              testing::ElementsAre("exposure.ev=", "exposure.at=", "exposure.blend=", "exposure.enabled=",
                                   "exposure.mask=", "exposure.opacity=", "exposure.order="));
  EXPECT_THAT(offered("run -i a.exr own.lua --set glow.thr"), testing::ElementsAre("glow.threshold="));
  EXPECT_THAT(offered("run own.lua --set bloom.thr"), IsEmpty()) << "it has no such entry";
  EXPECT_THAT(offered("play neon_night --set tone_mapping.enab"), testing::ElementsAre("tone_mapping.enabled="));
  EXPECT_THAT(offered("run --set bloom.thr"), testing::ElementsAre("bloom.threshold=")) << "of all effects";
  write("broken.lua", "return {");
  EXPECT_THAT(offered("run broken.lua --set bloom.thr"), testing::ElementsAre("bloom.threshold="));
  EXPECT_THAT(print({"completion", "zsh"}), HasSubstr(":EFFECT.SETTING=VALUE:_afterglow_settings'"));
  EXPECT_THAT(print({"completion", "fish"}), HasSubstr(" -l set -x -a '(__afterglow_settings)'"));
}

TEST_F(Completions, UnknownShellsAndCommandsAreRefused) {
  EXPECT_EQ(run({"completion", "tcsh"}).exit_code, kUsage);
  const Outcome outcome = run({"man", "chek"});
  EXPECT_EQ(outcome.exit_code, kUsage);
  EXPECT_THAT(outcome.err, HasSubstr("there is no command 'chek'; allowed: run, "));
  EXPECT_THAT(outcome.err, HasSubstr("did you mean 'check'?"));
}

TEST_F(Completions, TheVersionNamesTheCommit) {
  const std::string version = print({"--version"});
  EXPECT_TRUE(
      std::regex_match(version, std::regex("afterglow 0\\.2\\.[0-9]+( \\(commit [0-9a-f]{12}(\\+changes)?\\))?\n?")))
      << version;
}

/// `graph --traffic`: tables and JSON that agree with each other.
TEST_F(Completions, TrafficIsToldAndTimed) {
  const std::string look = preset("neon_night.lua").string();
  const std::string text = print({"graph", look, "--traffic", "--bandwidth", "100"});
  EXPECT_THAT(text, HasSubstr("fused fp16 compute"));
  EXPECT_THAT(text, HasSubstr("ms at 100 GB/s"));
  EXPECT_THAT(text, HasSubstr("bloom.horizontal[0]"));
  EXPECT_THAT(print({"graph", look, "--traffic", "--format", "json"}), HasSubstr("\"unavoidable_bytes\": 66355200"));
  EXPECT_EQ(run({"graph", look, "--traffic", "--format", "svg"}).exit_code, kUsage);
  EXPECT_EQ(run({"graph", look, "--bandwidth", "100"}).exit_code, kUsage);
  EXPECT_EQ(run({"graph", look, "--traffic", "--region", "no"}).exit_code, kUsage);
}

}  // namespace
}  // namespace afterglow::test
