// SPDX-License-Identifier: MIT
// Exit code 3: whatever is wrong with a preset, an effect or a shader.
#include "cli_test.h"

namespace afterglow::test {
namespace {

struct BadPreset {
  std::string label, text;
  std::vector<std::string> messages;  ///< parts of what is said
  double within = 30;                 ///< seconds; generous, for hostile scripts that must be stopped at all
};

void PrintTo(const BadPreset& preset, std::ostream* out) { *out << preset.label; }

constexpr const char* kUse = "local fx = require \"afterglow\"\n";

class BadPresets : public CliTest, public ::testing::WithParamInterface<BadPreset> {};

TEST_P(BadPresets, EndRunAndCheckWithExitCode3) {
  make_exr("a.exr");
  write("look.lua", GetParam().text);
  const auto before = files();
  for (const auto& arguments :
       {std::vector<std::string>{"run", "look.lua", "a.exr", "-o", "a.png"}, {"check", "look.lua"}}) {
    const Outcome outcome = run(arguments);
    SCOPED_TRACE(arguments.front() + ": " + outcome.err);
    EXPECT_EQ(outcome.exit_code, kScript);
    for (const auto& message : GetParam().messages) EXPECT_THAT(outcome.err, HasSubstr(message));
    EXPECT_LT(outcome.seconds, GetParam().within);
    EXPECT_EQ(files(), before) << "something was left behind";
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cli, BadPresets,
    ::testing::Values(BadPreset{"syntax", "return fx.stack {\n", {"look.lua:", "error: "}},
                      BadPreset{"run_time", std::string(kUse) + "local x = nil\nreturn x.y\n", {"look.lua:3: error: "}},
                      BadPreset{"utf16", {"\xFF\xFEr\0e\0", 6}, {"look.lua: error: is UTF-16; save it as UTF-8"}},
                      BadPreset{"utf16_bare", {"r\0e\0t\0u\0r\0n\0", 12}, {"look.lua: error: is UTF-16"}},
                      BadPreset{"utf16_big", {"\xFE\xFF\0r", 4}, {"is UTF-16"}},
                      BadPreset{"no_stack", "return 1\n", {"look.lua", "error: "}},
                      BadPreset{"unknown_effect",
                                std::string(kUse) + "return fx.stack { fx.blom {} }\n",
                                {"look.lua:2: error: ", "did you mean 'bloom'?"}},
                      BadPreset{"unknown_library_function",
                                std::string(kUse) + "return fx.stak { }\n",
                                {"look.lua:2: error: unknown effect 'stak'", "int, ", "did you mean 'stack'?"}},
                      BadPreset{
                          "unknown_setting_of_a_mask",
                          std::string(kUse) + "return fx.stack { fx.bloom { mask = fx.mask.luma { form = 1 } } }\n",
                          {"look.lua:2: error: mask 'luma' has no setting 'form'", "did you mean 'from'?"}},
                      BadPreset{"unknown_setting",
                                std::string(kUse) + "return fx.stack {\n  fx.bloom {\n    intensty = 1 } }\n",
                                {"look.lua:4: error: ", "did you mean 'intensity'?"}},
                      BadPreset{"out_of_range",
                                std::string(kUse) + "return fx.stack { fx.bloom { knee = 2 } }\n",
                                {"look.lua:2: error: ", "allowed: "}},
                      BadPreset{"wrong_choice",
                                std::string(kUse) + "return fx.stack { fx.tone_mapping { mode = \"acess\" } }\n",
                                {"look.lua:2: error: ", "did you mean 'aces'?"}},
                      BadPreset{"wrong_type",
                                std::string(kUse) + "return fx.stack { fx.bloom { knee = \"soft\" } }\n",
                                {"look.lua:2: error: "}},
                      BadPreset{"endless", "while true do end\n", {"look.lua", "instruction budget"}},
                      BadPreset{"endless_in_pcall",
                                "while true do pcall(function() while true do end end) end\n",
                                {"look.lua", "instruction budget"}},
                      BadPreset{"memory",
                                "local t = {}\nfor i = 1, 1e9 do t[i] = (\"x\"):rep(1e6) .. i end\n",
                                {"look.lua", "memory limit"}},
                      BadPreset{"file_access", "local f = io.open(\"/etc/passwd\")\n", {"look.lua:1: error: "}}),
    [](const auto& info) { return info.param.label; });

class PresetErrors : public CliTest {
 protected:
  /// A preset whose one effect has this shader.
  void make_effect(const std::string& shader) const {
    write("look.lua", std::string(kUse) + "return fx.stack { fx.mine {} }\n");
    write("effects/mine.lua",
          std::string(kUse) +
              "return fx.effect { name = \"mine\", doc = \"A test.\", at = \"post_process\", order = 1,\n"
              "  settings = {}, build = function(g, s, source)\n"
              "    return g:pass { shader = \"mine/mine\", source = source } end }\n");
    write("shaders/mine/mine.glsl", shader);
  }
};

TEST_F(PresetErrors, EveryGlslErrorHasItsFileAndLine) {
  make_effect("vec4 apply(vec4 color) {\n  color.r = one;\n  color.g = two;\n  return three;\n}\n");
  make_exr("a.exr");
  for (const auto& command :
       {std::vector<std::string>{"check", "look.lua"}, {"run", "look.lua", "a.exr", "-o", "b.exr"}}) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, kScript);
    for (const char* place : {"mine.glsl:2: error: 'one'", "mine.glsl:3: 'two'", "mine.glsl:4: 'three'"})
      EXPECT_THAT(outcome.err, HasSubstr(place)) << command[0];
  }
}

TEST_F(PresetErrors, CheckCompilesWhatRunsInALaterFrame) {
  make_effect("vec4 apply(vec4 color) {\n  return colour;\n}\n");
  const auto check = [&](const std::string& opacity, std::vector<std::string> more = {}) {
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.mine { opacity = " + opacity + " } }\n");
    more.insert(more.begin(), {"check", "look.lua"});
    return run(more);
  };
  for (const char* opacity : {"fx.curve { { 1, 0 }, { 5, 1 } }", "function(t) return t.frame > 100 and 1 or 0 end"}) {
    const Outcome later = check(opacity);
    EXPECT_EQ(later.exit_code, kScript) << opacity;
    EXPECT_THAT(later.err, HasSubstr("mine.glsl:2: error: 'colour'")) << opacity;
  }
  const Outcome never = check("fx.curve { { 3000, 0 }, { 5000, 1 } }");
  EXPECT_EQ(never.exit_code, kDone) << never.err;
  EXPECT_THAT(never.out,
              HasSubstr("note: 'mine' runs in none of the frames that were tried: its shaders are not compiled"));
  EXPECT_EQ(check("fx.curve { { 3000, 0 }, { 5000, 1 } }", {"--frame", "4000"}).exit_code, kScript);
  const Outcome off = check("0");
  EXPECT_EQ(off.exit_code, kDone) << off.err;
  EXPECT_EQ(off.out.find("note:"), std::string::npos) << off.out;
}

