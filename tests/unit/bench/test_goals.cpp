// SPDX-License-Identifier: MIT
// Files of goals.
#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

#include "bench/goals.h"

namespace afterglow::bench {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

class Goals : public testing::Test {
 protected:
  Result<std::vector<Goal>> load(const std::string& text) {
    std::ofstream(file_) << text;
    return load_goals(file_);
  }
  void TearDown() override { fs::remove(file_); }
  fs::path file_ = fs::path(testing::TempDir()) / ("goals" + std::to_string(getpid()) + ".json");
};

TEST_F(Goals, ReadsRatiosAndCommands) {
  const auto goals = load(R"({"goals": [
    {"name": "a", "sizes": ["64x32", "8x4"], "over": [{"look": "l.lua", "choice": "plain16f", "set": ["glow.x=1"]}],
     "under": [{"copy": true, "times": -4}, {"look": "l.lua", "frame": true, "display": true, "light": 0.5, "size": "2x2"}],
     "at_least": 4.5, "next": 6},
    {"name": "b", "sizes": ["2x2"], "command": {"look": "l.lua", "frames": 3, "cold": true}, "at_most": 0.3, "repeat": 5}]})");
  ASSERT_TRUE(goals) << goals.error().text();
  ASSERT_EQ(goals->size(), 3u);
  const Goal& a = goals->at(1);
  EXPECT_EQ(a.size, (Size{8, 4}));
  EXPECT_TRUE(a.at_least);
  EXPECT_EQ(a.goal, 4.5);
  EXPECT_EQ(a.next, 6);
  EXPECT_EQ(a.over.at(0).look, file_.parent_path() / "l.lua");
  EXPECT_EQ(a.over.at(0).choice, kPlain16f);
  EXPECT_EQ(a.over.at(0).overrides.at(0).setting, "x");
  EXPECT_TRUE(a.under.at(0).copy);
  EXPECT_EQ(a.under.at(0).times, -4);
  EXPECT_TRUE(a.under.at(1).frame);
  EXPECT_TRUE(a.under.at(1).display);
  EXPECT_FALSE(a.over.at(0).display);
  EXPECT_EQ(a.under.at(1).light, 0.5);
  EXPECT_EQ(a.under.at(1).size, (Size{2, 2}));
  const Goal& b = goals->at(2);
  EXPECT_FALSE(b.at_least);
  ASSERT_TRUE(b.command);
  EXPECT_EQ(b.command->frames, 3);
  EXPECT_TRUE(b.command->cold);
  EXPECT_EQ(b.repeat, 5);
}

TEST_F(Goals, MistakesNameTheFileAndTheGoal) {
  for (
      const char* text :
      {R"({"goals": [{"name": "odd", "sizes": ["8x4"], "over": [], "under": []}]})",
       R"({"goals": [{"name": "odd", "sizes": ["8"], "over": [], "under": [], "at_most": 1}]})",
       R"({"goals": [{"name": "odd", "sizes": ["8x4"], "over": [{"look": "l", "choice": "quick"}], "under": [], "at_most": 1}]})",
       R"({"goals": [{"name": "odd", "sizes": ["8x4"], "over": [{}], "under": [], "at_most": 1}]})",
       R"({"goals": [{"name": "odd", "sizes": ["8x4"], "over": 3, "under": [], "at_most": 1}]})"}) {
    const auto goals = load(text);
    ASSERT_FALSE(goals) << text;
    EXPECT_EQ(goals.error().kind, ErrorKind::io);
    EXPECT_EQ(goals.error().file, file_.string());
    EXPECT_THAT(goals.error().message, HasSubstr("odd")) << text;
  }
  EXPECT_FALSE(load("{"));
  EXPECT_FALSE(load("{}"));
}

TEST_F(Goals, ReachedIsOnTheRightSide) {
  GoalResult g{.name = "", .size = "", .ratio = 2.0, .goal = 2, .next = {}, .at_least = true, .unit = "", .note = ""};
  EXPECT_TRUE(g.reached());
  g.ratio = 1.9;
  EXPECT_FALSE(g.reached());
  g.at_least = false;
  EXPECT_TRUE(g.reached());
  g.ratio.reset();
  EXPECT_FALSE(g.reached());
}

TEST_F(Goals, TheProjectsOwnAreSound) {
  const auto goals = load_goals(AFTERGLOW_PROJECT_FOLDER "/docs/benchmarks/goals.json");
  ASSERT_TRUE(goals) << goals.error().text();
  EXPECT_GE(goals->size(), 9u);
  for (const auto& goal : *goals) {
    std::vector<GoalTerm> terms = goal.over;
    terms.insert(terms.end(), goal.under.begin(), goal.under.end());
    for (const auto& term : terms) EXPECT_TRUE(term.copy || fs::exists(term.look)) << goal.name << ": " << term.look;
    EXPECT_TRUE(!goal.command || fs::exists(goal.command->look)) << goal.name;
  }
}

}  // namespace
}  // namespace afterglow::bench
