// SPDX-License-Identifier: MIT
// Effects that look back begin anew where a shot does.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli_test.h"

namespace afterglow::test {
namespace {

using Counts = std::vector<int>;

/// Eight small pictures: four frames of an alley, four of the sea as it gets darker. The look shows how many frames
/// it has seen.
class CutsTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    write("effects/count.lua", R"(
local fx = require "afterglow"
return fx.effect { name = "count", settings = {}, build = function(g, s, source)
  local before = g:history { size = { 1, 1 }, pre_roll = 8 }
  local now = g:pass { shader = "count/more", before = before, size = { 1, 1 } }
  g:keep(before, now)
  return g:pass { shader = "count/show", source = source, now = now }
end })");
    write("shaders/count/more.glsl",
          "uniform sampler2D before;\nvec4 sample_at(ivec2 p) { return fetch(before, p) + 1.0; }\n");
    write("shaders/count/show.glsl",
          "uniform sampler2D now;\nvec4 apply(vec4 color) { return vec4(fetch(now, ivec2(0)).rgb / 16.0, 1.0); }\n");
    write("count.lua", "return require(\"afterglow\").stack { require(\"afterglow\").count {} }\n");
    write(
        "darker.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.exposure { ev = function(t) return -t.frame / 4 end } "
        "}\n");
    const fs::path images = neon().parent_path() / "showcase";
    fs::create_directory(path("in"));
    fs::create_directory(path("sea"));
    for (int frame = 1; frame <= 4; ++frame)
      fs::copy(images / "sea.exr", path(fmt::format("sea/sea.{:04}.exr", frame + 4)));
    const std::string alley = (images / "alley_shot.####.exr").string();
    for (const std::string& input : {alley, text("sea/sea.####.exr")}) {
      const Outcome made = run({"run", "darker.lua", input, "-o", "in/shot.####.exr", "--frames", "1-8", "--size",
                                "160x90", "--overscan", "cut"});
      ASSERT_TRUE(fs::exists(path("in/shot.0001.exr"))) << made.err;
      for (int frame = 5; input == alley && frame <= 8; ++frame)
        fs::remove(path(fmt::format("in/shot.000{}.exr", frame)));
    }
    ASSERT_TRUE(fs::exists(path("in/shot.0008.exr")));
  }

  /// What the frames show, when the look runs on the input with these words.
  Counts counts(const std::string& input, std::vector<std::string> more = {}) {
    fs::remove_all(path("out"));
    fs::create_directory(path("out"));
    more.insert(more.begin(),
                {"run", "count.lua", input, "-o", "out/o.####.exr", "--stats", "--report", "report.json"});
    const Outcome outcome = run(more);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    said_ = outcome.out;
    Counts out;
    for (int frame = 1; frame <= 8; ++frame) {
      const std::string name = fmt::format("out/o.000{}.exr", frame);
      if (fs::exists(path(name))) out.push_back(static_cast<int>(std::lround(16 * pixels_of(name).at(0))));
    }
    return out;
  }
  /// Frames that the report says begin a shot.
  std::vector<int> told() const {
    std::vector<int> out;
    const auto report = nlohmann::json::parse(read("report.json"));
    for (const auto& frame : report.at("frames"))
      if (frame.value("begins_shot", false)) out.push_back(frame.at("frame"));
    return out;
  }
  std::string said_;
};

