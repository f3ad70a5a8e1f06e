// SPDX-License-Identifier: MIT
// Presets and effects used by name, from folders and zips.
#include <unistd.h>

#include <cstdlib>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class Packs : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    write("kit/presets/warm.lua",
          "local fx = require \"afterglow\"\nreturn fx.stack { name = \"Warm\", fx.warmth {} }\n");
    write("kit/effects/warmth.lua",
          "local fx = require \"afterglow\"\nreturn fx.effect { name = \"warmth\", doc = \"Red.\",\n"
          "  settings = { gain = fx.float { min = 0, default = 1.5 } },\n"
          "  build = function(g, s, source) return g:pass { shader = \"warmth/red\", source = source, gain = s.gain } "
          "end }\n");
    write("kit/shaders/warmth/red.glsl",
          "uniform float gain;\nvec4 apply(vec4 color) { return vec4(color.r * gain, color.gba); }\n");
    make_exr("a.exr");
  }
  // The kit as a zip, with CMake's own archiver.
  void zip(const std::string& name, const std::string& from = "kit") const {
    fs::create_directories(path(name).parent_path());
    const std::string command =
        "cd '" + text(from) + "' && '" AFTERGLOW_CMAKE "' -E tar cf '" + text(name) + "' --format=zip . >/dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
  }
  Outcome run_here(const std::vector<std::string>& arguments, const std::string& search = "") const {
    RunOptions options;
    options.environment["AFTERGLOW_CACHE"] = text("cache");
    options.environment["AFTERGLOW_PATH"] = search;
    return run(arguments, options);
  }
  std::string picture(const std::vector<std::string>& preset, const std::string& search = "") const {
    std::vector<std::string> arguments{"run"};
    arguments.insert(arguments.end(), preset.begin(), preset.end());
    for (const char* more : {"a.exr", "-o", "a.png", "--device", "llvmpipe"}) arguments.emplace_back(more);
    const Outcome outcome = run_here(arguments, search);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return read("a.png");
  }
};

TEST_F(Packs, APresetByItsName) {
  const Outcome installed = run_here({"check", "neon_night"});
  EXPECT_EQ(installed.exit_code, kDone) << installed.err;
  EXPECT_THAT(installed.out, HasSubstr("Neon night"));
  const Outcome wrong = run_here({"check", "neon_nigth"});
  EXPECT_EQ(wrong.exit_code, kScript);
  EXPECT_THAT(wrong.err, HasSubstr("there is no preset 'neon_nigth'; allowed: "));
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'neon_night'?"));
}

TEST_F(Packs, CachesThatOthersMayWriteToAreNotUsed) {
  zip("kit.zip");
  const std::string own = "tmp/afterglow-" + std::to_string(geteuid());
  fs::create_directories(path(own));
  RunOptions homeless;
  homeless.environment = {{"AFTERGLOW_CACHE", ""}, {"XDG_CACHE_HOME", "relative"}, {"TMPDIR", text("tmp")}};
  const auto check = [&](const std::string& home) {
    homeless.environment["HOME"] = home;
    const Outcome outcome = run({"check", "kit.zip"}, homeless);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  };
  fs::permissions(path(own), fs::perms::all);
  check("");
  EXPECT_TRUE(fs::is_empty(path(own)));
  fs::permissions(path(own), fs::perms::owner_all);
  check("/dev/null");  // nothing can be made there
  EXPECT_TRUE(fs::exists(path(own + "/packs")));
  EXPECT_FALSE(fs::exists(path("relative")));
}

TEST_F(Packs, TheSamePictureFromAFolderAndAZip) {
  zip("kit.zip");
  const std::string expected = picture({"kit/presets/warm.lua"});
  EXPECT_EQ(picture({"kit"}), expected);
  EXPECT_EQ(picture({"kit.zip"}), expected);
  EXPECT_EQ(picture({"warm", "--path", "kit"}), expected);
  EXPECT_EQ(picture({"warm", "--path", "kit.zip"}), expected);
  EXPECT_EQ(picture({"warm"}, text("kit.zip")), expected);
  fs::create_directory(path("looks"));
  zip("looks/packs/some.zip");
  EXPECT_EQ(picture({"warm"}, text("looks")), expected);
}

