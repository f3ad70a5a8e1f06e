// SPDX-License-Identifier: MIT
// What strangers' files make the program say and do: exit codes of the README, one line, nothing for the terminal to
// obey.
#include <OpenImageIO/imageio.h>

#include <nlohmann/json.hpp>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class Hostile : public CliTest {};

TEST_F(Hostile, ClaimsThatTheFileCannotHold) {
  make_preset("look.lua");
  OIIO::ImageSpec spec(16, 16, 3, OIIO::TypeDesc::UINT8);
  auto out = OIIO::ImageOutput::create(text("small.jpg"));
  ASSERT_TRUE(out->open(text("small.jpg"), spec));
  const std::vector<unsigned char> pixels(16 * 16 * 3, 100);
  ASSERT_TRUE(out->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
  ASSERT_TRUE(out->close());
  std::string jpeg = read("small.jpg");
  const std::size_t frame = jpeg.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  jpeg[frame + 5] = jpeg[frame + 7] = 0x3f;  // 16144 × 16144 pixels in some hundred bytes
  write("bomb.jpg", jpeg);
  const Outcome outcome = run({"run", "look.lua", "bomb.jpg", "-o", "out.png"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_TRUE(is_one_error_line(outcome.err));
  EXPECT_THAT(outcome.err, HasSubstr("cannot hold its pixels"));
}

TEST_F(Hostile, UnknownFormatsAreNamedWithThoseThatAreRead) {
  make_preset("look.lua");
  write("list.mp4", "#EXTM3U\n#EXTINF:1,\nhttp://127.0.0.1:1/x.ts\n");
  const Outcome outcome = run({"run", "look.lua", "list.mp4", "-o", "out.png"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("is not a picture in a format that is known; allowed: EXR, PNG, JPEG"));
}

TEST_F(Hostile, EscapesOfScriptsAndNamesNeverReachTheTerminal) {
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { [\"\\27]0;owned\\a\"] = 1 }\n");
  const Outcome outcome = run({"check", "look.lua"});
  EXPECT_EQ(outcome.exit_code, kScript);
  EXPECT_EQ(outcome.err.find('\x1b'), std::string::npos) << outcome.err;
  write("name.lua", "local fx = require \"afterglow\"\nreturn fx.stack { name = \"a\\27[2Jb\", fx.tone_mapping {} }\n");
  for (const char* command : {"check", "explain"}) {
    const Outcome printed = run({command, "name.lua"});
    EXPECT_EQ(printed.exit_code, kDone) << printed.err;
    EXPECT_EQ(printed.out.find('\x1b'), std::string::npos) << printed.out;
  }
  const Outcome named = run({"check", "no\x1b[2Jsuch.lua"});
  EXPECT_EQ(named.exit_code, kScript);
  EXPECT_EQ(named.err.find('\x1b'), std::string::npos) << named.err;
}

TEST_F(Hostile, NamesThatAreNoUtf8GoIntoJson) {
  write("look\xff.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { name = \"a\\xFFb\", fx.tone_mapping {} }\n");
  const Outcome outcome = run({"check", "look\xff.lua", "--json"});
  ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out, nullptr, false);
  ASSERT_TRUE(json.is_object()) << outcome.out;
  EXPECT_EQ(json["name"],
            "a\xEF\xBF\xBD"
            "b");
}

TEST_F(Hostile, AScriptThatNothingInterruptsEndsAllTheSame) {
  write("look.lua", "local s = (\"\"):rep(math.maxinteger)\nreturn require(\"afterglow\").stack {}\n");
  EXPECT_EQ(run({"check", "look.lua"}).exit_code, kDone);
  write("look.lua", "local m = {} local t = setmetatable({}, m) m.__call = t t()\n");
  EXPECT_EQ(run({"check", "look.lua"}).exit_code, kScript);
}

/// On CPU devices nothing but the engine ends a shader.
TEST_F(Hostile, AShaderThatNeverEndsIsToldAndEnded) {
  write("effects/spin.lua",
        "return require(\"afterglow\").effect { name = \"spin\", doc = \"Spins.\", at = \"post_process\", order = 300, "
        "settings = "
        "{},\n  build = function(g, s, source) return g:pass { shader = \"spin\", source = source } end }\n");
  write("shaders/spin.glsl", "vec4 apply(vec4 color) {\n  while (true)\n    color.r += 1.0;\n  return color;\n}\n");
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.spin {} }\n");
  make_exr("a.exr");
  const std::string told =
      "shaders/spin.glsl:2: error: a loop did not end within 32768 turns of one pixel, in 'spin.spin'";
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"run", "look.lua", "a.exr", "-o", "out.exr"},
        {"run", "look.lua", "a.exr", "-o", "out.exr", "--reference"},
        {"run", "look.lua", "a.exr", "-o", "out.exr", "--stats=passes"},
        {"play", "look.lua", "a.exr", "--headless", "--count", "3", "--fast"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kScript) << arguments[0] << ": " << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(told)) << arguments[0];
  }
  EXPECT_FALSE(fs::exists(path("out.exr")));
  RunOptions forced;
  forced.environment["AFTERGLOW_FORCE"] = "staging";
  make_exr("b.exr");
  fs::create_directory(path("graded"));
  const Outcome outcome = run({"run", "look.lua", "a.exr", "b.exr", "-o", "graded/"}, forced);
  EXPECT_EQ(outcome.exit_code, kScript) << "with frames in flight";
  EXPECT_THAT(outcome.err, HasSubstr(told));
}

