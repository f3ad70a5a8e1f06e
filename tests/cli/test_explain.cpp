// SPDX-License-Identifier: MIT
// explain, and volumes and animated settings as users run them.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>

#include <nlohmann/json.hpp>

#include "cli_test.h"

namespace afterglow::test {
namespace {

using nlohmann::json;

class Explain : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    write("cave.lua",
          "local fx = require \"afterglow\"\n"
          "return fx.stack { name = \"Cave\",\n"
          "  fx.color_adjustments { post_exposure = fx.curve { { 1, -1 }, { 5, 3 } }, contrast = 10 },\n"
          "  fx.color_blit {},\n"
          "  fx.tone_mapping {},\n"
          "  fx.volume { name = \"dark\", shape = { \"sphere\", radius = 1 }, blend_distance = 2,\n"
          "              settings = { color_adjustments = { post_exposure = -3 } } } }\n");
  }
  json parsed(const std::vector<std::string>& arguments) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }
  // A grey picture whose camera stands at x.
  void make_seen_from(const std::string& name, float x) const {
    Imf::Header header(8, 8);
    header.insert("worldToCamera", Imf::M44fAttribute(Imath::M44f().setTranslation(Imath::V3f(-x, 0, 0))));
    std::vector<float> pixels(64, 0.25f);
    Imf::FrameBuffer buffer;
    for (const char* channel : {"R", "G", "B"}) {
      header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
      buffer.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data()), 4, 32));
    }
    fs::create_directories(path(name).parent_path());
    Imf::OutputFile file(text(name).c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(8);
  }
};