TEST_F(CutsTest, OfSequencesAreToldOrLookedFor) {
  const std::string shot = "in/shot.####.exr";
  EXPECT_EQ(counts(shot), (Counts{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_THAT(told(), IsEmpty());
  EXPECT_EQ(counts(shot, {"--cuts", "auto"}), (Counts{1, 2, 3, 4, 1, 2, 3, 4}));
  EXPECT_EQ(told(), (std::vector<int>{5}));
  EXPECT_THAT(said_, HasSubstr("shots begin at frames 5"));
  EXPECT_EQ(counts(shot, {"--cuts", "7,3"}), (Counts{1, 2, 1, 2, 3, 4, 1, 2}));
  EXPECT_EQ(told(), (std::vector<int>{3, 7}));
}

/// Photographs are no film, though their names are numbered.
TEST_F(CutsTest, EachPictureByItself) {
  EXPECT_EQ(counts("in/shot.####.exr", {"--cuts", "all", "--frames", "4-8"}), (Counts{1, 1, 1, 1, 1}));
  EXPECT_EQ(nlohmann::json::parse(read("report.json")).at("pre_roll"), 0);
}

/// Whichever frames are asked for: nothing of another shot is handed on, or needed.
TEST_F(CutsTest, AreTheSameInParts) {
  const std::string shot = "in/shot.####.exr";
  const auto earlier = [&] { return nlohmann::json::parse(read("report.json")).at("pre_roll").get<int>(); };
  EXPECT_EQ(counts(shot, {"--cuts", "5", "--frames", "7-8"}), (Counts{3, 4}));
  EXPECT_EQ(earlier(), 2) << "frames before the shot need not run";
  EXPECT_EQ(counts(shot, {"--cuts", "5", "--frames", "5"}), (Counts{1}));
  EXPECT_EQ(earlier(), 0);
  EXPECT_EQ(counts(shot, {"--cuts", "auto", "--frames", "7-8"}), (Counts{3, 4}));
  EXPECT_EQ(counts(shot, {"--cuts", "6", "--frames", "3,7"}), (Counts{3, 2})) << "frames in between were left out";
  EXPECT_EQ(told(), (std::vector<int>{}));
}

/// Black frames are of the shot before them; the first light behind a black beginning begins one.
TEST_F(CutsTest, BlackIsNoShot) {
  write("black.lua", "return require(\"afterglow\").stack { require(\"afterglow\").exposure { ev = -32 } }\n");
  fs::create_directory(path("cut"));
  const auto frame = [&](int number, int from) {
    fs::copy(path(fmt::format("in/shot.000{}.exr", from)), path(fmt::format("cut/shot.000{}.exr", number)),
             fs::copy_options::overwrite_existing);
  };
  ASSERT_EQ(run({"run", "black.lua", "in/shot.0001.exr", "-o", "in/shot.0009.exr"}).exit_code, kDone);
  int number = 0;
  for (const int from : {1, 2, 9, 3, 9, 5, 6, 7}) frame(++number, from);
  EXPECT_EQ(counts("cut/shot.####.exr", {"--cuts", "auto"}), (Counts{1, 2, 3, 4, 5, 1, 2, 3}));
  number = 0;
  for (const int from : {9, 9, 1, 2, 3, 4, 9, 9}) frame(++number, from);
  EXPECT_EQ(counts("cut/shot.####.exr", {"--cuts", "auto"}), (Counts{1, 2, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(counts("cut/shot.####.exr", {"--cuts", "auto", "--frames", "4", "--pre-roll", "2"}), (Counts{2}));
  // Light behind more black frames than the pre-roll is a shot of its own, whatever was before: as in a part.
  number = 0;
  for (const int from : {1, 2, 9, 9, 3, 9, 4, 4}) frame(++number, from);
  EXPECT_EQ(counts("cut/shot.####.exr", {"--cuts", "auto", "--pre-roll", "2"}), (Counts{1, 2, 3, 4, 1, 2, 3, 4}));
  EXPECT_EQ(counts("cut/shot.####.exr", {"--cuts", "auto", "--pre-roll", "2", "--frames", "5-8"}),
            (Counts{1, 2, 3, 4}));
}

TEST_F(CutsTest, AFrameThatCannotBeReadHidesNone) {
  make_truncated_exr("in/shot.0005.exr");
  fs::create_directory(path("out"));
  EXPECT_EQ(run({"run", "count.lua", "in/shot.####.exr", "-o", "out/o.####.exr", "--cuts", "auto"}).exit_code, kFiles);
  EXPECT_EQ(std::lround(16 * pixels_of("out/o.0006.exr").at(0)), 1);
  EXPECT_EQ(run({"run", "count.lua", "in/shot.####.exr", "-o", "out/o.####.exr", "--cuts", "5"}).exit_code, kFiles);
  EXPECT_EQ(std::lround(16 * pixels_of("out/o.0006.exr").at(0)), 1);
}

/// Those behind it are made again, too.
TEST_F(CutsTest, AFrameThatFailedAtACutIsMadeUpFor) {
  fs::create_directory(path("out"));
  const std::string good = read("in/shot.0004.exr");
  const std::vector<std::string> words{"run",    "count.lua", "in/shot.####.exr", "-o", "out/o.####.exr",
                                       "--cuts", "4",         "--resume"};
  const auto time = fs::last_write_time(path("in/shot.0004.exr"));
  write("in/shot.0004.exr", std::string(good.size(), '\0'));
  fs::last_write_time(path("in/shot.0004.exr"), time);
  ASSERT_EQ(run(words).exit_code, kFiles);
  EXPECT_EQ(std::lround(16 * pixels_of("out/o.0005.exr").at(0)), 1);
  write("in/shot.0004.exr", good);
  fs::last_write_time(path("in/shot.0004.exr"), time);
  ASSERT_EQ(run(words).exit_code, kDone);
  EXPECT_EQ(std::lround(16 * pixels_of("out/o.0004.exr").at(0)), 1);
  EXPECT_EQ(std::lround(16 * pixels_of("out/o.0008.exr").at(0)), 5);
}

/// Pixels depend on them.
TEST_F(CutsTest, AreKnownToResume) {
  const std::vector<std::string> words{"run", "count.lua", "in/shot.####.exr", "-o", "out/o.####.exr", "--resume"};
  const auto with = [&](const std::string& cuts) {
    auto all = words;
    all.insert(all.end(), {"--cuts", cuts});
    return run(all);
  };
  fs::create_directory(path("out"));
  ASSERT_EQ(with("5").exit_code, kDone);
  ASSERT_EQ(with("4").exit_code, kDone);
  EXPECT_EQ(std::lround(16 * pixels_of("out/o.0004.exr").at(0)), 1);
}

TEST_F(CutsTest, WordsThatAreNoneAreRefused) {
  for (const char* words : {"some", "1-", "5,x"}) {
    const Outcome outcome = run({"run", "count.lua", "in/shot.####.exr", "-o", "out/", "--cuts", words});
    EXPECT_EQ(outcome.exit_code, kUsage);
    EXPECT_THAT(outcome.err, HasSubstr("auto, all, none, or frames that begin a shot: 25,49"));
    EXPECT_EQ(run({"play", "count.lua", "in/shot.####.exr", "--headless", "--cuts", words}).exit_code, kUsage);
  }
}

TEST_F(CutsTest, OfVideosAreFound) {
  write("none.lua", "return require(\"afterglow\").stack {}\n");
  ASSERT_EQ(run({"run", "none.lua", "in/shot.####.exr", "-o", "two.mp4"}).exit_code, kDone);
  EXPECT_EQ(counts("two.mp4"), (Counts{1, 2, 3, 4, 1, 2, 3, 4}));
  EXPECT_EQ(told(), (std::vector<int>{5}));
  EXPECT_EQ(counts("two.mp4", {"--frames", "6-8"}), (Counts{2, 3, 4}));
  EXPECT_EQ(counts("two.mp4", {"--cuts", "none"}), (Counts{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST_F(CutsTest, ArePlayedAsTheyAreRun) {
  write("none.lua", "return require(\"afterglow\").stack {}\n");
  ASSERT_EQ(run({"run", "none.lua", "in/shot.####.exr", "-o", "two.mp4"}).exit_code, kDone);
  const auto shown = [&](std::vector<std::string> more) {
    more.insert(more.begin(),
                {"play", "count.lua", "two.mp4", "--headless", "--fast", "--loop", "once", "--screenshot", "last.exr"});
    EXPECT_EQ(run(more).exit_code, kDone);
    return std::lround(16 * pixels_of("last.exr").at(0));
  };
  EXPECT_EQ(shown({}), 4);
  EXPECT_EQ(shown({"--cuts", "none"}), 8);
  EXPECT_EQ(shown({"--cuts", "3,8"}), 1);
}

}  // namespace
}  // namespace afterglow::test
