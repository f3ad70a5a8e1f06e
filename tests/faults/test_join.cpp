// SPDX-License-Identifier: MIT
// A farm's join of a video that is told to stop.
#include <array>
#include <nlohmann/json.hpp>
#include <thread>

#include "fault_test.h"

namespace afterglow::test {
namespace {

class JoinFault : public FaultTest {
 protected:
  void SetUp() override {
    FaultTest::SetUp();
    environment_ = {{"AFTERGLOW_CACHE", text("cache")}};  // a join fills none, and is not to be run for that
    make_preset("look.lua");
    for (int frame = 1; frame <= 6; ++frame) make_exr("in/s.000" + std::to_string(frame) + ".exr");
    fs::create_directory(path("out"));
    const Outcome written =
        run({"farm", "look.lua", "in/s.####.exr", "-o", "out/a.mov", "--chunk", "2", "--jobs", "j"});
    ASSERT_EQ(written.exit_code, kDone) << written.err;
    const auto jobs = nlohmann::json::parse(read("j"), nullptr, false);
    ASSERT_TRUE(jobs.contains("chunks"));
    for (const auto& chunk : jobs["chunks"]) ASSERT_EQ(run(words(chunk)).exit_code, kDone);
    fs::copy(path("out"), path("ready"), fs::copy_options::recursive);
  }
  /// Of a job, without the program.
  static std::vector<std::string> words(const nlohmann::json& what) {
    auto all = what["command"].get<std::vector<std::string>>();
    all.erase(all.begin());
    return all;
  }
  /// All chunks are done, and nothing was joined.
  void make_ready() const {
    fs::remove_all(path("out"));
    fs::copy(path("ready"), path("out"), fs::copy_options::recursive);
  }
  /// Tries of the join that ended as told to stop.
  int stopped() const {
    int count = 0;
    for (const auto& name : files()) count += name.starts_with("out/") && name.ends_with(".exit-130") ? 1 : 0;
    return count;
  }
};

TEST_F(JoinFault, ToldToStopAtAnyCallItLeavesNothingAndIsRunAgain) {
  const std::vector<std::string> join{"farm", "join", "out"};
  const Fault fault = file_fault("terminate", path("out"));
  const long last = places(join, fault);
  take_reference({"out/a.mov"});
  int noted = 0, done = 0;
  for (const long place : some(last, 16)) {
    SCOPED_TRACE("told to stop before call " + std::to_string(place) + " of " + std::to_string(last));
    make_ready();
    const Outcome outcome = run_with(join, fault, place);
    EXPECT_THAT(outcome.exit_code, ::testing::AnyOf(kDone, kInterrupted)) << outcome.err;
    EXPECT_EQ(expect_whole_or_absent(), outcome.exit_code == kDone ? 1 : 0);
    expect_nothing_left_over();
    noted += stopped();
    if (outcome.exit_code == kDone) {
      ++done;
      continue;
    }
    const Outcome again = run(join);
    EXPECT_EQ(again.exit_code, kDone) << again.err;
    EXPECT_EQ(expect_whole_or_absent(), 1);
    expect_nothing_left_over();
  }
  EXPECT_GT(noted, 4) << "it said how it ended";
  EXPECT_LT(done, 8);
}

/// A scheduler may begin one again while it still runs.
TEST_F(JoinFault, TwoAtTheSameTimeAreBothDone) {
  for (int time = 0; time < 6; ++time) {
    make_ready();
    std::array<Outcome, 2> outcomes;
    std::thread other([&] { outcomes[1] = run({"farm", "join", "out"}); });
    outcomes[0] = run({"farm", "join", "out"});
    other.join();
    for (const Outcome& outcome : outcomes) EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_TRUE(fs::is_regular_file(path("out/a.mov")));
    expect_nothing_left_over();
    for (const auto& name : files()) EXPECT_FALSE(name.ends_with(".exit-4")) << name;
  }
}

}  // namespace
}  // namespace afterglow::test
