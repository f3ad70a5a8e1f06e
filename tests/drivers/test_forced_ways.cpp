// SPDX-License-Identifier: MIT
// AFTERGLOW_FORCE: the ways of other devices on the device at hand. Each makes the picture that the usual way makes,
// within what it promises, and validation has nothing to say.

#include <nlohmann/json.hpp>

#include "cli_test.h"
#include "image/metrics.h"

namespace afterglow::test {
namespace {

using nlohmann::json;

class ForcedWays : public CliTest {
 protected:
  static RunOptions forced(const std::string& words) {
    RunOptions options;
    options.environment = {{"AFTERGLOW_FORCE", words}, {"AFTERGLOW_VALIDATE", "1"}};
    return options;
  }
  /// Runs the same with and without the words; the result must be the same within `error` (0: to the last bit).
  void compare(const std::string& words, double error, std::vector<std::string> arguments,
               const std::string& frame = "") {
    SCOPED_TRACE(words + ": " + arguments[1]);
    const std::string pattern = frame.empty() ? ".exr" : ".####.exr",
                      made = frame.empty() ? ".exr" : "." + frame + ".exr";
    arguments.insert(arguments.end(), {"--type", "float", "--report", "report.json", "-o", "usual" + pattern});
    ASSERT_EQ(run(arguments).exit_code, kDone);
    arguments.back() = "forced" + pattern;
    const Outcome outcome = run(arguments, forced(words));
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    const auto a = pixels_of("forced" + made), b = pixels_of("usual" + made);
    if (error == 0) {
      EXPECT_EQ(a, b);
      return;
    }
    ASSERT_EQ(a.size(), b.size());
    const ErrorMeasure measure = measure_error(a, b);
    EXPECT_TRUE(within(measure, error)) << measure.percentile << ", worst " << measure.worst;
  }
  json report() const { return json::parse(read("report.json")); }
};

struct Way {
  const char* words;
  double error;
};
constexpr Way kWays[] = {
    {"staging", 0}, {"unmapped", 1e-6},        {"timestamps", 0},        {"compute", 2e-5},
    {"fp16", 5e-3}, {"hardware-filter", 5e-2}, {"unmapped,rows1", 1e-6}, {"unmapped timestamps fp16+compute", 5e-3}};

TEST_F(ForcedWays, MakeThePictureOfTheUsualWay) {
  for (const auto& [words, error] : kWays)
    for (const char* look : {"neon_night.lua", "vhs_tape.lua", "plain_aces.lua"})
      compare(words, error, {"run", preset(look).string(), neon().string(), "--size", "320x180"});
}

/// Edges in two channels, brightness in one (smaa): the bits that four hold.
TEST_F(ForcedWays, FewChannelsMakeThePictureOfFour) {
  for (const char* words : {"four-channels", "four-channels fp16", "four-channels staging"})
    for (const char* size : {"320x180", "101x57", "1x1"}) {
      const std::string rest = std::string(words).substr(std::string(words).find(' ') + 1);
      std::vector<std::string> arguments{"run", preset("toon.lua").string(), neon().string(), "--size", size};
      if (rest == "fp16") arguments.insert(arguments.end(), {"--precision", "fp16"});
      compare(words, 0, arguments);
      EXPECT_NE(report().at("session").at("choice").get<std::string>().find("four-channels"), std::string::npos);
    }
}

TEST_F(ForcedWays, SequencesThatLookBackAreTheSame) {
  for (int frame = 1; frame <= 4; ++frame) make_exr("in/a.000" + std::to_string(frame) + ".exr", 96, 54);
  write("look.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.auto_exposure {}, fx.bloom { threshold = 0.5 }, "
        "fx.tone_mapping {} }\n");
  for (const auto& [words, error] : {Way{"staging", 0}, {"unmapped,compute", 2e-5}, {"unmapped,timestamps,fp16", 5e-3}})
    compare(words, error, {"run", "look.lua", "in/a.####.exr"}, "0004");
}

TEST_F(ForcedWays, AreTold) {
  make_exr("a.exr");
  const auto with = [&](const std::string& words) {
    const Outcome outcome = run(
        {"run", preset("neon_night.lua").string(), "a.exr", "-o", "a.png", "--stats=passes", "--report", "report.json"},
        forced(words));
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return outcome;
  };
  EXPECT_THAT(with("timestamps").err + with("timestamps").out, HasSubstr("by the device's timestamps"));
  EXPECT_THAT(with("").err + with("").out, HasSubstr("each submitted alone"));
  with("fp16,hardware-filter");
  EXPECT_THAT(report().dump(), HasSubstr("; forced"));
  EXPECT_THAT(report().dump(), HasSubstr("fp16 hardware-filter"));
}

TEST_F(ForcedWays, UnknownOnesAreRefusedWithTheNearest) {
  make_exr("a.exr");
  for (const char* command : {"run", "bake"}) {
    const std::string look = preset("plain_aces.lua").string();
    const Outcome outcome = command == std::string("run")
                                ? run({"run", look, "a.exr", "-o", "a.png"}, forced("stageing,fp16"))
                                : run({"bake", look, "-o", "a.cube"}, forced("stageing,fp16"));
    EXPECT_EQ(outcome.exit_code, kUsage) << outcome.err;
    EXPECT_TRUE(is_one_error_line(outcome.err)) << outcome.err;
    EXPECT_THAT(outcome.err,
                HasSubstr("AFTERGLOW_FORCE: 'stageing' is no way to force; allowed: staging, unmapped, timestamps, "));
    EXPECT_THAT(outcome.err, HasSubstr("did you mean 'staging'?"));
  }
}

}  // namespace
}  // namespace afterglow::test