/// What a zip was unpacked to belongs to the cache: a change there would be lost, and the zip stay as it was.
TEST_F(Packs, PresetsInAZipAreNotChanged) {
  zip("kit.zip");
  const Outcome outcome = run_here({"set", "kit.zip", "warmth.gain=3"});
  EXPECT_EQ(outcome.exit_code, kUsage);
  EXPECT_THAT(outcome.err, HasSubstr("warm.lua: error: lies in the pack kit.zip, and packs are not written"));
  EXPECT_THAT(run_here({"set", "kit.zip", "warmth.gain=3"}).out, IsEmpty());
  EXPECT_EQ(run_here({"set", "kit.zip", "warmth.gain=3", "--dry-run"}).exit_code, kUsage);
  EXPECT_EQ(run_here({"set", "kit", "warmth.gain=3"}).exit_code, kDone);
  EXPECT_THAT(read("kit/presets/warm.lua"), HasSubstr("gain = 3"));
}

TEST_F(Packs, EffectsOfAPackBesideAPreset) {
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.warmth { gain = 3 } }\n");
  EXPECT_EQ(run_here({"check", "look.lua"}).exit_code, kScript);
  zip("packs/kit.zip");
  const Outcome outcome = run_here({"check", "look.lua"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(run_here({"effects", "--path", "."}).out, HasSubstr("warmth"));
}

TEST_F(Packs, MessagesNameThePackAndTheLine) {
  write("kit/effects/warmth.lua", "local fx = require \"afterglow\"\nreturn fx.efect {}\n");
  zip("kit.zip");
  const Outcome outcome = run_here({"check", "kit.zip"});
  EXPECT_EQ(outcome.exit_code, kScript);
  EXPECT_THAT(outcome.err, HasSubstr("kit.zip/effects/warmth.lua:2: error: "));
}

TEST_F(Packs, SeveralPresetsNeedAName) {
  write("kit/presets/cold.lua", "return require(\"afterglow\").stack {}\n");
  zip("kit.zip");
  const Outcome outcome = run_here({"check", "kit.zip"});
  EXPECT_EQ(outcome.exit_code, kScript);
  EXPECT_THAT(
      outcome.err,
      HasSubstr("kit.zip: error: the pack holds several presets; allowed: --path kit.zip and one of: cold, warm"));
  EXPECT_EQ(run_here({"check", "cold", "--path", "kit.zip"}).exit_code, kDone);
}

TEST_F(Packs, ABrokenPackIsAnErrorThatNamesIt) {
  write("bad.zip", "no zip");
  write("look.lua", "return require(\"afterglow\").stack {}\n");
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"check", "bad.zip"}, {"check", "look.lua", "--path", "bad.zip"}, {"effects", "--path", "bad.zip"}}) {
    const Outcome outcome = run_here(arguments);
    EXPECT_EQ(outcome.exit_code, kScript);
    EXPECT_TRUE(is_one_error_line(outcome.err));
    EXPECT_THAT(outcome.err, HasSubstr("bad.zip: error: the pack is refused: it is no zip"));
  }
}

TEST_F(Packs, ExtendingAPresetOfAPack) {
  zip("packs/kit.zip");
  write("look.lua", "return require(\"afterglow\").extend(\"warm\", { warmth = { gain = 1.5 } })\n");
  EXPECT_EQ(picture({"look.lua"}), picture({"kit"}));
}