TEST_F(Explain, EverySourceOfASetting) {
  const Outcome outcome = run({"explain", "cave.lua", "color_adjustments.post_exposure", "--frame", "3", "--at",
                               "2,0,0", "--set", "color_adjustments.post_exposure=0.5"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("cave.lua: Cave, frame 3 (0.125 s), seen from {2, 0, 0} (--at)"));
  EXPECT_THAT(outcome.out, ContainsRegex("dark +0 +1 +1 +0\\.75"));
  // default, curve, volume: 1 + (−3 − 1)·3/4, --set, final
  EXPECT_THAT(outcome.out, ContainsRegex("post_exposure +0 +1 \\(curve\\) +dark: -3 × 0\\.75 → -2 +0\\.5 +0\\.5"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("contrast")));
}

/// Of presets on presets.
TEST_F(Explain, TheScriptThatAValueStandsIn) {
  write(
      "mid.lua",
      "local fx = require \"afterglow\"\n\nreturn fx.extend(\"cave\", { color_adjustments = { contrast = 20, opacity = "
      "0.5 } })\n");
  write("top.lua", "return require(\"afterglow\").extend(\"mid\", { tone_mapping = { mode = \"neutral\" } })\n");
  const Outcome outcome = run({"explain", "top.lua"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.out,
              ContainsRegex("contrast +0 % +20 % \\([^ ]*mid.lua:3\\)|contrast +0 +20 \\([^ ]*mid.lua:3\\)"));
  EXPECT_THAT(outcome.out, ContainsRegex("opacity +1 +0.5 \\([^ ]*mid.lua:3\\)"));
  EXPECT_THAT(outcome.out, ContainsRegex("mode .*neutral\" \\([^ ]*top.lua:1\\)"));
  EXPECT_THAT(outcome.out, ContainsRegex("post_exposure +0 +-?[0-9.]+ \\(curve\\)")) << "where its entry stands";
  const json entries = parsed({"explain", "top.lua", "--format", "json"}).at("entries");
  const json settings = entries.at(1).at("settings");
  const auto preset = [&](const char* name) {
    for (const json& setting : settings)
      if (setting.at("name") == name) return setting.at("preset");
    return json();
  };
  EXPECT_THAT(preset("contrast").at("file").get<std::string>(), HasSubstr("mid.lua"));
  EXPECT_EQ(preset("contrast").at("line"), 3);
  EXPECT_THAT(preset("post_exposure").at("file").get<std::string>(), HasSubstr("cave.lua"));
  EXPECT_EQ(preset("post_exposure").at("line"), 3);
}

TEST_F(Explain, WhatBecomesOfEffectsAndPasses) {
  const Outcome outcome = run({"explain", "cave.lua", "--frame", "3"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("color_blit .*: skipped, "));
  EXPECT_THAT(outcome.out,
              ContainsRegex("tone_mapping\\.aces +pixel 1920×1080, fused into color_adjustments.grade\\+"));
  EXPECT_THAT(outcome.out, HasSubstr("no position is known"));
  EXPECT_THAT(outcome.err, HasSubstr("no position is known (--at"));
}

TEST_F(Explain, AsJson) {
  const json out = parsed({"explain", "cave.lua", "--format", "json", "--frame", "5", "--at", "0,0,0"});
  EXPECT_EQ(out.at("position").at("at"), json({0, 0, 0}));
  EXPECT_EQ(out.at("volumes").at(0).at("factor"), 1);
  const json& entry = out.at("entries").at(1);
  EXPECT_EQ(entry.at("name"), "color_adjustments");
  EXPECT_EQ(entry.at("state"), "runs");
  const json& exposure = entry.at("settings").at(0);
  EXPECT_EQ(exposure.at("default"), 0);
  EXPECT_EQ(exposure.at("preset"), (json{{"value", 3}, {"kind", "curve"}, {"file", "cave.lua"}, {"line", 3}}));
  EXPECT_EQ(exposure.at("volumes").at(0).at("result"), -3);
  EXPECT_EQ(exposure.at("final"), -3);
  EXPECT_FALSE(exposure.contains("override"));
  EXPECT_EQ(entry.at("passes").at(0).at("state"), "runs");
  EXPECT_EQ(out.at("entries").at(0).at("state"), "skipped");
}

TEST_F(Explain, RatesAreNumbersOrFractions) {
  for (const char* rate : {"24000/1001", "23.976023976023978"})
    EXPECT_DOUBLE_EQ(parsed({"explain", "cave.lua", "--format", "json", "--fps", rate})["fps"], 24000.0 / 1001) << rate;
}

TEST_F(Explain, WhatIsMadeOnce) {
  write("dirt.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.lens_dirt {} }\n");
  const Outcome outcome = run({"explain", "dirt.lua"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("lens_dirt\\.spots +sample [^ ]+, runs, once: it depends on settings and "
                                         "size alone\n"));
  const json explained = parsed({"explain", "dirt.lua", "--format", "json"});
  for (const json& pass : explained.at("entries").at(0).at("passes"))
    EXPECT_EQ(pass.value("once", false), pass["name"] == "lens_dirt.spots") << pass["name"];
  const json graph = parsed({"graph", "dirt.lua", "--format", "json"});
  for (const json& kernel : graph.at("kernels"))
    EXPECT_EQ(kernel.value("once", false), kernel["name"] == "lens_dirt.spots") << kernel["name"];
}

TEST_F(Explain, WhatIsMadeAgainWithEachFrame) {
  for (const bool moving : {false, true}) {
    write("label.lua", std::string("local fx = require \"afterglow\"\nreturn fx.stack { fx.burn_in { text = \"") +
                           (moving ? "{frame}" : "shot 3") + "\" } }\n");
    const Outcome outcome = run({"explain", "label.lua"});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_THAT(outcome.out, ContainsRegex(std::string("burn_in\\.letters +sample [^ ]+, runs, once") +
                                           (moving ? ", and again in each frame: its values change with the frame\n"
                                                   : ": it depends on settings and size alone\n")));
    const json label = parsed({"explain", "label.lua", "--format", "json"}).at("entries").at(0).at("passes").at(0);
    EXPECT_EQ(label.at("once"), true);
    EXPECT_EQ(label.value("again_in_each_frame", false), moving);
  }
}

TEST_F(Explain, HowEntriesArePutOverWhatTheyWereGiven) {
  write("faded.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.stack {\n"
        "  fx.color_adjustments { contrast = 10, opacity = fx.curve { { 1, 0 }, { 5, 1 } }, blend = \"screen\",\n"
        "    mask = fx.mask.luma { from = 0.3 } * (1 - fx.mask.radial {}) },\n"
        "  fx.white_balance { temperature = 10, mask = fx.mask.radial { radius = { 0, 1 } } },\n"
        "  fx.channel_mixer { red_out_red_in = 90 } }\n");
  const std::vector<std::string> command{"explain", "faded.lua",
                                         "--frame", "3",
                                         "--set",   "color_adjustments.mask.luma.to=2",
                                         "--set",   "channel_mixer.opacity=0"};
  const Outcome outcome = run(command);
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("color_adjustments .*, opacity 0\\.5, blend screen, mask luma \\* "
                                         "\\(1 - radial\\): runs"));
  EXPECT_THAT(outcome.out, ContainsRegex("opacity +1 +0\\.5 \\(curve\\) +0\\.5"));
  EXPECT_THAT(outcome.out, ContainsRegex("blend +\"normal\" +\"screen\" +\"screen\""));
  EXPECT_THAT(outcome.out, ContainsRegex("mask +everywhere +luma \\* \\(1 - radial\\)"));
  EXPECT_THAT(outcome.out, ContainsRegex("mask\\.luma\\.from +0\\.5 +0\\.3 +0\\.3"));
  EXPECT_THAT(outcome.out, ContainsRegex("mask\\.luma\\.to +1000000 +2 +2"));
  EXPECT_THAT(outcome.out, ContainsRegex("white_balance .*: skipped, its mask selects nothing: radial: radius is 0"));
  EXPECT_THAT(outcome.out, ContainsRegex("channel_mixer .*: skipped, opacity is 0"));
  auto as_json = command;
  as_json.insert(as_json.end(), {"--format", "json"});
  const json out = parsed(as_json);
  for (const json& entry : out.at("entries"))
    if (entry.at("name") == "color_adjustments") {
      EXPECT_EQ(entry.at("opacity"), 0.5);
      EXPECT_EQ(entry.at("blend"), "screen");
      EXPECT_EQ(entry.at("mask"), "luma * (1 - radial)");
      EXPECT_EQ(entry.at("composition").at(0).at("preset"),
                (json{{"value", 0.5}, {"kind", "curve"}, {"file", "faded.lua"}, {"line", 3}}));
    } else if (entry.at("name") == "channel_mixer") {
      EXPECT_EQ(entry.at("composition").at(0).at("override"), 0);
    }
  const Outcome one = run({"explain", "faded.lua", "color_adjustments.mask.luma.from"});
  EXPECT_THAT(one.out, ContainsRegex("mask\\.luma\\.from +0\\.5 +0\\.3"));
  EXPECT_THAT(one.out, Not(HasSubstr("softness")));
  EXPECT_THAT(run({"explain", "faded.lua", "white_balance.opacty"}).err, HasSubstr("did you mean 'opacity'?"));
}

TEST_F(Explain, Messages) {
  const Outcome entry = run({"explain", "cave.lua", "tone_maping.mode"});
  EXPECT_EQ(entry.exit_code, kUsage);
  EXPECT_THAT(entry.err, HasSubstr("the stack has no entry 'tone_maping'; allowed: color_blit, "
                                   "color_adjustments, tone_mapping; did you mean 'tone_mapping'?"));
  const Outcome setting = run({"explain", "cave.lua", "tone_mapping.mod"});
  EXPECT_EQ(setting.exit_code, kUsage);
  EXPECT_THAT(
      setting.err,
      HasSubstr("'tone_mapping' has no setting 'mod'; allowed: mode, exposure, white, full_white, look, toe, "
                "toe_length, shoulder_length, shoulder_angle, at, blend, enabled, mask, opacity, order; did you "
                "mean 'mode'?"));
  const Outcome at = run({"explain", "cave.lua", "--at", "1,2"});
  EXPECT_EQ(at.exit_code, kUsage);
  EXPECT_THAT(at.err, HasSubstr("--at: error: '1,2' is no position; allowed: X,Y,Z, three numbers"));
}

TEST_F(Explain, RunTakesTheCameraFromTheFile) {
  write("by_place.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.stack { fx.color_adjustments {},\n"
        "  fx.volume { shape = { \"sphere\", radius = 1 }, settings = { color_adjustments = { post_exposure = 1 } } } "
        "}\n");
  make_seen_from("far.exr", 5);
  make_seen_from("near.exr", 0.5);
  const auto result = [&](const std::string& input, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"run", "by_place.lua", input, "-o", "out.png", "--device", "llvmpipe"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(arguments).exit_code, kDone);
    return read("out.png");
  };
  const std::string dark = result("far.exr"), bright = result("near.exr");
  EXPECT_NE(dark, bright);
  EXPECT_EQ(result("far.exr", {"--at", "0,0,0"}), bright);
  EXPECT_EQ(result("near.exr", {"--at", "0,9,0"}), dark);
}

TEST_F(Explain, FramesOfASequenceAreTheSameWhateverRanBefore) {
  for (const char* frame : {"1", "2", "3", "4"}) make_exr(std::string("in/a.000") + frame + ".exr");
  write("moving.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.stack { fx.color_adjustments { post_exposure = fx.curve { { 1, 0 }, { 4, 1.5 } } },\n"
        "  fx.box_bloom { blur_iterations = function(t) return t.frame // 2 + 1 end } }\n");
  const auto play = [&](const std::string& folder, const std::string& frames) {
    fs::create_directory(path(folder));
    const Outcome outcome = run({"run", "moving.lua", "in/a.####.exr", "-o", folder + "/a.####.exr", "--frames", frames,
                                 "--device", "llvmpipe"});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  };
  play("all", "1-4");
  play("some", "4,2");
  play("one", "3");
  EXPECT_EQ(read("some/a.0004.exr"), read("all/a.0004.exr"));
  EXPECT_EQ(read("some/a.0002.exr"), read("all/a.0002.exr"));
  EXPECT_EQ(read("one/a.0003.exr"), read("all/a.0003.exr"));
  EXPECT_NE(read("all/a.0003.exr"), read("all/a.0002.exr"));
}

TEST_F(Explain, NamesTheLineOfAValueInAnotherScript) {
  write("night.lua",
        "local fx = require \"afterglow\"\n"
        "return fx.extend(\"cave\", {\n"
        "  tone_mapping = { opacity = 1 },\n"
        "  color_adjustments = {\n"
        "    contrast = 20,\n"
        "    opacity = 0.4 } })\n");
  const Outcome outcome = run({"explain", "night.lua", "color_adjustments"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("20 (night.lua:5)"));
  EXPECT_THAT(outcome.out, HasSubstr("0.4 (night.lua:6)"));
}

}  // namespace
}  // namespace afterglow::test