TEST_F(PresetErrors, GlslErrorNamesTheAuthorsFileAndLine) {
  make_effect("// a comment\nvec4 apply(vec4 color) {\n  return colour;\n}\n");
  make_exr("a.exr");
  for (const auto& arguments :
       {std::vector<std::string>{"check", "look.lua"}, {"run", "look.lua", "a.exr", "-o", "a.png"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kScript);
    EXPECT_THAT(outcome.err, HasSubstr("mine.glsl:3: error: "));
    EXPECT_THAT(outcome.err, HasSubstr("colour"));
  }
  EXPECT_FALSE(fs::exists(path("a.png")));
}

TEST_F(PresetErrors, MissingShaderNamesTheNearest) {
  make_effect("vec4 apply(vec4 color) { return color; }\n");
  fs::rename(path("shaders/mine/mine.glsl"), path("shaders/mine/mime.glsl"));
  const Outcome outcome = run({"check", "look.lua"});
  EXPECT_EQ(outcome.exit_code, kScript);
  EXPECT_THAT(outcome.err, HasSubstr("mine/mine"));
  EXPECT_THAT(outcome.err, HasSubstr("did you mean 'mine/mime'?"));
}

TEST_F(PresetErrors, MissingPresetIsNamed) {
  for (const auto& arguments : {std::vector<std::string>{"check", "none.lua"}, {"graph", "none.lua"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_THAT(outcome.exit_code, ::testing::AnyOf(kScript, kFiles));
    EXPECT_TRUE(is_one_error_line(outcome.err));
    EXPECT_THAT(outcome.err, HasSubstr("none.lua"));
  }
}

TEST_F(PresetErrors, WhoCallsAnotherScriptsFunctionIsTold) {
  write("lib/glows.lua", std::string(kUse) +
                             "return { warm = function(intensity)\n"
                             "  return fx.bloom { intensity = intensity }\nend }\n");
  write("called.lua", std::string(kUse) +
                          "local glows = require \"lib.glows\"\nreturn fx.stack {\n"
                          "  glows.warm(0.3),\n  glows.warm(-3),\n}\n");
  EXPECT_THAT(run({"check", "called.lua"}).err,
              ::testing::MatchesRegex("[^\n]*lib/glows.lua:3: error: bloom.intensity = -3 is out of range[^\n]*\n"
                                      "  called at called.lua:5\n"));
}

TEST_F(PresetErrors, OtherNamesOfPresetsAndModulesAreUnderstood) {
  make_preset("own_look.lua");
  write("lib/glows.lua", "return {}\n");
  write("extends.lua", std::string(kUse) + "return fx.extend \"own_look.lua\" {}\n");
  EXPECT_THAT(run({"check", "extends.lua"}).err, HasSubstr("did you mean 'own_look'?"));
  write("requires.lua", "require \"Lib.Glows\"\n");
  EXPECT_THAT(run({"check", "requires.lua"}).err, HasSubstr("did you mean 'lib.glows'?"));
}

TEST_F(PresetErrors, PictureInThePresetsPlaceIsCalledOne) {
  make_preset("look.lua");
  make_exr("a.exr");
  ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", "a.png"}).exit_code, kDone);
  for (const char* picture : {"a.exr", "a.png"}) {
    const Outcome outcome = run({"run", picture, "look.lua", "-o", "b.png"});
    EXPECT_EQ(outcome.exit_code, kScript);
    EXPECT_EQ(outcome.err, picture + std::string(": error: is a picture, not a preset; allowed: a Lua file, then the "
                                                 "pictures\n"));
    for (const auto& arguments :
         {std::vector<std::string>{"bench", "look.lua", picture, "--quick"}, {"stress", picture}})
      EXPECT_THAT(run(arguments).err, HasSubstr(picture + std::string(": error: is a picture, not a preset")));
  }
}

TEST_F(PresetErrors, MaskThatAnEntryLacksIsNamed) {
  make_preset("look.lua");
  const std::string setting = "tone_mapping.mask.radial.radius", value = setting + "=0.4,0.3";
  EXPECT_THAT(run({"set", "look.lua", value}).err, HasSubstr("error: entry 'tone_mapping' has no mask 'radial'"));
  EXPECT_THAT(run({"check", "look.lua", "--set", value}).err, HasSubstr("the entry has no mask 'radial'"));
  EXPECT_THAT(run({"explain", "look.lua", setting}).err, HasSubstr("'tone_mapping' has no mask 'radial'"));
}

TEST_F(PresetErrors, WrongOverrideNamesTheNearest) {
  make_preset("look.lua");
  Outcome outcome = run({"check", "look.lua", "--set", "tone_maping.mode=aces"});
  EXPECT_THAT(outcome.exit_code, ::testing::AnyOf(kUsage, kScript));
  EXPECT_TRUE(is_one_error_line(outcome.err));
  EXPECT_THAT(outcome.err, HasSubstr("did you mean 'tone_mapping'?"));
  outcome = run({"check", "look.lua", "--set", "tone_mapping.mode=aaces"});
  EXPECT_THAT(outcome.exit_code, ::testing::AnyOf(kUsage, kScript));
  EXPECT_THAT(outcome.err, HasSubstr("did you mean 'aces'?"));
}

}  // namespace
}  // namespace afterglow::test