/// Two packs whose shaders and tables have the same names: each effect and each preset has its own.
TEST_F(Packs, PacksDoNotMeet) {
  const auto pack = [&](const std::string& name, const char* color, const char* gain) {
    const std::string folder = "packs/" + name + "/";
    write(folder + "effects/dye_" + name + ".lua",
          "local fx = require \"afterglow\"\nreturn fx.effect { name = \"dye_" + name +
              "\",\n  build = function(g, s, source) return g:pass { shader = \"dye/main\", source = source } end }\n");
    write(folder + "shaders/dye/main.glsl",
          std::string("vec4 apply(vec4 color) { return vec4(color.rgb * vec3(") + color + "), color.a); }\n");
    write(folder + "shaders/vignette/darken.glsl", "this is of this pack alone\n");
    write(folder + "luts/film.cube", std::string("LUT_1D_SIZE 2\n0 0 0\n") + gain + "\n");
    write(folder + "presets/base_" + name + ".lua",
          "local fx = require \"afterglow\"\nreturn fx.stack { fx.lut { file = \"luts/film.cube\" } }\n");
  };
  const auto look = [&](const std::string& name, const std::string& stack) {
    write(name, "local fx = require \"afterglow\"\nreturn " + stack + "\n");
    return picture({name});
  };
  pack("b", "0, 0, 1", "1 0.5 1");
  const std::string dyed = look("b.lua", "fx.stack { fx.dye_b {} }");
  const std::string graded = look("base.lua", "fx.extend(\"base_b\", {})");
  const std::string masked = look("mask.lua", "fx.stack { fx.dye_b { mask = 0.5 } }");
  pack("a", "1, 0, 0", "0.25 1 1");
  EXPECT_EQ(picture({"b.lua"}), dyed);
  EXPECT_EQ(picture({"mask.lua"}), masked);
  EXPECT_EQ(picture({"base.lua"}), graded);
  EXPECT_NE(look("a.lua", "fx.stack { fx.dye_a {} }"), dyed);
  EXPECT_NE(look("base_a.lua", "fx.extend(\"base_a\", {})"), graded);
  // Both in one look: nothing is left of the light.
  write("black.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.channel_mixer { red_out_red_in = 0, green_out_green_in "
        "= 0, blue_out_blue_in = 0 } }\n");
  EXPECT_EQ(look("both.lua", "fx.stack { fx.dye_a {}, fx.dye_b {} }"), picture({"black.lua"}));
  // A name that the preset gives itself goes along its own path.
  EXPECT_NE(look("own.lua", "fx.extend(\"base_b\", { lut = { file = \"luts/film.cube\" } })"), graded);
  // A built-in effect is changed beside the preset, not by a pack that has a shader of its name.
  look("built_in.lua", "fx.stack { fx.vignette {} }");
  write("shaders/vignette/darken.glsl", "this is beside the preset\n");
  EXPECT_THAT(run_here({"check", "built_in.lua"}).err, HasSubstr("shaders/vignette/darken.glsl:1: error"));
}

/// What --resume makes again: a table of a pack that another pack has one of the same name of.
TEST_F(Packs, ATableOfAPackIsOneOfItsFiles) {
  for (const char* name : {"a", "b"}) {
    const std::string folder = std::string("packs/") + name + "/";
    write(folder + "luts/film.cube", "LUT_1D_SIZE 2\n0 0 0\n1 0.5 1\n");
    write(folder + "presets/base_" + name + ".lua",
          "local fx = require \"afterglow\"\nreturn fx.stack { fx.lut { file = \"luts/film.cube\" } }\n");
  }
  write("look.lua", "return require(\"afterglow\").extend(\"base_b\", {})\n");
  fs::copy_file(path("a.exr"), path("s.0001.exr"));
  const auto made = [&] {
    const Outcome outcome =
        run_here({"run", "look.lua", "s.####.exr", "-o", "o.####.png", "--resume", "--device", "llvmpipe"});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return read("o.0001.png");
  };
  const std::string first = made();
  write("packs/a/luts/film.cube", "LUT_1D_SIZE 2\n0 0 0\n0 0 0\n");
  EXPECT_EQ(made(), first);
  write("packs/b/luts/film.cube", "LUT_1D_SIZE 2\n0 0 0\n0.25 1 1\n");
  EXPECT_NE(made(), first);
}

/// A folder that was zipped whole, the zip renamed since, and what people and systems put beside it.
TEST_F(Packs, AZippedFolderUnderAnotherName) {
  const std::string expected = picture({"kit"});
  fs::create_directories(path("top/my look"));
  fs::copy(path("kit"), path("top/my look"), fs::copy_options::recursive);
  fs::rename(path("top/my look/presets/warm.lua"), path("top/my look/warm.lua"));
  zip("mylook (1).zip", "top");
  EXPECT_EQ(picture({"mylook (1).zip"}), expected);
  write("top/readme.txt", "Made with love.");
  write("top/__MACOSX/my look/._warm.lua", "x");
  zip("final.zip", "top");
  EXPECT_EQ(picture({"final.zip"}), expected);
  write("bare/mylook/plain.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.exposure {} }\n");
  zip("renamed.zip", "bare");
  EXPECT_EQ(run_here({"check", "renamed.zip"}).exit_code, kDone) << run_here({"check", "renamed.zip"}).err;
}

}  // namespace
}  // namespace afterglow::test
