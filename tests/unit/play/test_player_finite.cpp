// SPDX-License-Identifier: MIT
// A player tells which passes make values that are not finite, while what is on screen goes on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "player_test.h"

namespace afterglow {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class PlayerFinite : public PlayerTest {
 protected:
  void SetUp() override {
    PlayerTest::SetUp();
    fs::create_directories(folder_ / "effects");
    fs::create_directories(folder_ / "shaders");
    write("effects/root.lua",
          "local fx = require \"afterglow\"\nreturn fx.effect { name = \"root\", doc = \"Roots.\", at = "
          "\"post_process\", settings = { from = fx.float { min = 0, max = 9, default = 0, doc = \"Less.\" } },\n"
          "  build = function(g, s, source)\n    return g:pass { shader = \"root\", source = source, from = s.from }\n"
          "  end }\n");
    write("shaders/root.glsl",
          "uniform float from;\nvec4 apply(vec4 color) { return vec4(sqrt(color.rgb - from), color.a); }\n");
    write_root(0);
    write_sequence(3);  // 1/8, 2/8, 3/8
  }
  void write_root(double from) {
    write("look.lua",
          "local fx = require \"afterglow\"\nreturn fx.stack { fx.root { from = " + std::to_string(from) + " } }\n");
  }
  Player& open_watched() {
    PlayerOptions options;
    options.finite_watch = {.device = {.device = "auto"}, .until_asked = true};
    return open(options);
  }
  /// Passes that are to blame in the frame that is shown.
  std::vector<std::string> blamed() {
    player_->finish_finite_watch();
    std::vector<std::string> out;
    if (const auto& found = player_->shown().not_finite)
      for (const PassFinding& pass : found->passes) out.push_back(pass.pass);
    return out;
  }
};

TEST_F(PlayerFinite, ALookThatMakesNoneIsToldNothing) {
  open_watched();
  turn();
  EXPECT_THAT(blamed(), IsEmpty());
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(PlayerFinite, APassIsNamedOnceUntilAllIsWellAgain) {
  write_root(1);
  Player& player = open_watched();
  turn();
  EXPECT_THAT(blamed(), ElementsAre("root.root"));
  const auto& found = *player.shown().not_finite;
  EXPECT_EQ(found.name, "s.1.exr");
  EXPECT_EQ(found.frame, 1);
  EXPECT_EQ(found.passes.front().line, 4);
  EXPECT_THAT(found.passes.front().file, HasSubstr("effects/root.lua"));
  EXPECT_EQ(found.passes.front().found.nan, 3u * 16 * 9);
  ASSERT_THAT(warnings_, SizeIs(1));
  EXPECT_THAT(warnings_[0], HasSubstr("root.lua:4: pass 'root.root' made 432 NaN"));
  EXPECT_THAT(warnings_[0], HasSubstr("shown as 0, in s.1.exr"));
  write_root(2);
  reload();
  EXPECT_THAT(blamed(), ElementsAre("root.root"));
  EXPECT_THAT(warnings_, SizeIs(1)) << "still the same";
  write_root(0);
  reload();
  EXPECT_THAT(blamed(), IsEmpty());
  write_root(1);
  reload();
  EXPECT_THAT(blamed(), ElementsAre("root.root"));
  EXPECT_THAT(warnings_, SizeIs(2)) << "it was well in between";
}

/// Nothing else has changed when it comes: whoever draws is told to.
TEST_F(PlayerFinite, AnAnswerIsToldByTheTurnThatTakesIt) {
  write_root(1);
  PlayerOptions options;
  options.finite_watch = {.device = {.device = "auto"}};
  Player& player = open(options);
  turn();
  const auto told = [&] {
    for (int i = 0; i < 400; ++i) {
      const Step step = player.step().value();
      if (step.told) return !step.changed;
      player.wait(seconds_ + 1);
    }
    return false;
  };
  EXPECT_TRUE(told());
  EXPECT_TRUE(player.shown().not_finite);
  EXPECT_FALSE(player.step()->told);
  write_root(0);
  reload();
  EXPECT_TRUE(told());
  EXPECT_FALSE(player.shown().not_finite);
}

TEST_F(PlayerFinite, EditsOfThePanelCount) {
  Player& player = open_watched();
  turn();
  SettingValue value;
  value.number[0] = 3;
  player.set("root", "from", value);
  turn();
  EXPECT_THAT(blamed(), ElementsAre("root.root"));
  player.undo();
  turn();
  EXPECT_THAT(blamed(), IsEmpty());
}

TEST_F(PlayerFinite, AFrameThatStandsStillIsLookedAt) {
  write_root(0.2);  // the first frame alone is below it
  Player& player = open_watched();
  player.transport().go_to(2, seconds_);
  turn();
  EXPECT_THAT(blamed(), IsEmpty());
  player.transport().go_to(0, seconds_);
  turn();
  EXPECT_THAT(blamed(), ElementsAre("root.root"));
  player.transport().go_to(1, seconds_);
  turn();
  EXPECT_THAT(blamed(), IsEmpty());
}

/// Another picture at the same place is another one to look at.
TEST_F(PlayerFinite, OtherFootageIsLookedAtAnew) {
  write_root(0.2);
  PlayerOptions options;
  options.footage.inputs = {path("s.1.exr")};
  options.finite_watch = {.device = {.device = "auto"}, .until_asked = true};
  Player& player = open(options);
  turn();
  EXPECT_THAT(blamed(), ElementsAre("root.root"));
  ASSERT_TRUE(player.open_footage({path("s.3.exr")}));
  EXPECT_FALSE(player.shown().not_finite) << "it was of the other one";
  turn();
  EXPECT_THAT(blamed(), IsEmpty());
  ASSERT_TRUE(player.open_footage({path("s.1.exr")}));
  turn();
  EXPECT_THAT(blamed(), ElementsAre("root.root"));
}

TEST_F(PlayerFinite, WithoutAWatchNobodyLooks) {
  write_root(1);
  open();
  turn();
  EXPECT_THAT(blamed(), IsEmpty());
}

/// As a window has it: nobody asks for the answer.
TEST_F(PlayerFinite, TheAnswerComesByItself) {
  write_root(1);
  PlayerOptions options;
  options.finite_watch = {.device = {.device = "auto"}};
  Player& player = open(options);
  turn();
  while (!player.shown().not_finite) {
    player.wait(std::numeric_limits<double>::infinity());
    ASSERT_TRUE(player.step().ok());
  }
  EXPECT_EQ(player.shown().not_finite->passes.front().pass, "root.root");
}

}  // namespace
}  // namespace afterglow
