// SPDX-License-Identifier: MIT
// What a look author reads when a setting or a stack is wrong: whole messages, with file and line.
#include <gtest/gtest.h>

#include "scene.h"

namespace afterglow::test {
namespace {

// An effect with one setting of each type.
struct SettingMessages : testing::Test {
  SettingMessages() {
    scene.effect("glow", R"(
      settings = {
        mode = fx.enum { "additive", "scattering", default = "additive" },
        levels = fx.int { min = 1, default = 4 },
        steps = fx.int { min = 0, max = 16, default = 4 },
        knee = fx.float { min = 0, max = 1, default = 0.5 },
        gain = fx.float { min = 0, default = 1 },
        exposure = fx.float { default = 0 },
        fade = fx.bool { default = false },
        tint = fx.color { default = { 1, 1, 1 } },
        shift = fx.vec2 { min = -8, max = 8, default = { 0, 0 } },
      },
      build = function(g, s, source) return source end,)");
  }
  std::string error(const std::string& entries) {
    scene.stack(entries);
    return scene.load_error();
  }
  Scene scene;
};

constexpr const char* kNames = "mode, levels, steps, knee, gain, exposure, fade, tint, shift";

TEST_F(SettingMessages, UnknownSettingNamesItsOwnLineAndTheNearest) {
  EXPECT_EQ(error("fx.glow {\n  mode = \"additive\",\n  -- kne = 2\n  kne = 0.5,\n}"),
            std::string("preset.lua:6: error: effect 'glow' has no setting 'kne'; allowed: ") + kNames +
                "; did you mean 'knee'?");
  EXPECT_EQ(error("fx.glow { zzzzzz = 1 }"),
            std::string("preset.lua:3: error: effect 'glow' has no setting 'zzzzzz'; allowed: ") + kNames);
  EXPECT_EQ(error("fx.glow { enabld = false }"),
            std::string("preset.lua:3: error: effect 'glow' has no setting 'enabld'; allowed: ") + kNames +
                "; did you mean 'enabled'?");
}

TEST_F(SettingMessages, UnknownEffectNamesTheNearest) {
  const std::string message = error("\nfx.glo { }");
  EXPECT_EQ(message.substr(0, message.find(';')), "preset.lua:4: error: unknown effect 'glo'");
  EXPECT_EQ(message.substr(message.rfind(';')), "; did you mean 'glow'?");
  EXPECT_NE(message.find("allowed: "), std::string::npos);
  for (const auto& [written, meant] : {std::pair{"string", "text"}, {"number", "float"}, {"luma", "mask.luma"}}) {
    const std::string other = error(std::string("fx.") + written + " { }");
    EXPECT_EQ(other.substr(other.rfind(';')), std::string("; did you mean '") + meant + "'?");
  }
}

TEST_F(SettingMessages, OutOfRange) {
  EXPECT_EQ(error("fx.glow {\n\n knee = 1.5 }"), "preset.lua:5: error: glow.knee = 1.5 is out of range; allowed: 0…1");
  EXPECT_EQ(error("fx.glow { gain = -0.25 }"), "preset.lua:3: error: glow.gain = -0.25 is out of range; allowed: ≥ 0");
  EXPECT_EQ(error("fx.glow { levels = 0 }"),
            "preset.lua:3: error: glow.levels = 0 is out of range; allowed: integer ≥ 1");
  EXPECT_EQ(error("fx.glow { steps = 17 }"),
            "preset.lua:3: error: glow.steps = 17 is out of range; allowed: integer 0…16");
  EXPECT_EQ(error("fx.glow { levels = 3e9 }"),
            "preset.lua:3: error: glow.levels = 3000000000 is out of range; allowed: integer ≥ 1");
  EXPECT_EQ(error("fx.glow { shift = { 0, 9 } }"),
            "preset.lua:3: error: glow.shift = {0, 9} is out of range; allowed: {x, y}, each -8…8");
  EXPECT_EQ(
      error("fx.glow { tint = { 1, -1, 1 } }"),
      "preset.lua:3: error: glow.tint = {1, -1, 1} is out of range; allowed: {r, g, b} with numbers ≥ 0, \"#rrggbb\"");
}

TEST_F(SettingMessages, WrongType) {
  EXPECT_EQ(error("fx.glow { knee = \"soft\" }"),
            "preset.lua:3: error: glow.knee = \"soft\" is not a number; allowed: 0…1");
  EXPECT_EQ(error("fx.glow { exposure = {} }"),
            "preset.lua:3: error: glow.exposure = a table is not a number; allowed: a number");
  EXPECT_EQ(error("fx.glow { steps = 4.5 }"),
            "preset.lua:3: error: glow.steps = 4.5 is not an integer; allowed: integer 0…16");
  EXPECT_EQ(error("fx.glow { fade = 1 }"), "preset.lua:3: error: glow.fade = 1 is not a boolean; allowed: true, false");
  EXPECT_EQ(error("fx.glow { mode = 3 }"),
            "preset.lua:3: error: glow.mode = 3 is not a choice; allowed: additive, scattering");
  EXPECT_EQ(error("fx.glow { mode = \"aditive\" }"),
            "preset.lua:3: error: glow.mode = \"aditive\" is not a choice; allowed: additive, scattering; did you mean "
            "'additive'?");
  EXPECT_EQ(
      error("fx.glow { tint = { 1, 2 } }"),
      "preset.lua:3: error: glow.tint = {1, 2} is not a colour; allowed: {r, g, b} with numbers ≥ 0, \"#rrggbb\"");
  EXPECT_EQ(
      error("fx.glow { tint = \"#12345\" }"),
      "preset.lua:3: error: glow.tint = \"#12345\" is not a colour; allowed: {r, g, b} with numbers ≥ 0, \"#rrggbb\"");
  EXPECT_EQ(
      error("fx.glow { tint = \"#12345x\" }"),
      "preset.lua:3: error: glow.tint = \"#12345x\" is not a colour; allowed: {r, g, b} with numbers ≥ 0, \"#rrggbb\"");
  EXPECT_EQ(error("fx.glow { shift = 1 }"),
            "preset.lua:3: error: glow.shift = 1 is not a vec2; allowed: {x, y}, each -8…8");
  EXPECT_EQ(error("fx.glow { knee = print }"),
            "preset.lua:3: error: glow.knee = a function is not a number; allowed: 0…1");
}

TEST_F(SettingMessages, NotFinite) {
  EXPECT_EQ(error("fx.glow { gain = 1/0 }"), "preset.lua:3: error: glow.gain = inf is not finite; allowed: ≥ 0");
  EXPECT_EQ(error("fx.glow { exposure = -(0/0) }"),
            "preset.lua:3: error: glow.exposure = nan is not finite; allowed: a number");
  EXPECT_EQ(error("fx.glow { steps = 1/0 }"),
            "preset.lua:3: error: glow.steps = inf is not finite; allowed: integer 0…16");
  EXPECT_EQ(
      error("fx.glow { tint = { 1, 1/0, 1 } }"),
      "preset.lua:3: error: glow.tint = {1, inf, 1} is not finite; allowed: {r, g, b} with numbers ≥ 0, \"#rrggbb\"");
  EXPECT_EQ(error("fx.glow { gain = 9e57 }"),
            "preset.lua:3: error: glow.gain = 9e+57 is larger than a 32-bit float holds; allowed: ≥ 0");
  EXPECT_EQ(
      error("fx.glow { tint = { 1, 1e39, 1 } }"),
      "preset.lua:3: error: glow.tint = {1, 1e+39, 1} is larger than a 32-bit float holds; allowed: {r, g, b} with "
      "numbers ≥ 0, \"#rrggbb\"");
}

TEST_F(SettingMessages, EntryKeys) {
  EXPECT_EQ(
      error("fx.glow { at = \"post_proces\" }"),
      "preset.lua:3: error: unknown injection point 'post_proces'; allowed: after_opaque_and_sky, before_post_process, "
      "post_process, after_post_process; did you mean 'post_process'?");
  EXPECT_EQ(error("fx.glow {\n order = 1.5 }"),
            "preset.lua:4: error: fx.glow: order = 1.5 is not an integer; allowed: integer −1000000…1000000");
  EXPECT_EQ(error("fx.glow { enabled = 0 }"),
            "preset.lua:3: error: fx.glow: enabled = 0 is not a boolean; allowed: true, false");
  EXPECT_EQ(error("fx.glow { required = \"yes\" }"),
            "preset.lua:3: error: fx.glow: required = \"yes\" is not a boolean; allowed: true, false");
  EXPECT_EQ(error("fx.glow { name = \"a.b\" }"),
            "preset.lua:3: error: 'a.b' cannot be the name of an entry; allowed: 1 to 64 letters, digits, '_' and '-'");
  EXPECT_EQ(
      error("fx.glow { 0.5 }"),
      std::string("preset.lua:3: error: effect 'glow' has a value without a name at position 1; allowed: ") + kNames);
  EXPECT_EQ(error("fx.glow \"soft\""),
            "preset.lua:3: error: fx.glow takes a table, not \"soft\"; allowed: fx.glow { … }");
  EXPECT_EQ(error("fx.glow()"), "preset.lua:3: error: fx.glow takes a table, not nil; allowed: fx.glow { … }");
  EXPECT_EQ(error("fx.glow { [true] = 1 }"), "preset.lua:3: error: fx.glow has a key that is true");
}

TEST_F(SettingMessages, TheFirstOfSeveralMistakesIsReported) {
  EXPECT_EQ(error("fx.glow {\n steps = 4.5,\n fade = 1,\n aaa = 2 }"),
            "preset.lua:4: error: glow.steps = 4.5 is not an integer; allowed: integer 0…16");
  EXPECT_EQ(error("fx.glow {\n knee = 0.5,\n knee = 7,\n}"),
            "preset.lua:5: error: glow.knee = 7 is out of range; allowed: 0…1");
}

TEST_F(SettingMessages, LinesInModulesAndWithoutATableAreFound) {
  scene.write("looks.lua", "local fx = require \"afterglow\"\nlocal t = {\n  knee = 3,\n}\nreturn fx.glow(t)\n");
  EXPECT_EQ(error("require \"looks\""), "looks.lua:5: error: glow.knee = 3 is out of range; allowed: 0…1");
}

TEST_F(SettingMessages, Stacks) {
  EXPECT_EQ(
      error("nmae = \"x\""),
      "preset.lua:3: error: fx.stack has no 'nmae'; allowed: alpha, gamut, input_space, max_error, name, position, "
      "reference_height, requires; did you mean 'name'?");
  EXPECT_EQ(error("fx.glow {},\n5"),
            "preset.lua:4: error: fx.stack: position 2 is 5, not an effect or a volume; allowed: fx.NAME { … }, "
            "fx.group { … }, fx.mix { … }, fx.volume { … }, a list of them");
  EXPECT_EQ(error("fx.stack { fx.glow {} }"),
            "preset.lua:3: error: fx.stack: position 1 is a stack, which goes into fx.group { … } here; allowed: "
            "fx.NAME { … }, "
            "fx.group { … }, fx.mix { … }, fx.volume { … }, a list of them");
  EXPECT_EQ(error("fx:glow { knee = 3 }"),
            "preset.lua:3: error: fx.glow is called with a colon; allowed: fx.glow { … }, with a point");
  EXPECT_EQ(error("fx:glow()"),
            "preset.lua:3: error: fx.glow is called with a colon; allowed: fx.glow { … }, with a point");
  EXPECT_EQ(error("fx.mask:luma { from = 3 }"),
            "preset.lua:3: error: fx.mask.luma is called with a colon; allowed: fx.mask.luma { … }, with a point");
  EXPECT_EQ(error("fx.glow({}, { knee = 3 })"),
            "preset.lua:3: error: fx.glow takes one table; behind it stands a table; allowed: fx.glow { … }");
  EXPECT_EQ(error("fx.glow"),
            "preset.lua:3: error: fx.stack: position 1 is an effect without settings; allowed: fx.NAME { … }, "
            "fx.group { … }, fx.mix { … }, fx.volume { … }, a list of them");
  EXPECT_EQ(error("fx.glow { name = \"a\" },\nfx.glow { name = \"a\" }"),
            "preset.lua:4: error: fx.stack: two entries are named 'a'");
  EXPECT_EQ(error("max_error = -1"), "preset.lua:3: error: fx.stack: max_error = -1 is out of range; allowed: > 0");
  EXPECT_EQ(error("max_error = \"a\""), "preset.lua:3: error: fx.stack: max_error = \"a\" is not a finite number");
  EXPECT_EQ(error("name = 5"), "preset.lua:3: error: fx.stack: name = 5 is not a text");
}

TEST_F(SettingMessages, PresetsThatReturnSomethingElse) {
  const auto returned = [&](const std::string& what) {
    scene.preset("local fx = require \"afterglow\"\n" + what);
    return scene.load_error();
  };
  EXPECT_EQ(returned("return 5"), "preset.lua: error: a preset must return fx.stack { … }, not 5");
  EXPECT_EQ(returned("return { fx.glow {} }"), "preset.lua: error: a preset must return fx.stack { … }, not a table");
  EXPECT_EQ(returned("return fx.glow {}"),
            "preset.lua: error: a preset must return fx.stack { … }, not an effect entry");
  EXPECT_EQ(returned("return fx.stack"), "preset.lua: error: a preset must return fx.stack { … }, not a function");
}

TEST_F(SettingMessages, SyntaxAndRunTimeErrors) {
  scene.preset("local fx = require \"afterglow\"\nreturn fx.stack {\n  fx.glow {\n}\n");
  EXPECT_EQ(scene.load_error(), "preset.lua:5: error: '}' expected (to close '{' at line 2) near <eof>");
  scene.preset("local a = nil\nlocal b = 1\nreturn a.b\n");
  EXPECT_EQ(scene.load_error(), "preset.lua:3: error: attempt to index a nil value (local 'a')");
  scene.preset("\nerror(\"no \\n good\")\n");
  EXPECT_EQ(scene.load_error(), "preset.lua:2: error: no   good");
  scene.preset("local function f() error(\"bad\", 2) end\n\n\nf()\n");
  EXPECT_EQ(scene.load_error(), "preset.lua:4: error: bad");
  scene.preset("\n\nassert(false, \"told you\")");
  EXPECT_EQ(scene.load_error(), "preset.lua:3: error: told you");
  scene.preset("local s = string.rep()");
  EXPECT_EQ(scene.load_error(), "preset.lua:1: error: bad argument #1 to 'rep' (string expected, got no value)");
  scene.preset("\nlocal s = (\"%d\"):format(1.5)");
  EXPECT_EQ(scene.load_error(),
            "preset.lua:2: error: bad argument #2 to 'string.format' (number has no integer representation)");
  scene.preset("\nlocal s = (\"x\"):rep(1e9)");
  EXPECT_EQ(scene.load_error(), "preset.lua:2: error: memory limit reached: more than 64 MiB");
}

TEST_F(SettingMessages, SignsThatWordProcessorsMake) {
  scene.preset("local fx = require “afterglow”\n");
  EXPECT_EQ(scene.load_error(),
            "preset.lua:1: error: unexpected symbol near '“'; allowed: plain quotes: \"text\" or 'text'");
  scene.preset("-- “\nlocal a = \"“\" .. 3 – 4\n");
  EXPECT_EQ(scene.load_error(), "preset.lua:2: error: unexpected symbol near '–'; allowed: a plain minus: -");
  scene.preset("--[[ it's\nit's ]] local a = “x”\n");
  EXPECT_EQ(scene.load_error(),
            "preset.lua:2: error: unexpected symbol near '“'; allowed: plain quotes: \"text\" or 'text'");
  scene.preset("local grün = 1\n");
  EXPECT_EQ(scene.load_error(),
            "preset.lua:1: error: unexpected symbol near 'ü'; allowed: letters, digits and signs of ASCII, outside of "
            "texts and comments");
  scene.preset("local a = \xFF\n");
  EXPECT_NE(scene.load_error().find("preset.lua:1: error: "), std::string::npos);
}

TEST_F(SettingMessages, MissingPreset) {
  EXPECT_EQ(scene.load_error(), "preset.lua: error: no such file");
  EXPECT_EQ(scene.load().error().kind, ErrorKind::script);
}

TEST_F(SettingMessages, AllAreScriptErrors) {
  scene.stack("fx.glow { knee = 2 }");
  EXPECT_EQ(scene.load().error().kind, ErrorKind::script);
}

/// Sums of animated values miss their ends by a rounding.
TEST_F(SettingMessages, BeyondABoundByARoundingIsTheBound) {
  scene.stack("fx.glow { knee = 0.3 - 0.1 * 3, tint = { 0.3 - 0.1 * 3, 1, 1 } }, fx.glow { knee = 1 + 1e-12 }");
  const auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  const auto value = [&](std::size_t entry, const std::string& name) {
    for (const auto& [key, of] : preset->entries()[entry].settings)
      if (key == name) return of.number[0];
    return -1.0;
  };
  EXPECT_EQ(value(0, "knee"), 0);
  EXPECT_EQ(value(0, "tint"), 0);
  EXPECT_EQ(value(1, "knee"), 1);
  scene.stack("fx.glow { knee = 1.000001 }");
  EXPECT_EQ(scene.load_error(), "preset.lua:3: error: glow.knee = 1.000001 is out of range; allowed: 0…1");
  scene.stack("fx.glow { knee = -0.000001 }");
  EXPECT_NE(scene.load_error().find("is out of range"), std::string::npos);
}

TEST_F(SettingMessages, WholeNumbersAreExactAtTheirEnds) {
  scene.effect("ids", R"(
      settings = { index = fx.int { min = 0, max = 16777215, default = 0 } },
      build = function(g, s, source) return source end,)");
  const std::string range = " is out of range; allowed: integer 0…16777215";
  EXPECT_EQ(error("fx.ids { index = 16777216 }"), "preset.lua:3: error: ids.index = 16777216" + range);
  EXPECT_EQ(error("fx.ids { index = 4000000000 }"), "preset.lua:3: error: ids.index = 4000000000" + range);
  scene.stack("fx.ids { index = 16777215 }");
  EXPECT_TRUE(scene.load());
}

TEST_F(SettingMessages, ValuesThatAreFine) {
  scene.stack(
      R"(fx.glow { steps = 4.0, tint = "#ff8000", shift = { -8, 8 }, mode = "scattering", fade = true, gain = -0.0 },
                 fx.glow { tint = { 4, 0, 0.5 } })");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  const auto& settings = preset->entries()[0].settings;
  const auto text = [&](const std::string& name) {
    for (const auto& [key, value] : settings)
      if (key == name) return value.text();
    return std::string("missing");
  };
  EXPECT_EQ(text("steps"), "4");
  EXPECT_EQ(text("mode"), "\"scattering\"");
  EXPECT_EQ(text("fade"), "true");
  EXPECT_EQ(text("gain"), "0");
  EXPECT_EQ(text("shift"), "{-8, 8}");
  ASSERT_EQ(settings[7].first, "tint");
  EXPECT_DOUBLE_EQ(settings[7].second.number[0], 1);
  EXPECT_NEAR(settings[7].second.number[1], 0.21586050011389926, 1e-12);  // sRGB 128/255
  EXPECT_DOUBLE_EQ(settings[7].second.number[2], 0);
  EXPECT_EQ(preset->entries()[1].settings[7].second.text(), "{4, 0, 0.5}");
}

}  // namespace
}  // namespace afterglow::test
