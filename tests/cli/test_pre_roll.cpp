// SPDX-License-Identifier: MIT
// Effects that look back, over ranges of frames: a frame has the same pixels whichever others are asked for.
#include <nlohmann/json.hpp>

#include "cli_test.h"

namespace afterglow::test {
namespace {

/// The picture shows the numbers of the three frames before it, which are handed on from frame to frame.
class PreRoll : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    for (int frame = 1; frame <= 8; ++frame) make_exr("in/shot.000" + std::to_string(frame) + ".exr");
    write("effects/back.lua", R"(
local fx = require "afterglow"
return fx.effect { name = "back", settings = {}, build = function(g, s, source)
  local before = g:history { size = { 1, 1 }, pre_roll = 3 }
  g:keep(before, g:pass { shader = "back/propagate", before = before, size = { 1, 1 }, frame = g.frame, time = g.frame_time * g.fps })
  return g:pass { shader = "back/show", source = source, before = before }
end })");
    write("shaders/back/propagate.glsl",
          "uniform sampler2D before;\nuniform float frame, time;\n"
          "vec4 sample_at(ivec2 p) { return vec4(frame, fetch(before, p).rg, time); }\n");
    write("shaders/back/show.glsl",
          "uniform sampler2D before;\nvec4 apply(vec4 color) { vec4 b = fetch(before, ivec2(0));\n"
          "  return vec4((b.r + 16.0 * b.g + 256.0 * b.b) / 4096.0, b.a / 16.0, color.b, color.a); }\n");
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.back {} }\n");
    fs::create_directory(path("all"));
    fs::create_directory(path("out"));
  }

  Outcome run_into(const std::string& folder, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"run",           "look.lua", "in/shot.####.exr", "-o", folder + "/shot.####.exr",
                                       "--compression", "none"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  /// Numbers of the frames in a folder, and which of them are as in all/.
  void expect_as_in_all(const std::vector<int>& frames) const {
    std::vector<std::string> expected, found;
    for (const int frame : frames) expected.push_back("shot.000" + std::to_string(frame) + ".exr");
    for (const auto& entry : fs::directory_iterator(path("out")))
      if (entry.is_regular_file()) found.push_back(entry.path().filename().string());
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
    for (const auto& name : found) EXPECT_TRUE(read("out/" + name) == read("all/" + name)) << name;
  }
};

