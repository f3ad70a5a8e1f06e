// SPDX-License-Identifier: MIT
// stress as users run it: the library stands it, a broken effect does not, and what is kept can be run again.
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class Stress : public CliTest {
 protected:
  /// The scaffold's effect, with another formula.
  void make_effect(const std::string& formula) {
    if (!fs::exists(path("effects/haze.lua"))) {
      ASSERT_EQ(run({"new", "effect", "haze"}).exit_code, kDone);
    }
    write("shaders/haze/haze.glsl",
          "uniform float strength;\nuniform vec3 tint;\nvec4 apply(vec4 color) { return " + formula + "; }\n");
  }
  Outcome stress(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "stress");
    RunOptions options;
    options.limit = std::chrono::seconds(550);  // on a machine that has more to do
    return run(arguments, options);
  }
};

constexpr const char* kGood = "vec4(mix(color.rgb, tint, strength), color.a)";
constexpr const char* kBroken =
    "vec4(color.r > 3.0 ? sqrt(tint - color.rgb) : mix(color.rgb, tint, strength), color.a)";

TEST_F(Stress, WhatCannotBeRepeatedIsRefusedBeforeTheSoak) {
  EXPECT_EQ(stress({"--repeat", ""}).exit_code, kFiles) << "a script whose variable is empty";
  EXPECT_EQ(stress({"--for", ""}).exit_code, kUsage);
  const Outcome latin = stress({"--effect", "posterize", "--cases", "1", "--out", "x\xff"});
  EXPECT_EQ(latin.exit_code, kUsage);
  EXPECT_THAT(latin.err, HasSubstr("names must be UTF-8"));
}

