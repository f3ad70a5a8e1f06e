// SPDX-License-Identifier: MIT
// new effect: what it writes works at once and passes its own test.
#include <cstdlib>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class New : public CliTest {
 protected:
  // Exit status of the effect's own test; its messages in test.log.
  int own_test(const std::string& name) const {
    const std::string command = "AFTERGLOW='" AFTERGLOW_PROGRAM "' AFTERGLOW_CACHE='" AFTERGLOW_BUILD_FOLDER
                                "/test-cache' AFTERGLOW_PATH= sh '" +
                                text("tests/" + name + ".sh") + "' >'" + text("test.log") + "' 2>&1";
    return std::system(command.c_str());
  }
};

TEST_F(New, AnEffectRunsAtOnceAndPassesItsOwnTest) {
  const Outcome made = run({"new", "effect", "haze"});
  ASSERT_EQ(made.exit_code, kDone) << made.err;
  EXPECT_THAT(files(),
              ::testing::IsSupersetOf({"effects/haze.lua", "haze.lua", "shaders/haze/haze.glsl", "tests/haze.sh"}));
  for (const auto& name : files()) {
    if (!name.ends_with("haze.lua") && !name.ends_with(".glsl") && !name.ends_with(".sh")) continue;
    EXPECT_THAT(read(name), Not(HasSubstr("my_effect"))) << name;
  }
  make_exr("a.exr");
  const Outcome ran = run({"run", "haze.lua", "a.exr", "-o", "a.png", "--device", "llvmpipe"});
  EXPECT_EQ(ran.exit_code, kDone) << ran.err;
  EXPECT_EQ(own_test("haze"), 0) << read("test.log");
  EXPECT_THAT(read("test.log"), HasSubstr("haze: passed"));
}

TEST_F(New, ItsTestFindsMistakes) {
  ASSERT_EQ(run({"new", "effect", "haze"}).exit_code, kDone);
  const std::string shader = read("shaders/haze/haze.glsl");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = shader;
    changed.replace(changed.find(from), from.size(), to);
    write("shaders/haze/haze.glsl", changed);
    EXPECT_NE(own_test("haze"), 0);
    return read("test.log");
  };
  EXPECT_THAT(with("strength), color.a", "0.0), color.a"), HasSubstr("FAILED: strength = 0.5 does not change"));
  EXPECT_THAT(with("strength), color.a", "0.7), color.a"), HasSubstr("FAILED: strength does not matter"));
  EXPECT_THAT(with("tint *", "tnt *"), HasSubstr("FAILED: check finds an error"));
}

TEST_F(New, ItsTestHasLightAboveWhite) {
  ASSERT_EQ(run({"new", "effect", "haze"}).exit_code, kDone);
  write("shaders/haze/haze.glsl",
        "uniform float strength;\nuniform vec3 tint;\n"
        "vec4 apply(vec4 color) { return vec4(color.rgb - strength * tint * max(color.rgb - 2.0, 0.0), color.a); }\n");
  EXPECT_NE(own_test("haze"), 0);
  EXPECT_THAT(read("test.log"), HasSubstr("FAILED: stress: haze"))
      << "seen to change the picture; its promises are others";
}

TEST_F(New, ItsTestTriesHardLight) {
  ASSERT_EQ(run({"new", "effect", "haze"}).exit_code, kDone);
  write("shaders/haze/haze.glsl",
        "uniform float strength;\nuniform vec3 tint;\n"
        "vec4 apply(vec4 color) { return vec4(mix(color.rgb, tint * color.a, strength), color.a); }\n");
  EXPECT_NE(own_test("haze"), 0) << "light of 1e30 behind an alpha above 1 becomes infinite";
  EXPECT_THAT(read("test.log"), HasSubstr("FAILED: stress: haze"));
}

TEST_F(New, NeverOverwrites) {
  write("haze.lua", "mine");
  const Outcome outcome = run({"new", "effect", "haze"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_TRUE(is_one_error_line(outcome.err));
  EXPECT_THAT(outcome.err, HasSubstr("haze.lua: error: exists already; nothing was written"));
  EXPECT_EQ(read("haze.lua"), "mine");
  EXPECT_THAT(files(), ::testing::ElementsAre("haze.lua"));
}

TEST_F(New, WhatCannotBeWrittenLeavesNothing) {
  RunOptions options;
  options.program = "/bin/sh";
  const Outcome outcome =
      run({"-c", "trap '' XFSZ; ulimit -f 1; exec \"" AFTERGLOW_PROGRAM "\" new effect haze"}, options);
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("cannot be written: File too large"));
  EXPECT_THAT(files(), ::testing::IsEmpty());
  EXPECT_TRUE(fs::is_empty(path("")));
}

TEST_F(New, IntoAnotherFolder) {
  EXPECT_THAT(run({"new", "look", "dusk", "--in", "my looks"}).out, HasSubstr("run 'my looks/dusk.lua' PICTURE"));
  EXPECT_EQ(run({"new", "effect", "haze", "--in", "mine"}).exit_code, kDone);
  EXPECT_EQ(run({"check", "mine/haze.lua"}).exit_code, kDone);
}

TEST_F(New, ALookRunsAndNothingIsWrongWithIt) {
  const Outcome made = run({"new", "look", "dusk", "--in", "mine"});
  ASSERT_EQ(made.exit_code, kDone) << made.err;
  EXPECT_EQ(made.out, "mine/dusk.lua\nTry it:  afterglow run mine/dusk.lua PICTURE -o out.png\n");
  const Outcome checked = run({"check", "mine/dusk.lua"});
  EXPECT_EQ(checked.exit_code, kDone) << checked.err;
  EXPECT_EQ(checked.err, "");
  EXPECT_THAT(checked.out, Not(HasSubstr("note: ")));
  EXPECT_THAT(checked.out, Not(HasSubstr("my_look")));
  make_exr("in.exr");
  EXPECT_EQ(run({"run", "mine/dusk.lua", "in.exr", "-o", "out.png"}).exit_code, kDone);
  EXPECT_EQ(run({"new", "look", "dusk", "--in", "mine"}).exit_code, kFiles);
  EXPECT_THAT(run({"new", "look", "../dusk"}).err, HasSubstr("cannot be the name of a look"));
}

TEST_F(New, Names) {
  const auto error = [&](const std::string& name) {
    const Outcome outcome = run({"new", "effect", name});
    EXPECT_EQ(outcome.exit_code, kUsage);
    return outcome.err;
  };
  EXPECT_THAT(error("../haze"),
              HasSubstr("'../haze' cannot be the name of an effect; allowed: 1 to 64 letters, digits and "
                        "'_', no digit first"));
  EXPECT_THAT(error("2d"), HasSubstr("cannot be the name"));
  EXPECT_THAT(error("haze.lua"), HasSubstr("'haze.lua' cannot be the name of an effect; allowed: haze\n"));
  EXPECT_THAT(error("end"), HasSubstr("'end' is a word of Lua; fx.end could not be written"));
  EXPECT_THAT(error("stack"), HasSubstr("'stack' is a name of the library: fx.stack"));
  EXPECT_THAT(error("bloom"), HasSubstr("'bloom' is an effect already: "));
  EXPECT_THAT(files(), IsEmpty());
  const Outcome kind = run({"new", "preset", "haze"});
  EXPECT_EQ(kind.exit_code, kUsage);
}

}  // namespace
}  // namespace afterglow::test
