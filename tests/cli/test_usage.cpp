// SPDX-License-Identifier: MIT
// Exit code 2, help, and the one line that says what was wrong.
#include "cli_test.h"

namespace afterglow::test {
namespace {

struct WrongUse {
  std::string label;
  std::vector<std::string> arguments;
  std::string message;  ///< part of the line
};

void PrintTo(const WrongUse& use, std::ostream* out) { *out << use.label; }

class WrongUsage : public CliTest, public ::testing::WithParamInterface<WrongUse> {};

TEST_P(WrongUsage, IsOneLineAndExitCode2) {
  make_exr("a.exr");
  make_exr("b.exr");
  make_preset("look.lua");
  const auto before = files();
  const Outcome outcome = run(GetParam().arguments);
  EXPECT_EQ(outcome.exit_code, kUsage);
  EXPECT_TRUE(is_one_error_line(outcome.err));
  EXPECT_THAT(outcome.err, HasSubstr(GetParam().message));
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_EQ(files(), before) << "something was left behind";
}

INSTANTIATE_TEST_SUITE_P(
    Cli, WrongUsage,
    ::testing::Values(
        WrongUse{"command", {"rnu", "look.lua"}, "unknown command 'rnu'"},
        WrongUse{"command_nearest", {"chekc"}, "did you mean 'check'?"},
        WrongUse{
            "option", {"run", "look.lua", "a.exr", "-o", "a.png", "--pecision", "fp16"}, "did you mean '--precision'?"},
        WrongUse{"option_first", {"run", "--pecision", "fp16", "look.lua", "a.exr"}, "unknown option '--pecision'"},
        WrongUse{"option_of_nothing_near", {"check", "look.lua", "--qwertyuiop"}, "unknown option '--qwertyuiop'"},
        WrongUse{"no_output", {"run", "look.lua", "a.exr"}, "--output"},
        WrongUse{"lock_on_output", {"run", "look.lua", "a.exr", "-o", "a.png", "--lock", "-"}, "'-' is none"},
        WrongUse{"no_input", {"run", "look.lua", "-o", "a.png"}, "INPUT"}, WrongUse{"no_preset", {"check"}, "PRESET"},
        WrongUse{"too_much", {"devices", "a.exr"}, "unexpected argument 'a.exr'"},
        WrongUse{"precision", {"run", "look.lua", "a.exr", "-o", "a.png", "--precision", "fp8"}, "fp8"},
        WrongUse{"type", {"run", "look.lua", "a.exr", "-o", "a.png", "--type", "int"}, "int"},
        WrongUse{"png_level", {"run", "look.lua", "a.exr", "-o", "a.png", "--png-level", "10"}, "10"},
        WrongUse{"png_level_of_jpeg",
                 {"run", "look.lua", "a.exr", "-o", "a.jpg", "--png-level", "6"},
                 "a.jpg: error: --png-level is for PNG files; allowed: .png"},
        WrongUse{"quality_of_png",
                 {"run", "look.lua", "a.exr", "-o", "a.png", "--jpeg-quality", "90"},
                 "a.png: error: --jpeg-quality is for JPEG files; allowed: .jpg"},
        WrongUse{"max_error", {"run", "look.lua", "a.exr", "-o", "a.png", "--max-error", "-1"}, "--max-error"},
        WrongUse{"max_memory",
                 {"run", "look.lua", "a.exr", "-o", "a.png", "--max-memory", "lots"},
                 "'lots' is no amount of memory"},
        WrongUse{"fast", {"run", "look.lua", "a.exr", "-o", "a.mp4", "--fps", "1e10"}, "0.001 to 1000"},
        WrongUse{"slow", {"check", "look.lua", "--fps", "1e-5"}, "1e-5 is no number of frames a second, 0.001 to 1000"},
        WrongUse{"no_rate", {"check", "look.lua", "--fps", "24000/0"}, "24000/0 is no number of frames a second"},
        WrongUse{"size", {"run", "look.lua", "a.exr", "-o", "a.png", "--size", "6y4"}, "'6y4' is no size"},
        WrongUse{"layers_of_another_size",
                 {"run", "look.lua", "a.exr", "-o", "b2.exr", "--keep-layers", "--size", "32x18"},
                 "cannot go with --size"},
        WrongUse{"stats", {"run", "look.lua", "a.exr", "-o", "a.png", "--stats=all"}, "all"},
        WrongUse{"set_without_value",
                 {"check", "look.lua", "--set", "tone_mapping.mode"},
                 "afterglow check: error: --set 'tone_mapping.mode'"},
        WrongUse{"frames", {"run", "look.lua", "a.####.exr", "-o", "b.####.exr", "--frames", "1-"}, "1-"},
        WrongUse{"frames_of_a_file",
                 {"run", "look.lua", "a.exr", "-o", "a.png", "--frames", "1"},
                 "--frames needs a numbered input"},
        WrongUse{"several_into_one",
                 {"run", "look.lua", "a.exr", "b.exr", "-o", "c.png"},
                 "afterglow run: error: 2 frames cannot go into the one file c.png"},
        WrongUse{"over_the_input", {"run", "look.lua", "a.exr", "-o", "a.exr"}, "overwritten by its own result"},
        WrongUse{"two_places", {"run", "look.lua", "a.##.##.exr", "-o", "a.png"}, "a.##.##.exr"},
        WrongUse{"graph_format", {"graph", "look.lua", "-o", "graph.pdf"}, "graph.pdf"},
        WrongUse{"effect_of_a_folder", {"effects", "mine"}, "; effects of yours with --path FOLDER"},
        WrongUse{"effect", {"effects", "blom"}, "did you mean 'bloom'?"}),
    [](const auto& info) { return info.param.label; });

class Help : public CliTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(Help, IsOnStandardOutput) {
  const Outcome outcome = run({GetParam(), "--help"});
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_THAT(outcome.out, HasSubstr(GetParam()));
  EXPECT_THAT(outcome.out, HasSubstr("--no-color"));
  EXPECT_THAT(outcome.err, IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Cli, Help, ::testing::Values("run", "check", "graph", "effects", "devices"),
                         [](const auto& info) { return std::string(info.param); });

class Usage : public CliTest {};

TEST_F(Usage, HelpOfTheProgramNamesEveryCommandAndExitCode) {
  const Outcome outcome = run({"--help"});
  EXPECT_EQ(outcome.exit_code, kDone);
  for (const char* word : {"run", "check", "graph", "effects", "devices", "Exit codes", "AFTERGLOW_HOME"})
    EXPECT_THAT(outcome.out, HasSubstr(word));
}

TEST_F(Usage, NoArgumentsShowTheHelpAsAnError) {
  const Outcome outcome = run({});
  EXPECT_EQ(outcome.exit_code, kUsage);
  EXPECT_THAT(outcome.err, HasSubstr("Usage"));
  EXPECT_THAT(outcome.out, IsEmpty());
}

TEST_F(Usage, VersionIsOneLine) {
  const Outcome outcome = run({"--version"});
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_THAT(outcome.out, ::testing::MatchesRegex("afterglow [0-9]+\\.[0-9]+\\.[0-9]+[^\n]*\n"));
}

}  // namespace
}  // namespace afterglow::test
