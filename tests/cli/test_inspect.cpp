// SPDX-License-Identifier: MIT
// check, graph and effects: what they tell about a preset.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli_test.h"

namespace afterglow::test {
namespace {

using nlohmann::json;

class Inspect : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    // Listed against the order in which they run.
    write("look.lua",
          "local fx = require \"afterglow\"\n"
          "return fx.stack { name = \"Test\",\n"
          "  fx.color_adjustments { contrast = 15 },\n"
          "  fx.tone_mapping { mode = \"none\" },\n"
          "  fx.bloom { intensity = 0.3 } }\n");
  }

  json parsed(const std::vector<std::string>& arguments) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }
};

TEST_F(Inspect, CheckShowsOrderAndSettings) {
  const Outcome outcome = run({"check", "look.lua"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  const auto bloom = outcome.out.find("1. bloom"), color = outcome.out.find("2. color_adjustments"),
             tone = outcome.out.find("3. tone_mapping");
  ASSERT_NE(bloom, std::string::npos) << outcome.out;
  EXPECT_LT(bloom, color);
  EXPECT_LT(color, tone);
  EXPECT_THAT(outcome.out, ContainsRegex("intensity +0\\.3\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("scatter +0\\.7 +\\(default\\)"));
  EXPECT_THAT(outcome.out, HasSubstr("skipped: "));
  EXPECT_THAT(outcome.out, HasSubstr("no errors"));
}

TEST_F(Inspect, CheckTellsWhatRunsInAnotherOrderThanItIsWritten) {
  const auto check = [&](const std::string& entries) {
    write("order.lua", "local fx = require \"afterglow\"\nreturn fx.stack {\n" + entries + "}\n");
    return run({"check", "order.lua"}).out;
  };
  EXPECT_THAT(check("fx.tone_mapping {},\nfx.exposure { ev = 1 },\n"),
              HasSubstr("note: runs before 'tone_mapping', which is written above it"));
  EXPECT_THAT(check("fx.exposure { ev = 1 },\nfx.tone_mapping {},\n"), Not(HasSubstr("note:")));
  EXPECT_THAT(check("fx.tone_mapping {}, fx.exposure { ev = 1 }, "), HasSubstr("note: runs before 'tone_mapping'"));
  // Made in another order than they stand in the list, and in groups of their own.
  write("order.lua",
        "local fx = require \"afterglow\"\nlocal late = fx.tone_mapping {}\n"
        "return fx.stack { fx.exposure { ev = 1 },\nlate,\n"
        "fx.group { at = \"final\", fx.vignette { intensity = 1 } },\n"
        "fx.group { at = \"final\", fx.sharpen {} } }\n");
  EXPECT_THAT(run({"check", "order.lua"}).out, Not(HasSubstr("note: runs before")));
}

TEST_F(Inspect, EffectsThatNoStackCanNameAreTold) {
  const std::string text =
      "return require(\"afterglow\").effect { name = \"mine\", build = function(g, s, i) return i end }";
  for (const char* name : {"my-glow", "group", "color"}) write(std::string("effects/") + name + ".lua", text);
  const Outcome outcome = run({"effects", "--path", "."});
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_THAT(outcome.err, HasSubstr("effects/my-glow.lua is left out: the name of an effect has letters, digits and "
                                     "'_' alone"));
  EXPECT_THAT(outcome.err, HasSubstr("effects/group.lua is left out: fx.group is a name of the library"));
  EXPECT_THAT(outcome.err, HasSubstr("effects/color.lua is left out: fx.color is a name of the library"));
}

TEST_F(Inspect, UnknownNamesInShadersAreToldWithTheNearest) {
  write("effects/mine.lua",
        "return require(\"afterglow\").effect { name = \"mine\", build = function(g, s, image)\n"
        "return g:pass { shader = \"mine\", source = image, amount = 1 } end }");
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.mine {} }");
  const auto error = [&](const std::string& factor) {
    write("shaders/mine.glsl", "uniform float amount;\nvec4 apply(vec4 color) { return color * " + factor + "; }\n");
    const std::string text = run({"check", "look.lua"}).err;
    const auto begin = text.find("glsl:2: error: ");
    return begin == std::string::npos ? text : text.substr(begin + 15, text.find('\n') - begin - 15);
  };
  EXPECT_EQ(error("luminance(color.rgb)"),
            "'luminance' is not known here; lib/color.glsl has it: #include \"lib/color.glsl\"");
  EXPECT_EQ(error("smothstep(0.0, 1.0, amount)"),
            "'smothstep': no matching overloaded function found; did you mean 'smoothstep'?");
  EXPECT_EQ(error("fecth(color, ivec2(0))"), "'fecth': no matching overloaded function found; did you mean 'fetch'?");
  EXPECT_EQ(error("amuont"), "'amuont': undeclared identifier; did you mean 'amount'?");
  EXPECT_EQ(error("mix(color)"), "'mix': no matching overloaded function found");
}

TEST_F(Inspect, LevelsOfImagesAreAWarningAndModfIsNone) {
  write("effects/mine.lua",
        "return require(\"afterglow\").effect { name = \"mine\", build = function(g, s, image)\n"
        "return g:pass { shader = \"mine\", source = image } end }");
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.mine {} }");
  const auto told = [&](const std::string& body) {
    write("shaders/mine.glsl",
          "uniform sampler2D source;\nvec4 sample_at(ivec2 p) {\n  vec2 at = (vec2(p) + 0.5) / vec2(target_size());\n" +
              body + "\n}\n");
    const Outcome outcome = run({"check", "look.lua"});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return outcome.err;
  };
  const std::string warning =
      "shaders/mine.glsl:4: a level of an image that is not 0 is read as level 0: images have one";
  for (const char* read : {"textureLod(source, at, 5.0)", "texelFetch(source, p, 2)", "texture(source, at, 1.0)",
                           "textureLod(source, at, at.x)"})
    EXPECT_THAT(told(std::string("  return ") + read + ";"), HasSubstr(warning)) << read;
  for (const char* read : {"textureLod(source, at, 0.0)", "texelFetch(source, p, 0)", "texture(source, at)",
                           "texelFetch(source, p, int(0))"})
    EXPECT_THAT(told(std::string("  return ") + read + ";"), IsEmpty()) << read;
  EXPECT_THAT(
      told("  float whole;\n  float part = modf(at.x, whole);\n  return vec4(whole, part, 0.0, fetch(source, p).a);"),
      IsEmpty());
  EXPECT_THAT(told("  float whole;\n  float part = whole;\n  modf(at.x, whole);\n  return vec4(whole, part, 0.0, "
                   "fetch(source, p).a);"),
              HasSubstr("'whole' may be read before it has a value"));
}

TEST_F(Inspect, AMaskThatCanSelectNothingIsAWarning) {
  const auto told = [&](const std::string& mask) {
    write("masked.lua",
          "local fx = require \"afterglow\"\nreturn fx.stack { fx.exposure { ev = 1, mask = " + mask + " } }");
    return run({"check", "masked.lua"}).err;
  };
  const std::string warning = "warning: effect 'exposure' is skipped: its mask selects nothing: ";
  EXPECT_THAT(told("fx.mask.luma { to = 0.2 }"), HasSubstr(warning + "luma: from is above to"));
  EXPECT_THAT(told("fx.mask.file {}"), HasSubstr(warning + "file: no file is named"));
  EXPECT_THAT(told("fx.mask.radial {} * fx.mask.layer {}"), HasSubstr(warning + "layer: no layer is named"));
  EXPECT_THAT(told("fx.mask.radial { radius = { 0, 1 } }"), Not(HasSubstr("warning"))) << "it may be animated";
  EXPECT_THAT(told("0"), Not(HasSubstr("warning")));
}

TEST_F(Inspect, CheckAsJson) {
  const json check = parsed({"check", "look.lua", "--json", "--set", "bloom.scatter=0.5"});
  ASSERT_EQ(check.at("entries").size(), 3u);
  const auto& bloom = check.at("entries").at(0);
  EXPECT_EQ(bloom.at("effect"), "bloom");
  EXPECT_EQ(bloom.at("settings").at("scatter"), 0.5);
  EXPECT_THAT(bloom.at("changed").get<std::vector<std::string>>(),
              ::testing::UnorderedElementsAre("intensity", "scatter"));
  EXPECT_TRUE(check.at("entries").at(2).contains("skipped"));
}

TEST_F(Inspect, CheckTellsTheLightOfEachEntryAndWhatStandsWrong) {
  write("wrong.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.stack { fx.tone_mapping {}, fx.bloom {},\n"
        "  fx.sharpen { at = \"post_process\", order = 10 },\n"
        "  fx.exposure { ev = 1, at = \"after_post_process\" } }\n");
  const Outcome outcome = run({"check", "wrong.lua"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("1. sharpen  at post_process, order 10; scene-linear light\n   warning: 'sharpen' is "
                        "made for display-linear light, but 'tone_mapping', which makes it, comes behind "
                        "it\n"));
  EXPECT_THAT(outcome.out, HasSubstr("2. bloom  at post_process, order 100; scene-linear light\n"));
  EXPECT_THAT(outcome.out,
              HasSubstr("3. tone_mapping  at post_process, order 200; scene-linear light to display-linear\n"));
  EXPECT_THAT(outcome.out, HasSubstr("4. exposure  at after_post_process, order 0; display-linear light\n   warning: "
                                     "'exposure' is made for scene-linear light, but 'tone_mapping' before it makes "
                                     "display-linear light\n"));
  EXPECT_THAT(outcome.out, HasSubstr(": no errors, 2 warnings\n"));
  make_exr("a1.exr");
  make_exr("a2.exr");
  const Outcome made = run({"run", "wrong.lua", "a#.exr", "-o", "b#.png"});
  EXPECT_EQ(made.exit_code, kDone) << made.err;
  EXPECT_EQ(std::ranges::count(made.err, '\n'), 2) << "each is told once: " << made.err;
  EXPECT_THAT(made.err, HasSubstr("wrong.lua:3: 'sharpen' is made for display-linear light"));
  EXPECT_THAT(made.err, HasSubstr("wrong.lua:4: 'exposure' is made for scene-linear light"));
  EXPECT_THAT(run({"explain", "wrong.lua"}).out, HasSubstr("warning: 'exposure' is made for scene-linear light"));
  const json check = parsed({"check", "wrong.lua", "--json"});
  EXPECT_EQ(check.at("entries").at(2).at("light"),
            (json{{"before", "scene-linear"}, {"behind", "display-linear"}, {"needs", "scene-linear"}}));
  write("idle.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.lut {} }\n");
  const Outcome idle = run({"check", "idle.lua"});
  EXPECT_THAT(idle.err, HasSubstr("effect 'lut' is skipped: file is not given"));
  EXPECT_THAT(idle.out, HasSubstr(": no errors, 1 warning\n"));
  EXPECT_THAT(run({"run", "idle.lua", "a#.exr", "-o", "b#.png"}).err, HasSubstr("'lut' is skipped: file is not given"));
  // Without a curve nothing is known of the picture; one that is off makes nothing.
  EXPECT_THAT(run({"check", "wrong.lua", "--set", "tone_mapping.mode=none"}).out, Not(HasSubstr("warning")));
}

TEST_F(Inspect, CheckLoadsNoImageLibraries) {
  // Listed, not run: a hundred libraries behind OpenImageIO would cost `check` its speed.
  RunOptions options;
  options.environment["LD_TRACE_LOADED_OBJECTS"] = "1";
  const Outcome outcome = run({"check", "look.lua"}, options);
  EXPECT_THAT(outcome.out, HasSubstr("liblua"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("libOpenImageIO")));
}

/// A third of 1920 is whole, a third of 1279 is not.
TEST_F(Inspect, CheckTriesOddSizes) {
  write(
      "effects/third.lua",
      "local fx = require \"afterglow\"\nreturn fx.effect { name = \"third\", doc = \"T.\", at = \"post_process\", "
      "order = 50, build = function(g, s, source)\n  local small = g:pass { shader = \"third/same\", source = source, "
      "size = { source.width / 3, source.height } }\n"
      "  return g:pass { shader = \"third/same\", source = small, size = source }\nend }\n");
  write("shaders/third/same.glsl",
        "uniform sampler2D source;\nvec4 sample_at(ivec2 pixel) { return fetch(source, pixel); }\n");
  write("third.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.third {} }\n");
  const Outcome outcome = run({"check", "third.lua"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("pictures of 1279x719 pixels: "));
  EXPECT_THAT(outcome.err, HasSubstr("effects/third.lua:3: "));
  EXPECT_THAT(run({"check", "look.lua"}).err, Not(HasSubstr("pictures of")));
}

/// What effects behind it divide by.
TEST_F(Inspect, CheckTellsOfAnAlphaThatIsANumber) {
  const auto said = [&](const std::string& glsl, const std::string& more = "") {
    write("effects/plain.lua",
          "local fx = require \"afterglow\"\nreturn fx.effect { name = \"plain\", doc = \"P.\", at = \"post_process\", "
          "order = 50, " +
              more + "build = function(g, s, source) return g:pass { shader = \"plain/it\", source = source } end }\n");
    write("shaders/plain/it.glsl", glsl);
    write("plain.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.plain {}, fx.tone_mapping {} }\n");
    const Outcome outcome = run({"check", "plain.lua"});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(said("vec4 apply(vec4 color) {\n  return vec4(color.rgb * 2.0, 1.0);\n}\n"),
              HasSubstr("shaders/plain/it.glsl:2: effect 'plain' makes an alpha that is a number"));
  EXPECT_THAT(said("vec4 apply(vec4 color) { return vec4(color.rgb * 2.0, 1.0); }\n", "alpha = \"straight\", "),
              testing::IsEmpty())
      << "the engine's";
  EXPECT_THAT(said("vec4 apply(vec4 color) { return vec4(color.rgb * 2.0, color.a); }\n"), testing::IsEmpty());
  EXPECT_THAT(said("vec4 apply(vec4 color) {\n  if (color.a == 0.0) return vec4(0.0, 0.0, 0.0, 0.0);\n"
                   "  return color * 2.0; }\n"),
              testing::IsEmpty())
      << "where there is nothing";
}

TEST_F(Inspect, CheckReportsWhatIsGivenTwice) {
  write("twice.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack {\n  fx.bloom { intensity = 0.3,\n    threshold = 1,\n"
        "    intensity = 0.5 } }\n");
  const Outcome outcome = run({"check", "twice.lua"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, ContainsRegex("twice.lua:5: 'intensity' is given twice in one table; this one counts, not "
                                         "that of line 3"));
  EXPECT_THAT(outcome.out, HasSubstr("no errors, 1 warning"));
  EXPECT_THAT(run({"check", "look.lua"}).err, testing::IsEmpty());
}

TEST_F(Inspect, CheckReportsShadowedBuiltIns) {
  write("effects/tone_mapping.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.effect { name = \"tone_mapping\", doc = \"Mine.\", at = \"post_process\", order = 200,\n"
        "  settings = { mode = fx.enum { \"none\", \"mine\", default = \"mine\", doc = \"Curve.\" } },\n"
        "  build = function(g, s, source) return source end }\n");
  const Outcome outcome = run({"check", "look.lua"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("effects/tone_mapping.lua shadows .*scripts/effects/tone_mapping.lua"));
}

TEST_F(Inspect, CheckWarmsTheCacheForRun) {
  RunOptions options;
  options.environment["AFTERGLOW_CACHE"] = text("cache");
  ASSERT_EQ(run({"check", "look.lua", "--size", "64x36"}, options).exit_code, kDone);
  const auto after_check = files();
  make_exr("a.exr");
  ASSERT_EQ(run({"run", "look.lua", "a.exr", "-o", "a.png", "--device", "llvmpipe"}, options).exit_code, kDone);
  for (const auto& name : files()) {
    if (!name.starts_with("cache/shaders/")) continue;
    EXPECT_NE(std::find(after_check.begin(), after_check.end(), name), after_check.end())
        << name << " was compiled again";
  }
}

TEST_F(Inspect, GraphAsJsonNamesKernelsAndSkips) {
  const json graph = parsed({"graph", "look.lua", "--format", "json", "--size", "640x360"});
  EXPECT_GT(graph.at("kernels").size(), 3u);
  bool fused = false;
  for (const auto& kernel : graph.at("kernels"))
    if (kernel.at("passes").size() > 1) fused = kernel.contains("fused_because");
  EXPECT_TRUE(fused) << "the colour steps join the last pass of the bloom";
  ASSERT_EQ(graph.at("skipped").size(), 1u);
  EXPECT_EQ(graph.at("skipped").at(0).at("name"), "tone_mapping");
}

TEST_F(Inspect, GraphAsDotAndSvg) {
  const Outcome dot = run({"graph", "look.lua"});
  EXPECT_EQ(dot.exit_code, kDone) << dot.err;
  EXPECT_THAT(dot.out, ::testing::StartsWith("digraph \"Test\" {"));
  EXPECT_THAT(dot.out, HasSubstr("-> result;"));
  EXPECT_THAT(dot.out, HasSubstr("tone_mapping: "));
  const Outcome svg = run({"graph", "look.lua", "-o", "graph.svg"});
  EXPECT_EQ(svg.exit_code, kDone) << svg.err;
  EXPECT_THAT(svg.out, IsEmpty());
  EXPECT_THAT(read("graph.svg"), ::testing::StartsWith("<svg "));
  EXPECT_THAT(read("graph.svg"), HasSubstr("bloom."));
  EXPECT_THAT(read("graph.svg"), ::testing::EndsWith("</svg>\n"));
}

TEST_F(Inspect, EffectsAreListedWithTheirSettings) {
  const Outcome table = run({"effects", "bloom"});
  EXPECT_EQ(table.exit_code, kDone) << table.err;
  EXPECT_THAT(table.out, ContainsRegex("scatter +float +0\\.05 to 0\\.95 +0\\.7"));
  const json all = parsed({"effects", "--json"});
  std::vector<std::string> names;
  for (const auto& effect : all) names.push_back(effect.at("name"));
  EXPECT_THAT(names, ::testing::IsSupersetOf(
                         {"bloom", "box_bloom", "tone_mapping", "color_adjustments", "color_blit", "outline"}));
}

TEST_F(Inspect, MasksAreListedWithTheirSettings) {
  const Outcome all = run({"effects"});
  EXPECT_THAT(all.out, ContainsRegex("mask\\.radial +"));
  const Outcome one = run({"effects", "mask.luma"});
  EXPECT_EQ(one.exit_code, kDone) << one.err;
  EXPECT_THAT(one.out, HasSubstr("mask.luma: Pixels whose luminance lies between two values."));
  EXPECT_THAT(one.out, ContainsRegex("softness +float +0 to 1000000 +0\\.1"));
  const json mask = parsed({"effects", "mask.luma", "--json"}).at(0);
  EXPECT_EQ(mask.at("kind"), "mask");
  EXPECT_FALSE(mask.contains("at"));
  std::vector<std::string> names;
  for (const auto& listed : parsed({"effects", "--masks", "--json"})) names.push_back(listed.at("name"));
  EXPECT_THAT(names,
              ::testing::ElementsAre("cryptomatte", "depth", "file", "hue", "id", "layer", "linear", "luma", "radial"));
  EXPECT_THAT(run({"effects", "mask.lumma"}).err, HasSubstr("did you mean 'mask.luma'?"));
  EXPECT_EQ(run({"effects", "--masks"}).exit_code, kUsage);
}

TEST_F(Inspect, EffectsAsMarkdown) {
  const Outcome page = run({"effects", "bloom", "--markdown"});
  EXPECT_EQ(page.exit_code, kDone) << page.err;
  EXPECT_THAT(page.out, ::testing::StartsWith("## bloom\n\n"));
  EXPECT_THAT(page.out, HasSubstr("\nAfter Catlike Coding,"));  // the comment at the head of the script
  EXPECT_THAT(page.out, HasSubstr("| `scatter` | float | 0.05 to 0.95 | `0.7` | "));
}

TEST_F(Inspect, TheDocumentOfEffectsIsUpToDate) {
  const Outcome pages = run({"effects", "--json"});
  const std::string document = read(AFTERGLOW_PROJECT_FOLDER "/docs/effects.md");
  for (const auto& effect : json::parse(pages.out)) {
    const std::string name = effect.at("name");
    EXPECT_THAT(document, HasSubstr(run({"effects", name, "--markdown"}).out)) << "run docs/effects/make.sh";
    EXPECT_THAT(document, HasSubstr("images/effects/" + name + ".jpg")) << "run docs/effects/make.sh";
  }
}

TEST_F(Inspect, EffectsOfAPathAreListedToo) {
  write("mine/effects/halve.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.effect { name = \"halve\", doc = \"Half the light.\", at = \"post_process\", order = 1, settings = "
        "{},\n"
        "  build = function(g, s, source) return source end }\n");
  const Outcome outcome = run({"effects", "--path", "mine"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("halve +post_process +1 +Half the light\\."));
}

TEST_F(Inspect, EffectsTellWhichInputsTheyReadOf) {
  EXPECT_THAT(run({"effects", "depth_fog"}).out, HasSubstr("Needs depth."));
  EXPECT_EQ(parsed({"effects", "depth_fog", "--json"}).at(0).at("needs"), json::array({"depth"}));
  EXPECT_EQ(parsed({"effects", "bloom", "--json"}).at(0).at("needs"), json::array());
  EXPECT_THAT(run({"effects", "mask.depth"}).out, HasSubstr("Needs depth."));
}

TEST_F(Inspect, CheckTellsAuthorsWhatTheyAskFor) {
  write("effects/halve.lua",
        "local fx = require \"afterglow\"\nlocal n = 0\nreturn fx.effect { name = \"halve\",\n"
        "  settings = { gone = fx.float { default = 1 } },\n"
        "  build = function(g, s, source)\n    n = n + 1\n    print(\"width\", source.width)\n"
        "    return g:pass { shader = \"halve/halve\", source = source, k = n }\n  end }\n");
  write("shaders/halve/halve.glsl",
        "uniform float k;\nvec4 apply(vec4 color) { return vec4(color.rgb * k, color.a); }\n");
  write("own.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.halve {} }\n");
  const Outcome outcome = run({"check", "own.lua"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("note: ./effects/halve.lua:7: width 1920\n"));
  EXPECT_EQ(outcome.err.find("width", outcome.err.find("width") + 1), std::string::npos) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("warning: effect 'halve': build gives another graph the second time: it keeps "
                                     "state between frames (k of pass 'halve.halve' is 1, then 3)"));
  EXPECT_THAT(outcome.out, HasSubstr("note: setting 'gone' of effect 'halve' is never read\n"));
  EXPECT_THAT(outcome.out, HasSubstr("no errors, 1 warning\n"));
  EXPECT_EQ(run({"check", "own.lua", "-q"}).err, "");
  EXPECT_THAT(parsed({"check", "own.lua", "--json"}).at("notes"), ::testing::SizeIs(1));
}

TEST_F(Inspect, NamesOfInputsAndFoldersAreChecked) {
  const Outcome input = run({"check", "look.lua", "--without", "deepth"});
  EXPECT_EQ(input.exit_code, kUsage);
  EXPECT_THAT(input.err,
              HasSubstr("--without 'deepth': there is no such input; allowed: depth, normal, motion; did you "
                        "mean 'depth'?"));
  const Outcome path = run({"check", "look.lua", "--path", "nope"});
  EXPECT_EQ(path.exit_code, kUsage);
  EXPECT_THAT(path.err, HasSubstr("--path 'nope': there is no such folder or zip"));
  const Outcome preset = run({"check", "look"});
  EXPECT_EQ(preset.exit_code, kScript);
  EXPECT_THAT(preset.err, HasSubstr("did you mean 'look.lua'?"));
}

TEST_F(Inspect, ArgumentsAndCompositionAreShown) {
  write("args.lua",
        "local fx = require \"afterglow\"\n"
        "local args = fx.args { strength = fx.float { min = 0, max = 1, default = 0.3, doc = \"How much.\" } }\n"
        "return fx.stack { fx.group { opacity = args.strength, fx.bloom { mask = fx.mask.radial { } * 0.5 } } }\n");
  const Outcome plain = run({"check", "args.lua"});
  EXPECT_EQ(plain.exit_code, kDone) << plain.err;
  EXPECT_THAT(plain.out, HasSubstr("opacity 0.3"));
  EXPECT_THAT(plain.out, HasSubstr("mask radial * 0.5"));
  EXPECT_THAT(plain.out, ContainsRegex("strength +0.3 +\\(default\\) +0 to 1 +How much"));
  EXPECT_THAT(plain.out, ContainsRegex("mask\\.radial\\.softness +0\\.[0-9]+ +\\(default\\)"));
  const json set = parsed({"check", "args.lua", "--set", "bloom.mask.radial.radius=2,1", "--json"});
  EXPECT_EQ(set["entries"][1]["mask"], "radial * 0.5");
  EXPECT_THAT(set["entries"][1]["composition"].dump(), HasSubstr("\"override\":[2.0,1.0]"));
  const json graph = parsed({"graph", "args.lua", "--format", "json"});
  EXPECT_EQ(graph["composition"], (json{{"bloom", "mask radial * 0.5"}, {"group", "opacity 0.3"}}));
  for (const char* format : {"svg", "dot"})
    EXPECT_THAT(run({"graph", "args.lua", "--format", format}).out, HasSubstr("bloom: mask radial * 0.5"));
  const json given = parsed({"check", "args.lua", "--arg", "strength=0.5", "--json"});
  EXPECT_EQ(given["entries"][0]["opacity"], 0.5);
  EXPECT_EQ(given["entries"][0]["members"], 1);
  EXPECT_EQ(given["arguments"][0]["value"], 0.5);
  EXPECT_EQ(given["arguments"][0]["given"], true);
  const Outcome wrong = run({"run", "args.lua", "a.exr", "-o", "b.exr", "--arg", "strenght=1"});
  EXPECT_EQ(wrong.exit_code, kUsage) << wrong.err;
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'strength'?"));
}

TEST_F(Inspect, AGraphIsDrawnByLevels) {
  const Outcome drawn = run({"graph", "look.lua", "--format", "svg"});
  ASSERT_EQ(drawn.exit_code, kDone) << drawn.err;
  const auto at = drawn.out.find("height=\"");
  ASSERT_NE(at, std::string::npos);
  EXPECT_LT(std::stoi(drawn.out.substr(at + 8)), 2000);  // a pyramid of 1920×1080 has nine levels
}

}  // namespace
}  // namespace afterglow::test
