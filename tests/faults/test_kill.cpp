// SPDX-License-Identifier: MIT
// Processes that die, and processes that meet.
#include <future>

#include "fault_test.h"

namespace afterglow::test {
namespace {

class Processes : public FaultTest {
 protected:
  void SetUp() override {
    FaultTest::SetUp();
    make_exr("in.0001.exr", 64, 36);
    make_exr("in.0002.exr", 66, 36);
    make_exr("in.0003.exr", 68, 36);
  }
  /// The same command once more makes all that is missing and leaves nothing else; then the folder is empty again.
  void expect_completion() const {
    const Outcome again = run_with(command_, {}, 0);
    EXPECT_EQ(again.exit_code, kDone) << again.err;
    EXPECT_EQ(expect_whole_or_absent(), 3);
    expect_nothing_left_over();
    fs::remove_all(path("out"));
    fs::create_directory(path("out"));
  }
  const std::vector<std::string> outputs_{"out/f.0001.png", "out/f.0002.png", "out/f.0003.png"};
  const std::vector<std::string> command_{"run", neon_night(), "in.%04d.exr", "-o", "out/f.%04d.png", "--resume"};
};

TEST_F(Processes, KilledBeforeAnyCallTheNextRunCompletesTheWork) {
  fs::create_directory(path("out"));
  const Fault fault = file_fault("kill", path("out"));
  const long last = places(command_, fault);
  take_reference(outputs_);
  int some_were_there = 0;
  for (const long place : some(last, 16)) {
    SCOPED_TRACE("killed before call " + std::to_string(place) + " of " + std::to_string(last));
    const Outcome killed = run_with(command_, fault, place);
    EXPECT_EQ(killed.exit_code, 128 + 9) << killed.err;
    const int there = expect_whole_or_absent();
    some_were_there += there > 0 ? 1 : 0;
    expect_completion();
  }
  EXPECT_GT(some_were_there, 0);
}

TEST_F(Processes, InterruptedAtAnyCallItEndsCleanlyAndTheNextRunCompletesTheWork) {
  fs::create_directory(path("out"));
  const Fault fault = file_fault("interrupt", path(""));
  const long last = places(command_, fault);
  take_reference(outputs_);
  int interrupted = 0;
  for (const long place : some(last, 16)) {
    SCOPED_TRACE("interrupted before call " + std::to_string(place) + " of " + std::to_string(last));
    const Outcome outcome = run_with(command_, fault, place);
    EXPECT_THAT(outcome.exit_code, ::testing::AnyOf(kDone, kInterrupted)) << outcome.err;
    interrupted += outcome.exit_code == kInterrupted ? 1 : 0;
    if (outcome.exit_code == kDone) {
      EXPECT_EQ(expect_whole_or_absent(), 3);
    }
    expect_whole_or_absent();
    expect_nothing_left_over();
    expect_completion();
  }
  EXPECT_GT(interrupted, 4);
}

TEST_F(Processes, KilledWhileCachesAreMadeTheNextRunIsWell) {
  environment_ = {{"AFTERGLOW_CACHE", text("cache")}};
  const std::vector<std::string> command{"run", neon_night(), "in.0001.exr", "-o", "out.png"};
  const Fault fault = file_fault("kill", path("cache"));
  const long last = places(command, fault);
  take_reference({"out.png"});
  int killed = 0;
  for (const long place : some(last, 10)) {
    SCOPED_TRACE("killed before call " + std::to_string(place) + " of " + std::to_string(last));
    fs::remove_all(path("cache"));
    const int exit_code = run_with(command, fault, place).exit_code;
    killed += exit_code == 128 + 9 ? 1 : 0;
    // Caches are written by several threads: there may be a call less than when they were counted.
    if (place < last - 2) {
      EXPECT_EQ(exit_code, 128 + 9);
    }
    remove_outputs();
    const Outcome again = run_with(command, {}, 0);
    EXPECT_EQ(again.exit_code, kDone) << again.err;
    EXPECT_THAT(again.err, IsEmpty());
    EXPECT_EQ(expect_whole_or_absent(), 1);
    remove_outputs();
  }
  EXPECT_GT(killed, 6);
}

TEST_F(Processes, TwoRunsMayWriteTheSameFolder) {
  fs::create_directory(path("out"));
  std::vector<std::string> command = command_;
  command.pop_back();  // both make everything
  ASSERT_EQ(run(command).exit_code, kDone);
  take_reference(outputs_);
  auto other = std::async(std::launch::async, [&] { return run(command); });
  const Outcome one = run(command), two = other.get();
  EXPECT_EQ(one.exit_code, kDone) << one.err;
  EXPECT_EQ(two.exit_code, kDone) << two.err;
  EXPECT_EQ(expect_whole_or_absent(), 3);
  expect_nothing_left_over();
}

TEST_F(Processes, TenMayFillTheSameEmptyCache) {
  environment_ = {{"AFTERGLOW_CACHE", text("cache")}};
  std::vector<std::future<Outcome>> all;
  std::vector<std::string> outputs;
  for (int i = 0; i < 10; ++i) {
    outputs.push_back("out" + std::to_string(i) + ".png");
    all.push_back(std::async(std::launch::async, [this, output = outputs.back()] {
      return run_with({"run", neon_night(), "in.0001.exr", "-o", output}, {}, 0);
    }));
  }
  for (auto& one : all) {
    const Outcome outcome = one.get();
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_THAT(outcome.err, IsEmpty());
  }
  const std::string first = read(outputs.front());
  EXPECT_FALSE(first.empty());
  for (const auto& name : outputs) EXPECT_TRUE(read(name) == first) << name;
  expect_nothing_left_over();
}

}  // namespace
}  // namespace afterglow::test