/// The same pictures; and nothing beside them, the look and the output.
TEST_F(Hostile, ASandboxShowsTheProgramItsPicturesAlone) {
  make_preset("looks/look.lua");
  make_exr("in/a.0001.exr");
  make_exr("in/a.0002.exr");
  make_exr("elsewhere/b.exr");
  fs::create_directory(path("free"));
  fs::create_directory(path("kept"));
  RunOptions confined;
  confined.environment["ASAN_OPTIONS"] = "detect_leaks=0";  // which looks by ptrace, if the program was built for it
  const Outcome free = run({"run", "looks/look.lua", "in/a.####.exr", "-o", "free/"});
  ASSERT_EQ(free.exit_code, kDone) << free.err;
  const Outcome kept = run({"run", "looks/look.lua", "in/a.####.exr", "-o", "kept/", "--sandbox"}, confined);
  if (kept.exit_code == kDevice) {
    EXPECT_THAT(kept.err, HasSubstr("cannot confine a process"));
    GTEST_SKIP() << "this kernel has no Landlock";
  }
  ASSERT_EQ(kept.exit_code, kDone) << kept.err;
  for (const char* name : {"a.0001.exr", "a.0002.exr"})
    EXPECT_EQ(read(std::string("free/") + name), read(std::string("kept/") + name)) << name;
  // What a picture replaces keeps who may read it.
  fs::permissions(path("kept/a.0001.exr"), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(run({"run", "looks/look.lua", "in/a.####.exr", "-o", "kept/", "--sandbox"}, confined).exit_code, kDone);
  EXPECT_EQ(fs::status(path("kept/a.0001.exr")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  // A frame that leads out of its folder.
  fs::remove(path("in/a.0002.exr"));
  fs::create_symlink(path("elsewhere/b.exr"), path("in/a.0002.exr"));
  EXPECT_EQ(run({"run", "looks/look.lua", "in/a.####.exr", "-o", "free/"}).exit_code, kDone);
  const Outcome out = run({"run", "looks/look.lua", "in/a.####.exr", "-o", "kept/", "--sandbox"}, confined);
  EXPECT_EQ(out.exit_code, kFiles) << out.err;
  EXPECT_THAT(out.err, HasSubstr("a.0002.exr"));
  // Errors are as before.
  const Outcome none = run({"run", "looks/look.lua", "in/none.exr", "-o", "kept/x.png", "--sandbox"}, confined);
  EXPECT_EQ(none.exit_code, kFiles);
  EXPECT_THAT(none.err, HasSubstr("none.exr"));
}

}  // namespace
}  // namespace afterglow::test
