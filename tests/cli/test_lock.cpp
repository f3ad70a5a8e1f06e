// SPDX-License-Identifier: MIT
// --lock writes down what a run was made with; --locked refuses another look.
#include <nlohmann/json.hpp>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class Locks : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    write("effects/double.lua",
          "local fx = require \"afterglow\"\n"
          "return fx.effect { name = \"double\", doc = \"Twice.\", at = \"post_process\",\n"
          "  settings = { gain = fx.float { default = 2, doc = \"Factor.\" } },\n"
          "  build = function(g, s, source) return g:pass { shader = \"double/gain\", source = source, gain = s.gain } "
          "end }\n");
    write("shaders/double/gain.glsl",
          "#include \"double/shared.glsl\"\nuniform float gain;\nvec4 apply(vec4 color) { return color * gain * kOne; "
          "}\n");
    write("shaders/double/shared.glsl", "const float kOne = 1.0;\n");
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.double {}, fx.tone_mapping {} }\n");
    make_exr("in.exr");
  }

  Outcome run_with(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"run", "look.lua", "in.exr", "-o", "out.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  nlohmann::json lock() const { return nlohmann::json::parse(read("look.lock")); }
};

TEST_F(Locks, NameEveryFileThatDecidesPixelsAndWhatItWasMadeWith) {
  const Outcome outcome = run_with({"--lock", "look.lock", "--set", "double.gain=3"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  const auto written = lock();
  const auto& files = written.at("look").at("files");
  for (const char* name :
       {"look.lua", "effects/double.lua", "shaders/double/gain.glsl", "shaders/double/shared.glsl",
        "installation: scripts/effects/tone_mapping.lua", "installation: shaders/tone_mapping/aces.glsl"})
    EXPECT_TRUE(files.contains(name)) << name << " is not in " << files.dump();
  EXPECT_EQ(written.at("look").at("options").at("--set"), "double.gain=3");
  for (const char* name : {"afterglow", "device", "driver", "execution", "shader compiler"})
    EXPECT_FALSE(written.at("made_with").at(name).get<std::string>().empty()) << name;
}

TEST_F(Locks, TheSameLookRunsAndMakesTheSameBytes) {
  ASSERT_EQ(run_with({"--lock", "look.lock"}).exit_code, kDone);
  const std::string first = read("out.png");
  fs::remove(path("out.png"));
  const Outcome again = run_with({"--locked", "look.lock"});
  EXPECT_EQ(again.exit_code, kDone) << again.err;
  EXPECT_THAT(again.err, IsEmpty());
  EXPECT_EQ(read("out.png"), first);
}

TEST_F(Locks, TheSameBytesWhateverTheThreadsAndCaches) {
  std::string first;
  for (const char* threads : {"0", "1", "2", "5"}) {
    const Outcome outcome =
        run({"run", "neon_night", "in.exr", "-o", "out.exr", "--type", "float"},
            {.environment = {{"LP_NUM_THREADS", threads}, {"AFTERGLOW_CACHE", text(std::string("cache") + threads)}}});
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    const std::string bytes = read("out.exr");
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first) << threads << " threads";
  }
}

TEST_F(Locks, AnotherLookIsRefusedBeforeAnythingIsMade) {
  ASSERT_EQ(run_with({"--lock", "look.lock"}).exit_code, kDone);
  fs::remove(path("out.png"));
  const auto refused = [&](const std::vector<std::string>& more, const std::string& why) {
    const Outcome outcome = run_with(more);
    EXPECT_EQ(outcome.exit_code, kScript);
    EXPECT_THAT(outcome.err, HasSubstr("the look is not the locked one: " + why));
    EXPECT_FALSE(fs::exists(path("out.png")));
  };
  refused({"--locked", "look.lock", "--set", "double.gain=1"}, "--set is double.gain=1, was not given");
  const std::string shared = read("shaders/double/shared.glsl");
  write("shaders/double/shared.glsl", "const float kOne = 1.5;\n");
  refused({"--locked", "look.lock"}, "shaders/double/shared.glsl has changed");
  write("shaders/double/shared.glsl", shared);
  write("look.lua", read("look.lua") + "-- a comment counts: what a script does cannot be told from its text\n");
  refused({"--locked", "look.lock"}, "look.lua has changed");
}

TEST_F(Locks, ShadowingAnEffectIsAnotherLook) {
  ASSERT_EQ(run_with({"--lock", "look.lock"}).exit_code, kDone);
  fs::create_directories(path("shaders/tone_mapping"));
  write("shaders/tone_mapping/aces.glsl", "vec4 apply(vec4 color) { return color; }\n");
  const Outcome outcome = run_with({"--locked", "look.lock"});
  EXPECT_EQ(outcome.exit_code, kScript);
  EXPECT_THAT(outcome.err, HasSubstr("installation: shaders/tone_mapping/aces.glsl is not used any more"));
}

TEST_F(Locks, OtherVersionsAreAWarning) {
  ASSERT_EQ(run_with({"--lock", "look.lock"}).exit_code, kDone);
  auto changed = lock();
  changed["made_with"]["driver"] = "another driver 1.0";
  write("look.lock", changed.dump());
  const Outcome outcome = run_with({"--locked", "look.lock"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("was another driver 1.0"));
}

TEST_F(Locks, WhatIsNoLockIsRefused) {
  for (const char* text : {"", "{", "[]", "{\"afterglow_lock\": 99}", "{\"afterglow_lock\": \"1\"}",
                           "{\"afterglow_lock\": 1, \"look\": 7}"}) {
    write("bad.lock", text);
    const Outcome outcome = run_with({"--locked", "bad.lock"});
    EXPECT_EQ(outcome.exit_code, kFiles) << text;
    EXPECT_TRUE(is_one_error_line(outcome.err));
    EXPECT_THAT(outcome.err, HasSubstr("this is no lock"));
  }
  EXPECT_EQ(run_with({"--locked", "missing.lock"}).exit_code, kFiles);
  EXPECT_EQ(run_with({"--locked", "a", "--lock", "b"}).exit_code, kUsage);
  EXPECT_FALSE(fs::exists(path("out.png")));
}

TEST_F(Locks, AFailedRunWritesNone) {
  EXPECT_EQ(run({"run", "look.lua", "missing.exr", "-o", "out.png", "--lock", "look.lock"}).exit_code, kFiles);
  EXPECT_FALSE(fs::exists(path("look.lock")));
}

}  // namespace
}  // namespace afterglow::test
