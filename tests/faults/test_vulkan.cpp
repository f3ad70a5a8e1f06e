// SPDX-License-Identifier: MIT
// Vulkan calls that fail: memory runs out at any of them, or the device is lost.
#include "fault_test.h"

namespace afterglow::test {
namespace {

class VulkanFault : public FaultTest {
 protected:
  /// The command ends cleanly wherever the fault strikes, and what it makes is whole or absent. Returns how often it
  /// failed.
  int strike(const std::vector<std::string>& arguments, const std::vector<std::string>& outputs,
             const std::string& code, long most) {
    const Fault fault = vulkan_fault(code);
    const long last = places(arguments, fault);
    take_reference(outputs);
    int failed = 0;
    for (const long place : some(last, most)) {
      SCOPED_TRACE(fault.name + ", call " + std::to_string(place) + " of " + std::to_string(last));
      const Outcome outcome = run_with(arguments, fault, place);
      expect_clean_end(outcome);
      const int there = expect_whole_or_absent();
      expect_nothing_left_over();
      if (outcome.exit_code == kDone) {
        EXPECT_EQ(there, static_cast<int>(outputs.size()));
      } else {
        ++failed;
        EXPECT_EQ(outcome.exit_code, kDevice);
        EXPECT_THAT(outcome.err, HasSubstr(code == "lost" ? "device lost" : "out of " + code + " memory"));
      }
      remove_outputs();
    }
    return failed;
  }
};

TEST_F(VulkanFault, OnePicture) {
  make_exr("in.exr");
  const std::vector<std::string> command{"run", neon_night(), "in.exr", "-o", "out.png"};
  for (const char* code : {"host", "device"}) EXPECT_GT(strike(command, {"out.png"}, code, 16), 8);
  EXPECT_GT(strike(command, {"out.png"}, "lost", 16), 2);
}

TEST_F(VulkanFault, ASequenceThatLooksBack) {
  write("look.lua", kLooksBack);
  make_exr("in.0001.exr");
  make_exr("in.0002.exr");
  const std::vector<std::string> command{"run", "look.lua", "in.%04d.exr", "-o", "out.%04d.exr"};
  for (const char* code : {"host", "device"}) EXPECT_GT(strike(command, {"out.0001.exr", "out.0002.exr"}, code, 12), 6);
  EXPECT_GT(strike(command, {"out.0001.exr", "out.0002.exr"}, "lost", 16), 3);
}

TEST_F(VulkanFault, PlaybackWithoutAWindow) {
  make_exr("in.0001.exr");
  make_exr("in.0002.exr");
  const std::vector<std::string> command{"play",    neon_night(), "in.%04d.exr",  "--headless",
                                         "--count", "4",          "--screenshot", "shot.png"};
  EXPECT_GT(strike(command, {"shot.png"}, "device", 30), 2);
  EXPECT_GT(strike(command, {"shot.png"}, "lost", 8), 2);
}

TEST_F(VulkanFault, UnderValidationTooNothingIsLeftAlive) {
  environment_ = {{"AFTERGLOW_VALIDATE", "1"}};
  make_exr("in.exr");
  EXPECT_GT(strike({"run", neon_night(), "in.exr", "-o", "out.png"}, {"out.png"}, "device", 10), 5);
}

TEST_F(VulkanFault, AfterADeviceIsLostTheRestIsMadeByTheNextRun) {
  make_exr("in.0001.exr", 64, 36);
  make_exr("in.0002.exr", 66, 36);
  make_exr("in.0003.exr", 68, 36);
  const std::vector<std::string> command{"run", neon_night(), "in.%04d.exr", "-o", "out.%04d.png", "--resume"};
  const Fault fault = vulkan_fault("lost");
  const long last = places(command, fault);
  take_reference({"out.0001.png", "out.0002.png", "out.0003.png"});
  // Behind the last frame come submissions that let the driver free its pipelines: nobody misses them.
  Outcome lost;
  for (long place = last; place > 0 && lost.exit_code != kDevice; --place) {
    remove_outputs();
    lost = run_with(command, fault, place);
  }
  EXPECT_EQ(lost.exit_code, kDevice);
  EXPECT_GT(expect_whole_or_absent(), 0);
  const Outcome again = run(command);
  EXPECT_EQ(again.exit_code, kDone) << again.err;
  EXPECT_EQ(expect_whole_or_absent(), 3);
}

}  // namespace
}  // namespace afterglow::test
