// SPDX-License-Identifier: MIT
// set: settings changed in a preset's own text, as users run it.
#include <unistd.h>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class Set : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    write("look.lua", kLook);
  }
  static constexpr const char* kLook =
      "local fx = require \"afterglow\"\n"
      "local strength = 0.2\n"
      "return fx.stack {\n"
      "  fx.bloom { threshold = 1.0, intensity = 0.2 },  -- the tubes\n"
      "  fx.tone_mapping {},\n"
      "  fx.color_adjustments {\n"
      "    contrast = 100 * strength,\n"
      "    color_filter = \"#ffeedd\",\n"
      "  },\n"
      "}\n";
};

TEST_F(Set, ChangesTheFileAndShowsTheLines) {
  const Outcome outcome =
      run({"set", "look.lua", "bloom.intensity=0.4", "bloom.scatter=0.6", "color_adjustments.saturation=-8"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_EQ(outcome.out,
            "look.lua:4\n"
            "-  fx.bloom { threshold = 1.0, intensity = 0.2 },  -- the tubes\n"
            "+  fx.bloom { threshold = 1.0, intensity = 0.4, scatter = 0.6 },  -- the tubes\n"
            "look.lua:9\n"
            "+    saturation = -8,\n");
  std::string wanted = kLook;
  wanted.replace(wanted.find("intensity = 0.2"), 15, "intensity = 0.4, scatter = 0.6");
  wanted.insert(wanted.find("  },\n}"), "    saturation = -8,\n");
  EXPECT_EQ(read("look.lua"), wanted);
  EXPECT_THAT(files(), ::testing::ElementsAre("look.lua"));
  // What check then says.
  EXPECT_THAT(run({"check", "look.lua"}).out, ContainsRegex("scatter +0\\.6"));
  const Outcome again = run({"set", "look.lua", "bloom.intensity=0.4", "-v"});
  EXPECT_EQ(again.exit_code, kDone);
  EXPECT_THAT(again.out, IsEmpty());
  EXPECT_THAT(again.err, HasSubstr("says so already"));
}

TEST_F(Set, OpacityBlendAndPartsOfMasks) {
  write("masked.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.stack {\n"
        "  fx.bloom { intensity = 0.2, opacity = 0.5, mask = fx.mask.luma { from = 1 } + fx.mask.luma { from = 2 } },\n"
        "  fx.tone_mapping {},\n"
        "  fx.vignette { opacity = fx.curve { { 1, 0 }, { 9, 1 } } },\n"
        "}\n");
  const Outcome computed = run({"set", "masked.lua", "vignette.opacity=0.5"});
  EXPECT_EQ(computed.exit_code, kScript);
  EXPECT_THAT(computed.err,
              HasSubstr("masked.lua:5: error: vignette.opacity is computed and stays as it is: fx.curve"));
  const Outcome outcome = run({"set", "masked.lua", "bloom.opacity=0.75", "bloom.mask.luma#2.from=4",
                               "bloom.mask.luma.softness=0.5", "tone_mapping.blend=lighten"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_EQ(read("masked.lua"),
            "local fx = require \"afterglow\"\n"
            "return fx.stack {\n"
            "  fx.bloom { intensity = 0.2, opacity = 0.75, mask = fx.mask.luma { from = 1, softness = 0.5 } + "
            "fx.mask.luma { from = 4 } },\n"
            "  fx.tone_mapping { blend = \"lighten\" },\n"
            "  fx.vignette { opacity = fx.curve { { 1, 0 }, { 9, 1 } } },\n"
            "}\n");
  EXPECT_EQ(run({"set", "masked.lua", "--reset", "bloom.opacity"}).exit_code, kDone);
  EXPECT_THAT(read("masked.lua"), HasSubstr("fx.bloom { intensity = 0.2, mask = "));
  EXPECT_THAT(run({"set", "masked.lua", "bloom.mask=1"}).err,
              HasSubstr("bloom.mask is made by the script and is changed there; allowed: the settings of its parts"));
  EXPECT_THAT(run({"set", "masked.lua", "bloom.mask.lumma.from=1"}).err, HasSubstr("did you mean 'mask.luma.from'?"));
}

TEST_F(Set, DryRunsWriteNothing) {
  const Outcome outcome = run({"set", "look.lua", "tone_mapping.mode=neutral", "--dry-run"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_EQ(outcome.out, "look.lua:5\n-  fx.tone_mapping {},\n+  fx.tone_mapping { mode = \"neutral\" },\n");
  EXPECT_EQ(read("look.lua"), kLook);
}

TEST_F(Set, Resets) {
  const Outcome outcome =
      run({"set", "look.lua", "--reset", "bloom.intensity", "--reset", "color_adjustments.color_filter"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(read("look.lua"), HasSubstr("fx.bloom { threshold = 1.0 },"));
  EXPECT_THAT(read("look.lua"), HasSubstr("contrast = 100 * strength,\n  },"));
}

TEST_F(Set, WhatIsComputedIsAnErrorAndNothingIsWritten) {
  const Outcome outcome = run({"set", "look.lua", "bloom.intensity=0.4", "color_adjustments.contrast=3"});
  EXPECT_EQ(outcome.exit_code, kScript);
  EXPECT_THAT(outcome.err,
              HasSubstr("look.lua:7: error: color_adjustments.contrast is computed and stays as it is: 100 * strength\n"
                        "  nothing was written"));
  EXPECT_EQ(read("look.lua"), kLook);
}

TEST_F(Set, Messages) {
  const auto fails = [&](const std::vector<std::string>& arguments, int exit_code, const std::string& text) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code);
    EXPECT_THAT(outcome.err, HasSubstr(text));
    EXPECT_EQ(read("look.lua"), kLook);
  };
  fails({"set", "look.lua"}, kUsage, "nothing to change; allowed: ENTRY.SETTING=VALUE");
  fails({"set", "look.lua", "bloom"}, kUsage, "'bloom' is no setting with a value; allowed: ENTRY.SETTING=VALUE");
  fails({"set", "look.lua", "blom.knee=1"}, kUsage,
        "the stack has no entry 'blom'; allowed: bloom, color_adjustments, tone_mapping; did you mean 'bloom'?");
  fails({"set", "look.lua", "bloom.kne=1"}, kUsage, "did you mean 'knee'?");
  fails({"set", "look.lua", "bloom.knee=7"}, kUsage, "bloom.knee = 7 is out of range; allowed: 0…1");
  fails({"set", "nowhere.lua", "bloom.knee=1"}, kScript, "nowhere.lua: error:");
}

TEST_F(Set, PresetsThatComeAlongAreNotWrittenByTheirName) {
  fs::create_directory(path("home"));
  for (const char* folder : {"scripts", "shaders", "presets"})
    fs::copy(preset("").parent_path().parent_path() / folder, path("home/" + std::string(folder)),
             fs::copy_options::recursive);
  const RunOptions there{.environment = {{"AFTERGLOW_HOME", text("home")}}};
  const std::string file = "home/presets/neon_night.lua", before = read(file);
  for (const auto& more : {std::vector<std::string>{}, {"--dry-run"}}) {
    std::vector<std::string> arguments{"set", "neon_night", "bloom.intensity=0.9"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome refused = run(arguments, there);
    EXPECT_EQ(refused.exit_code, kUsage);
    EXPECT_EQ(refused.err,
              "neon_night: error: comes along with Afterglow and stays as it is: copy it first; allowed: a file of "
              "yours, as `cp " +
                  text(file) + " .` makes one\n");
  }
  EXPECT_EQ(read(file), before);
  EXPECT_THAT(run({"set", "print", "tone_mapping.mode=aces"}, there).err,
              HasSubstr("`cp -r " + text("home/presets/print") + " .`"));
  // What a path names is the user's own affair, and so are presets of --path.
  EXPECT_EQ(run({"set", file, "bloom.intensity=0.9"}, there).exit_code, kDone);
  EXPECT_NE(read(file), before);
  EXPECT_EQ(run({"set", "look", "bloom.intensity=0.9", "--path", "."}, there).exit_code, kDone);
  EXPECT_THAT(read("look.lua"), HasSubstr("intensity = 0.9"));
}

TEST_F(Set, AFileThatIsNotThereIsAWarning) {
  write("lut.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.lut {} }\n");
  const Outcome outcome = run({"set", "lut.lua", "lut.file=later.cube"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("warning: lut.file = \"later.cube\": there is no such file beside the preset"));
  EXPECT_THAT(read("lut.lua"), HasSubstr("fx.lut { file = \"later.cube\" }"));
  write("later.cube", "LUT_3D_SIZE 2\n");
  EXPECT_THAT(run({"set", "lut.lua", "lut.file=later.cube"}).err, Not(HasSubstr("warning")));
}

TEST_F(Set, FilesThatMayNotBeWritten) {
  fs::permissions(path("look.lua"), fs::perms::owner_read);
  const Outcome outcome = run({"set", "look.lua", "bloom.knee=1"}, {.bound = true});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_THAT(outcome.err, HasSubstr("look.lua: error: cannot be written: Permission denied"));
  EXPECT_EQ(read("look.lua"), kLook);
}

}  // namespace
}  // namespace afterglow::test
