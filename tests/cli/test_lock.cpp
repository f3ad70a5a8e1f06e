// SPDX-License-Identifier: MIT
// --lock writes down what a run was made with; --locked refuses another look.
#include <fmt/format.h>

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

TEST_F(Locks, NamesThatAreNoUtf8) {
  const std::string look = "l\xffk.lua";
  fs::copy_file(path("look.lua"), path(look));
  const auto run_look = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", look, "in.exr", "-o", "out.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  ASSERT_EQ(run_look({"--lock", "look.lock"}).exit_code, kDone);
  const Outcome again = run_look({"--locked", "look.lock"});
  EXPECT_EQ(again.exit_code, kDone) << again.err;
  fs::copy_file(path("look.lua"), path("l\xfe.lua"));
  EXPECT_EQ(run({"run", "l\xfe.lua", "in.exr", "-o", "out.png", "--locked", "look.lock"}).exit_code, kScript);
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

TEST_F(Locks, FilesOfOneNameInTwoFolders) {
  write("job/look.lua", "local fx = require \"afterglow\"\nreturn fx.extend(\"look\", {})\n");
  write("show/look.lua", read("look.lua"));
  const std::vector<std::string> words{"run",    "job/look.lua", "in.exr", "-o", "out.png",
                                       "--path", "show",         "--path", "."};
  const auto with = [&](const std::string& option) {
    auto all = words;
    all.insert(all.end(), {option, "look.lock"});
    return run(all);
  };
  ASSERT_EQ(with("--lock").exit_code, kDone);
  EXPECT_EQ(with("--locked").exit_code, kDone);
  write("show/look.lua", read("look.lua") + "-- changed\n");
  const Outcome outcome = with("--locked");
  EXPECT_EQ(outcome.exit_code, kScript);
  EXPECT_THAT(outcome.err, HasSubstr("look.lua (path 2) has changed"));
  write("show/look.lua", read("look.lua"));
  write("job/look.lua", read("job/look.lua") + "-- changed\n");
  EXPECT_THAT(with("--locked").err, HasSubstr("the locked one: look.lua has changed"));
}

TEST_F(Locks, TablesThatALookChoosesByFrame) {
  const auto table = [&](const std::string& name, const std::string& end) {
    write(name, "LUT_1D_SIZE 2\n0 0 0\n" + end + "\n");
  };
  table("id.cube", "1 1 1");
  table("half.cube", "0.5 0.5 0.5");
  write(
      "look.lua",
      "local fx = require \"afterglow\"\n"
      "return fx.stack { fx.lut { file = function(t) return t.frame == 150 and \"half.cube\" or \"id.cube\" end } }\n");
  constexpr int kFrames = 160;  // more than are evaluated when the look is loaded
  for (int frame = 1; frame <= kFrames; ++frame) make_exr(fmt::format("in/f.{:04}.exr", frame), 8, 8);
  const auto with = [&](const std::string& frames, const std::string& option) {
    return run({"run", "look.lua", "in/f.####.exr", "-o", "out/", "--frames", frames, option, "look.lock"});
  };
  ASSERT_EQ(with("1-160", "--lock").exit_code, kDone);
  EXPECT_EQ(with("2-3", "--locked").exit_code, kDone) << "some of the frames";
  table("half.cube", "0.25 0.25 0.25");
  EXPECT_EQ(with("2-3", "--locked").exit_code, kDone) << "none of which uses it";
  const Outcome outcome = with("149-151", "--locked");
  EXPECT_EQ(outcome.exit_code, kScript);
  EXPECT_THAT(outcome.err, HasSubstr("the look is not the locked one: half.cube has changed"));
}

TEST_F(Locks, VariablesThatAConfigurationReads) {
  write("show.ocio",
        "ocio_profile_version: 2\nsearch_path: $SHOT\nroles: {scene_linear: lin, default: lin}\n"
        "displays: {d: [!<View> {name: v, colorspace: out}]}\n"
        "colorspaces:\n  - !<ColorSpace> {name: lin}\n  - !<ColorSpace>\n    name: out\n"
        "    from_scene_reference: !<FileTransform> {src: a.cube, interpolation: linear}\n");
  for (const char* shot : {"one", "two"}) write(shot + std::string("/a.cube"), "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n");
  write("look.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.stack { fx.ocio_display { config = \"show.ocio\", from = \"lin\", display = \"d\", view = \"v\" } "
        "}\n");
  const auto with = [&](const std::string& option, const std::string& shot) {
    RunOptions options;
    options.environment["SHOT"] = shot;
    return run({"run", "look.lua", "in.exr", "-o", "out.png", option, "look.lock"}, options);
  };
  const Outcome made = with("--lock", "one");
  ASSERT_EQ(made.exit_code, kDone) << made.err;
  EXPECT_EQ(lock().at("look").at("environment").at("SHOT"), "one");
  EXPECT_EQ(lock().at("look").at("generated").size(), 1u);
  EXPECT_EQ(with("--locked", "one").exit_code, kDone);
  const Outcome outcome = with("--locked", "two");
  EXPECT_EQ(outcome.exit_code, kScript);
  EXPECT_THAT(outcome.err, HasSubstr("SHOT is two, was one"));
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

TEST_F(Locks, OfVersion1AreRead) {
  ASSERT_EQ(run_with({"--lock", "look.lock"}).exit_code, kDone);
  auto old = lock();
  old["afterglow_lock"] = 1;
  for (const char* name : {"frame_files", "environment", "generated"}) old["look"].erase(name);
  write("look.lock", old.dump());
  const Outcome outcome = run_with({"--locked", "look.lock"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  write("shaders/double/shared.glsl", "const float kOne = 1.5;\n");
  EXPECT_THAT(run_with({"--locked", "look.lock"}).err, HasSubstr("shaders/double/shared.glsl has changed"));
}

TEST_F(Locks, WhatIsNoLockIsRefused) {
  for (const char* text : {"", "{", "[]", "{\"afterglow_lock\": 99}", "{\"afterglow_lock\": 0}",
                           "{\"afterglow_lock\": \"2\"}", "{\"afterglow_lock\": 2, \"look\": 7}"}) {
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
