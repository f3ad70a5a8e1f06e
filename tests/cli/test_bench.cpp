// SPDX-License-Identifier: MIT
// bench and calibrate as users run them; runs that take their choice from a calibration.
#include <nlohmann/json.hpp>

#include "cli_test.h"

namespace afterglow::test {
namespace {

using nlohmann::json;
using ::testing::IsSupersetOf;

class Bench : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    make_preset("look.lua");
  }
  /// The smallest bench there is.
  Outcome quick(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"bench", "look.lua", "--quick", "--sizes", "48x27"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  json report(const std::string& name) const { return json::parse(read(name)); }
};

TEST_F(Bench, QuickWritesEveryFile) {
  const Outcome outcome = quick({"-o", "out"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(files(), IsSupersetOf({"out/bench.csv", "out/bench.html", "out/bench.json", "out/front.svg"}));
  EXPECT_THAT(outcome.out, HasSubstr("look 48×27; errors against double precision"));
  EXPECT_THAT(outcome.out, HasSubstr("plain16f"));
  const json all = report("out/bench.json");
  EXPECT_EQ(all.at("repeat"), 3);
  const json& cell = all.at("cells").at(0);
  ASSERT_EQ(cell.at("points").size(), 2u);
  EXPECT_EQ(cell.at("points").at(0).at("choice"), "fused-filters fp16 hardware-filter");
  EXPECT_EQ(cell.at("points").at(1).at("label"), "chosen");
  EXPECT_LT(cell.at("points").at(1).at("error").at("p9999"), 1e-5);
  EXPECT_THAT(read("out/front.svg"), HasSubstr("</svg>"));
  EXPECT_THAT(read("out/bench.html"), HasSubstr("\"afterglow bench 1\""));
}

TEST_F(Bench, VariantsAndVariedSettingsMakeTheMatrix) {
  const Outcome outcome =
      quick({"--variants", "unfused fp32+unshared,chosen", "--vary", "tone_mapping.mode=aces,reinhard,neutral"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  const json points = report("bench/bench.json").at("cells").at(0).at("points");
  ASSERT_EQ(points.size(), 6u);
  EXPECT_EQ(points.at(1).at("settings"), "tone_mapping.mode=reinhard");
  EXPECT_EQ(points.at(1).at("choice"), "unfused fp32 unshared");
}

TEST_F(Bench, ReloadsAreMeasuredOfBothKinds) {
  const Outcome outcome = run({"bench", "look.lua", "--reload", "--quick", "--sizes", "48x27", "-o", "out"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("from the save to the new picture at 48×27"));
  const json all = report("out/reload-look-48x27.json");
  ASSERT_EQ(all.at("edits").size(), 2u);
  for (const std::size_t kind : {0u, 1u}) {
    const json& edits = all.at("edits").at(kind);
    EXPECT_EQ(edits.at("kind"), kind == 0 ? "value" : "shader");
    EXPECT_EQ(edits.at("samples").size(), 3u);
    EXPECT_GT(edits.at("medians").at("script").get<double>(), 0);
    EXPECT_EQ(edits.at("medians").at("shader").get<double>() > 0, kind == 1) << "a value touches no shader";
  }
}

TEST_F(Bench, CompareFailsBeyondTheThresholdAlone) {
  ASSERT_EQ(quick({"-o", "old"}).exit_code, kDone);
  const Outcome fine = quick({"-o", "new", "--compare", "old/bench.json", "--threshold", "1e6"});
  EXPECT_EQ(fine.exit_code, kDone) << fine.err;
  EXPECT_THAT(fine.out, HasSubstr("now ÷ before"));
  const Outcome slower = quick({"-o", "new", "--compare", "old/bench.json", "--threshold", "1e-6"});
  EXPECT_EQ(slower.exit_code, kOther);
  EXPECT_TRUE(is_one_error_line(slower.err));
  EXPECT_THAT(slower.err, HasSubstr("2 of 2"));
}

TEST_F(Bench, CompareRefusesWhatIsNoReport) {
  write("old.json", "{}");
  const Outcome outcome = quick({"--compare", "old.json"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_TRUE(is_one_error_line(outcome.err));
}

TEST_F(Bench, MistakesAreSaidBeforeAnythingIsMeasured) {
  write("other/look.lua", read("look.lua"));
  const struct {
    std::vector<std::string> arguments;
    int exit_code;
    const char* says;
  } kCases[] = {
      {{"bench"}, kUsage, "nothing to measure"},
      {{"bench", "look.lua", "--variants", "plain16"}, kUsage, "did you mean 'plain16f'?"},
      {{"bench", "look.lua", "--sizes", "12"}, kUsage, "no size"},
      {{"bench", "look.lua", "--quick", "--vary", "tone_mapping.mode"}, kUsage, "varies nothing"},
      {{"bench", "none.lua", "--quick"}, kScript, "none.lua"},
      {{"bench", "look.lua", "other/look.lua", "--quick"}, kUsage, "reports name looks by their files' names"},
      {{"bench", "look.lua", "--quick", "--calibration", "none.json"}, kFiles, "none.json"},
      {{"bench", "look.lua", "--quick", "--compare", "none.json"}, kFiles, "none.json"},
      {{"bench", "look.lua", "--quick", "--compare", "look.lua"}, kFiles, "is no report of `afterglow bench`"},
      {{"bench", "look.lua", "--quick", "-o", "look.lua/x"}, kFiles, "cannot make the folder"},
      {{"bench", "look.lua", "--temporal", "-o", "look.lua/x"}, kFiles, "cannot make the folder"},
      {{"bench", "look.lua", "--reload", "-o", "look.lua/x"}, kFiles, "cannot make the folder"},
      {{"bench", "look.lua", "--temporal", "--compare", "old.json"}, kUsage, "--compare"},
      {{"bench", "look.lua", "--reload", "--vary", "bloom.intensity=1"}, kUsage, "--vary"},
      {{"bench", "--goals", "none.json"}, kFiles, "none.json"}};
  for (const auto& c : kCases) {
    const Outcome outcome = run(c.arguments);
    EXPECT_EQ(outcome.exit_code, c.exit_code) << c.says << outcome.err;
    EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(c.says));
  }
  EXPECT_FALSE(fs::exists(path("bench")));
}

TEST_F(Bench, GoalsAreMeasuredAndStored) {
  write("goals.json", R"({"goals": [
    {"name": "ratio", "sizes": ["32x18"], "over": [{"look": "look.lua", "choice": "plain16f"}, {"look": "look.lua", "frame": true}, {"look": "look.lua", "display": true}],
     "under": [{"copy": true}], "at_least": 1e-9, "repeat": 2},
    {"name": "command", "sizes": ["32x18"], "command": {"look": "look.lua", "frames": 2, "cold": true}, "at_most": 1e9, "repeat": 1},
    {"name": "check", "sizes": ["32x18"], "command": {"look": "look.lua", "check": true}, "at_most": 1e9, "repeat": 1},
    {"name": "step", "sizes": ["32x18"], "command": {"look": "look.lua", "step": "execute"}, "at_most": 1e9, "repeat": 1},
    {"name": "no step", "sizes": ["32x18"], "command": {"look": "look.lua", "step": "dance"}, "at_most": 1e9, "repeat": 1},
    {"name": "broken", "sizes": ["32x18"], "over": [{"look": "none.lua"}], "under": [{"copy": true}], "at_most": 1}]})");
  const Outcome outcome = run({"bench", "--goals", "goals.json", "-o", "out"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  const json goals = report("out/bench.json").at("goals");
  ASSERT_EQ(goals.size(), 6u);
  EXPECT_GT(goals.at(0).at("measured"), 0);
  EXPECT_EQ(goals.at(0).at("reached"), true);
  EXPECT_GT(goals.at(1).at("measured"), 0);
  EXPECT_EQ(goals.at(1).at("unit"), "s");
  EXPECT_GT(goals.at(2).at("measured"), 0);
  EXPECT_GT(goals.at(3).at("measured"), 0);
  EXPECT_TRUE(goals.at(4).at("measured").is_null());
  EXPECT_THAT(goals.at(4).at("note").get<std::string>(), HasSubstr("no step 'dance'"));
  EXPECT_TRUE(goals.at(5).at("measured").is_null());
  EXPECT_THAT(goals.at(5).at("note").get<std::string>(), HasSubstr("none.lua"));
}

TEST_F(Bench, WhatCalibrateWritesRunTakes) {
  Outcome outcome = run({"calibrate", "--look", "look.lua", "--size", "48x27", "--repeat", "1", "-o", "mine.json"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  const json table = json::parse(read("mine.json"));
  const json& device = table.at("devices").at(0);
  EXPECT_TRUE(device.at("measured").at("nanoseconds_per_pixel").contains("copy RGBA32F"));
  const std::string choice = device.at("choices").at(0).at("choice");
  make_exr("a.exr");
  outcome = run({"run", "look.lua", "a.exr", "-o", "a.png", "--calibration", "mine.json", "--max-error", "1e-5",
                 "--report", "r.json"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  const json session = json::parse(read("r.json")).at("session");
  EXPECT_EQ(session.at("choice"), choice);
  EXPECT_THAT(session.at("choice_from").get<std::string>(), HasSubstr("mine.json"));
}

TEST_F(Bench, RunTakesItsChoiceFromATable) {
  make_exr("a.exr");
  write(
      "table.json",
      R"({"devices": [{"choices": [{"max_error": 0, "choice": "unfused fp32"}, {"max_error": 1e-3, "choice": "fused fp16"}]}]})");
  const auto choice = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", "look.lua", "a.exr", "-o", "a.png", "--report", "r.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    const json session = json::parse(read("r.json")).at("session");
    return session.at("choice").get<std::string>() + " | " + session.at("choice_from").get<std::string>();
  };
  EXPECT_EQ(choice({"--calibration", "table.json"}), "fused fp16 | table.json, any device");
  EXPECT_EQ(choice({"--calibration", "table.json", "--max-error", "1e-4"}), "unfused fp32 | table.json, any device");
  EXPECT_EQ(choice({"--calibration", "table.json", "--precision", "fp32"}),
            "fused fp32 | table.json, any device; --precision");
  EXPECT_EQ(choice({"--calibration", "table.json", "--reference"}), "unfused fp32 unshared | --reference");
  EXPECT_THAT(choice({}), HasSubstr("calibration/devices.json"));
  const Outcome devices = run({"devices", "--calibration", "table.json"});
  EXPECT_THAT(devices.out, HasSubstr("fused fp16"));
}

TEST_F(Bench, ABrokenTableIsAnErrorOfTheFile) {
  make_exr("a.exr");
  write("table.json", R"({"devices": [{"choices": [{"max_error": 0, "choice": "fusd"}]}]})");
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "a.png", "--calibration", "table.json"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_TRUE(is_one_error_line(outcome.err));
  EXPECT_THAT(outcome.err, HasSubstr("table.json: error: in entry 1"));
  EXPECT_THAT(outcome.err, HasSubstr("did you mean 'fused'?"));
  EXPECT_FALSE(fs::exists(path("a.png")));
}

}  // namespace
}  // namespace afterglow::test