TEST_F(PreRoll, ARangeIsAsInTheWhole) {
  ASSERT_EQ(run_into("all").exit_code, kDone);
  EXPECT_FALSE(read("all/shot.0005.exr") == read("all/shot.0006.exr")) << "the test shows something";
  const Outcome outcome = run_into("out", {"--frames", "5-6", "--report", "report.json", "--stats"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  expect_as_in_all({5, 6});
  EXPECT_EQ(nlohmann::json::parse(read("report.json")).at("pre_roll"), 3);
  EXPECT_THAT(outcome.out, HasSubstr("pre-roll: 3 earlier frames, not written"));
}

TEST_F(PreRoll, HistoriesThatBeginAnewAreTold) {
  write("effects/grow.lua", R"(
local fx = require "afterglow"
return fx.effect { name = "grow", settings = { steps = fx.int { default = 1, min = 1, max = 9 } }, build = function(g, s, source)
  local before = g:history { size = { 1, 1 }, pre_roll = 3 }
  local next = before
  for i = 1, s.steps do
    next = g:pass { shader = "back/propagate", before = next, size = { 1, 1 }, frame = g.frame, time = g.frame_time }
  end
  g:keep(before, next)
  return g:pass { shader = "back/show", source = source, before = before }
end })");
  const auto told = [&](const std::string& steps) {
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.grow { steps = " + steps + " } }\n");
    const Outcome outcome = run_into("out");
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(told("2"), Not(HasSubstr("began anew")));
  EXPECT_THAT(told("function(t) return t.frame > 4 and 2 or 1 end"),
              HasSubstr("history 'grow.history' began anew once within a sequence: passes that it is made of"));
  EXPECT_THAT(told("function(t) return t.frame end"), HasSubstr("'grow.history' began anew 7 times within a sequence"));
}

TEST_F(PreRoll, IsAsLongAsAsked) {
  ASSERT_EQ(run_into("all").exit_code, kDone);
  EXPECT_EQ(run_into("out", {"--frames", "5", "--pre-roll", "2", "--report", "report.json"}).exit_code, kDone);
  EXPECT_EQ(nlohmann::json::parse(read("report.json")).at("pre_roll"), 2);
  EXPECT_FALSE(read("out/shot.0005.exr") == read("all/shot.0005.exr"));
  EXPECT_EQ(run_into("out", {"--frames", "5", "--pre-roll", "9"}).exit_code, kDone);
  expect_as_in_all({5});
  EXPECT_EQ(run_into("out", {"--pre-roll", "-1"}).exit_code, kUsage);
}

TEST_F(PreRoll, OrderAndStepDoNotMatter) {
  ASSERT_EQ(run_into("all").exit_code, kDone);
  EXPECT_EQ(run_into("out", {"--frames", "8,7,6,5,4,3,2,1"}).exit_code, kDone);
  expect_as_in_all({1, 2, 3, 4, 5, 6, 7, 8});
  fs::remove_all(path("out"));
  fs::create_directory(path("out"));
  EXPECT_EQ(run_into("out", {"--frames", "8,1-7x2", "--report", "report.json"}).exit_code, kDone);
  expect_as_in_all({1, 3, 5, 7, 8});
  EXPECT_EQ(nlohmann::json::parse(read("report.json")).at("pre_roll"), 3) << "2, 4 and 6";
}

/// As a shell lists them: numbers below zero, and numbers that are not the end of the name.
TEST_F(PreRoll, AListOfFilesIsTheSequenceThatItsPatternIs) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> sequences{
      {"in/n.####.exr", {"in/n.-002.exr", "in/n.-001.exr", "in/n.0000.exr", "in/n.0001.exr"}},
      {"in/b.####_beauty.exr", {"in/b.0001_beauty.exr", "in/b.0002_beauty.exr", "in/b.0003_beauty.exr"}}};
  for (const auto& [pattern, files] : sequences) {
    for (const auto& file : files) fs::copy(path("in/shot.0001.exr"), path(file));
    ASSERT_EQ(run({"run", "look.lua", pattern, "-o", "all/", "--compression", "none"}).exit_code, kDone);
    std::vector<std::string> arguments{"run", "look.lua"};
    arguments.insert(arguments.end(), files.begin(), files.end());
    arguments.insert(arguments.end(), {"-o", "out/", "--compression", "none"});
    ASSERT_EQ(run(arguments).exit_code, kDone);
    for (const auto& file : files) {
      const std::string name = fs::path(file).filename().string();
      EXPECT_TRUE(read("out/" + name) == read("all/" + name)) << name;
    }
  }
}

/// Frames come in the order that was asked for, as they do where nothing looks back.
TEST_F(PreRoll, OneOutputKeepsTheOrder) {
  const auto frames = [&](const std::vector<std::string>& inputs, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", "look.lua"};
    arguments.insert(arguments.end(), inputs.begin(), inputs.end());
    arguments.insert(arguments.end(), {"-o", "-", "--format", "ppm", "--dither", "none"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return outcome.out;
  };
  const auto one = [&](const std::string& number) { return frames({"in/shot.####.exr"}, {"--frames", number}); };
  EXPECT_NE(one("5"), one("3")) << "the test shows something";
  EXPECT_TRUE(frames({"in/shot.####.exr"}, {"--frames", "5,3,4,8,1"}) ==
              one("5") + one("3") + one("4") + one("8") + one("1"));
  // Of two sequences by turns each frame has those before it that the list has.
  fs::copy(path("in/shot.0001.exr"), path("in/b.0001.exr"));
  fs::copy(path("in/shot.0001.exr"), path("in/b.0002.exr"));
  const std::string first = frames({"in/b.0001.exr"}, {}), both = frames({"in/b.####.exr"}, {});
  EXPECT_TRUE(frames({"in/b.0001.exr", "in/shot.0001.exr", "in/b.0002.exr"}, {}) ==
              first + one("1") + both.substr(first.size()));
}

TEST_F(PreRoll, AHoleIsPassedOver) {
  fs::remove(path("in/shot.0004.exr"));
  ASSERT_EQ(run_into("all").exit_code, kDone);
  EXPECT_EQ(run_into("out", {"--frames", "5-6"}).exit_code, kDone);
  expect_as_in_all({5, 6});
}

TEST_F(PreRoll, AFrameThatFailsIsPassedOver) {
  make_truncated_exr("in/shot.0004.exr");
  ASSERT_EQ(run_into("all").exit_code, kFiles);
  // One frame more, since the one that fails does not count.
  const Outcome outcome = run_into("out", {"--frames", "5-6", "--pre-roll", "4"});
  EXPECT_EQ(outcome.exit_code, kDone) << "nothing that was asked for failed";
  EXPECT_THAT(outcome.err, HasSubstr("left out of the pre-roll"));
  expect_as_in_all({5, 6});
}

TEST_F(PreRoll, ResumeMakesAgainWhatDependsOnAChange) {
  ASSERT_EQ(run_into("all").exit_code, kDone);
  ASSERT_EQ(run_into("out").exit_code, kDone);
  const auto newer = fs::last_write_time(path("out/shot.0008.exr")) + std::chrono::seconds(10);
  fs::last_write_time(path("in/shot.0003.exr"), newer);
  EXPECT_EQ(run_into("out", {"--resume", "--report", "report.json"}).exit_code, kDone);
  std::vector<std::string> states;
  const auto parsed = nlohmann::json::parse(read("report.json"));
  for (const auto& frame : parsed.at("frames")) states.push_back(frame.at("state"));
  const std::string kOld = "up to date", kNew = "done";
  EXPECT_EQ(states, (std::vector<std::string>{kOld, kOld, kNew, kNew, kNew, kNew, kOld, kOld}));
  EXPECT_EQ(parsed.at("pre_roll"), 2) << "1 and 2";
  expect_as_in_all({1, 2, 3, 4, 5, 6, 7, 8});
}

TEST_F(PreRoll, StillsBeginEachByThemselves) {
  fs::copy(path("in/shot.0001.exr"), path("a.exr"));
  fs::copy(path("in/shot.0001.exr"), path("b.exr"));
  EXPECT_EQ(run({"run", "look.lua", "a.exr", "b.exr", "-o", "out/", "--compression", "none"}).exit_code, kDone);
  EXPECT_TRUE(read("out/a.exr") == read("out/b.exr"));
}

TEST_F(PreRoll, IsExplainedAndDrawn) {
  const Outcome explained = run({"explain", "look.lua"});
  EXPECT_THAT(explained.out,
              HasSubstr("history back.history: 1×1, keeps back.propagate; without a frame before it: {0, "
                        "0, 0, 0}; pre-roll 3 frames"));
  const Outcome dot = run({"graph", "look.lua", "--format", "dot"});
  EXPECT_THAT(dot.out, HasSubstr("[style=dashed, label=\"next frame\""));
}

/// Of long runs, too: an effect that looks back in two frames of many.
TEST_F(PreRoll, ALookBackInTwoFramesOfManyIsSeen) {
  constexpr int kFrames = 200;
  const auto file = [](int frame) { return fmt::format("long/shot.{:04}.exr", frame); };
  for (int frame = 1; frame <= kFrames; ++frame) make_exr(file(frame), 2, 2);
  write("effects/flash.lua", R"(
local fx = require "afterglow"
return fx.effect { name = "flash", settings = { on = fx.bool { default = false } },
  active = function(s) return s.on, "off" end,
  build = function(g, s, source)
    local before = g:history { size = { 1, 1 }, pre_roll = 3 }
    g:keep(before, g:pass { shader = "back/propagate", before = before, size = { 1, 1 }, frame = g.frame, time = g.frame_time * g.fps })
    return g:pass { shader = "back/show", source = source, before = before }
  end })");
  write("look.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.flash { on = function(t) return t.frame == 5 or "
        "t.frame == 6 end } }\n");
  const auto made = [&](const std::string& folder, const std::string& frames) {
    const Outcome outcome = run({"run", "look.lua", "long/shot.####.exr", "-o", folder + "/", "--frames", frames});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return read(folder + "/shot.0006.exr");
  };
  const std::string whole = made("whole", "1-200");
  EXPECT_FALSE(whole.empty());
  EXPECT_TRUE(made("even", "2-200x2") == whole);
}

}  // namespace
}  // namespace afterglow::test
