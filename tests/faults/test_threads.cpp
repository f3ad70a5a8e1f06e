// SPDX-License-Identifier: MIT
// Limits on threads: those of a user (ulimit -u), of a container, of address space.
#include "fault_test.h"

namespace afterglow::test {
namespace {

using ::testing::Matcher;

class ThreadFault : public FaultTest {
 protected:
  void SetUp() override {
    FaultTest::SetUp();
    for (int frame = 1; frame <= 3; ++frame) make_exr("in.000" + std::to_string(frame) + ".exr");
  }
  /// Every limit up to what the command would have: where there are enough for what cannot do without, as the device
  /// and others that `reason` matches, all is done.
  void strike(const std::vector<std::string>& arguments, const std::vector<std::string>& outputs,
              const Matcher<std::string>& reason = HasSubstr("cannot open device")) {
    const long last = places(arguments, thread_fault());  // as many as have met by chance
    take_reference(outputs);
    int done = 0;
    for (long place = 1; place <= last; ++place) {
      SCOPED_TRACE("thread " + std::to_string(place) + " of " + std::to_string(last));
      const Outcome outcome = run_with(arguments, thread_fault(), place);
      expect_clean_end(outcome);
      expect_nothing_left_over();
      EXPECT_EQ(expect_whole_or_absent() == static_cast<int>(outputs.size()), outcome.exit_code == kDone);
      if (outcome.exit_code == kDone)
        ++done;
      else
        EXPECT_THAT(outcome.err, reason);
      EXPECT_TRUE(done == 0 || outcome.exit_code == kDone) << "it was done with fewer:\n" << outcome.err;
      remove_outputs();
    }
    EXPECT_LT(done, last) << "limits do not reach the program";
    EXPECT_GT(done, 0) << "with one fewer it does with those that are there";
  }
};

TEST_F(ThreadFault, OfAPicture) { strike({"run", neon_night(), "in.0001.exr", "-o", "out.png"}, {"out.png"}); }

TEST_F(ThreadFault, OfASequence) {
  write("back.lua", kLooksBack);
  strike({"run", "back.lua", "in.####.exr", "-o", "out.####.exr"}, {"out.0001.exr", "out.0002.exr", "out.0003.exr"});
}

TEST_F(ThreadFault, OfPlayback) {
  strike({"play", neon_night(), "in.####.exr", "--headless", "--fast", "--screenshot", "out.png"}, {"out.png"},
         ::testing::AnyOf(HasSubstr("cannot open device"), HasSubstr("no more threads")));
}

}  // namespace
}  // namespace afterglow::test