TEST_F(Stress, AReportOnStandardOutputIsAlone) {
  const Outcome outcome = stress({"--effect", "posterize", "--cases", "5", "--report", "-"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_TRUE(nlohmann::json::accept(outcome.out)) << outcome.out;
  EXPECT_THAT(outcome.err, HasSubstr("black stays black")) << "the table";
}

TEST_F(Stress, TheLibraryStandsTheShortForm) {
  const Outcome outcome = stress({"--short", "--report", "report.json"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.out << outcome.err;
  const auto report = nlohmann::json::parse(read("report.json"));
  EXPECT_EQ(report["failures"], 0);
  EXPECT_GE(report["cases"], 1000);
  EXPECT_EQ(report["seed"], 1);
  EXPECT_GT(report["subjects"].size(), 25u);
  for (const auto& process : report["processes"]) {
    EXPECT_GT(process["compared"], 5);
    EXPECT_TRUE(process["different"].empty()) << process;
  }
  EXPECT_FALSE(report["error_growth"].empty());
  EXPECT_FALSE(fs::exists(path("stress")));
}

TEST_F(Stress, WhatFailsIsKeptAndRunAgain) {
  make_effect(kBroken);
  const Outcome outcome = stress({"--effect", "haze", "--path", ".", "--cases", "60", "--seed", "4", "-o", "found"});
  EXPECT_EQ(outcome.exit_code, kOther);
  EXPECT_THAT(outcome.err, HasSubstr("afterglow stress: error: "));
  EXPECT_THAT(outcome.err, HasSubstr("cases failed (seed 4)"));
  EXPECT_THAT(outcome.out, HasSubstr("haze: finite: image haze"));
  fs::path kept;
  for (const auto& entry : fs::directory_iterator(path("found/seed-4")))
    if (entry.path().filename().string().starts_with("haze-finite-")) kept = entry.path();
  ASSERT_FALSE(kept.empty()) << outcome.out;
  const Outcome again = stress({"--repeat", kept.string()});
  EXPECT_EQ(again.exit_code, kOther);
  EXPECT_THAT(again.err, HasSubstr("finite: image haze"));
  // The command that the folder names makes the picture too.
  EXPECT_EQ(run({"run", (kept / "preset.lua").string(), (kept / "input.exr").string(), "--path", ".", "-o", "out.exr"})
                .exit_code,
            kDone);
  make_effect(kGood);
  const Outcome mended = stress({"--repeat", kept.string()});
  EXPECT_EQ(mended.exit_code, kDone) << mended.err;
  EXPECT_THAT(mended.out, HasSubstr("finite: holds"));
  make_effect("this is no Lua");
  EXPECT_EQ(stress({"--repeat", kept.string()}).exit_code, kScript) << "what cannot be made holds nothing";
}

TEST_F(Stress, OneTrialByItsNumber) {
  make_effect(kBroken);
  const Outcome outcome = stress({"--effect", "haze", "--path", ".", "--seed", "4", "--trial", "3", "-o", "found"});
  EXPECT_EQ(outcome.exit_code, kOther);
  EXPECT_THAT(outcome.out, HasSubstr(" cases in 1 trials, "));
  int kept = 0;
  for (const auto& entry : fs::directory_iterator(path("found/seed-4"))) {
    EXPECT_THAT(entry.path().filename().string(), ContainsRegex("^haze-[a-z_0-9]+-3-"));
    ++kept;
  }
  EXPECT_GT(kept, 0);
}

TEST_F(Stress, TheScaffoldKeepsWhatItPromises) {
  make_effect(kGood);
  EXPECT_THAT(run({"effects", "haze", "--path", "."}).out, HasSubstr("holds: constant (within 1e-05)"));
  const Outcome outcome = stress({"--effect", "haze", "--path", ".", "--cases", "150"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.out;
  EXPECT_THAT(outcome.out, ContainsRegex("turn_90 +[1-9]"));
}

TEST_F(Stress, PresetsWhole) {
  const Outcome outcome = stress({preset("neon_night.lua").string(), "--cases", "30"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.out << outcome.err;
}

TEST_F(Stress, InterruptedItTellsWhatThereIs) {
  make_effect(kBroken);
  RunOptions options;
  options.meanwhile = [&](int process) { return fs::exists(path("found/seed-1")) && kill(process, SIGINT) == 0; };
  const Outcome outcome = run(
      {"stress", "--effect", "haze", "--path", ".", "--for", "1h", "-o", "found", "--report", "report.json"}, options);
  EXPECT_EQ(outcome.exit_code, kInterrupted) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("[1-9][0-9]* cases in [1-9][0-9]* trials, [1-9]"));
  EXPECT_EQ(nlohmann::json::parse(read("report.json"))["interrupted"], true);
}

TEST_F(Stress, BadArguments) {
  const auto error = [&](const std::vector<std::string>& arguments) {
    const Outcome outcome = stress(arguments);
    EXPECT_EQ(outcome.exit_code, kUsage) << outcome.err;
    EXPECT_TRUE(is_one_error_line(outcome.err));
    return outcome.err;
  };
  EXPECT_THAT(error({"--effect", "blom"}), HasSubstr("unknown effect 'blom'"));
  EXPECT_THAT(error({"--effect", "blom"}), HasSubstr("did you mean 'bloom'?"));
  EXPECT_THAT(error({"--for", "soon"}), HasSubstr("'soon' is no duration; allowed: 30s, 10m, 2h"));
  EXPECT_THAT(error({"--for", "-3m"}), HasSubstr("is no duration"));
  EXPECT_THAT(error({"--seed", "x"}), HasSubstr("--seed"));
  EXPECT_THAT(error({"--trial", "last"}), HasSubstr("--trial"));
  EXPECT_THAT(error({"--cases", "0"}), HasSubstr("--cases"));
  EXPECT_THAT(error({"--sed", "3"}), HasSubstr("did you mean '--seed'?"));
  const Outcome none = stress({"--repeat", "nowhere"});
  EXPECT_EQ(none.exit_code, kFiles);
  EXPECT_THAT(none.err, HasSubstr("nowhere/case.json"));
  EXPECT_EQ(stress({"missing.lua"}).exit_code, kScript);
  const std::string list = stress({"--list"}).out;
  EXPECT_THAT(list, HasSubstr("same_ways"));
  EXPECT_THAT(list, HasSubstr("processes"));
}

}  // namespace
}  // namespace afterglow::test
