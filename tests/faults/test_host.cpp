// SPDX-License-Identifier: MIT
// A host of the library is told of an error and goes on: its next frames are right, and it never crashes.
#include <fmt/format.h>

#include "fault_test.h"

namespace afterglow::test {
namespace {

constexpr const char* kSingle =
    "local fx = require \"afterglow\"\n"
    "return fx.stack { fx.bloom { intensity = 0.5 }, fx.tone_mapping { mode = \"aces\" } }\n";

class HostFault : public FaultTest {
 protected:
  void SetUp() override {
    FaultTest::SetUp();
    program_ = AFTERGLOW_FAULT_HOST;
    write("single.lua", kSingle);
    write("back.lua", kLooksBack);
  }

  /// One call fails, at `most` places: the host asks for that frame again, and all its frames are as without the fault.
  /// Returns how often it was told of an error.
  int strike(const std::string& look, const std::string& code, long most) {
    const std::vector<std::string> command{look, "out.raw"};
    const Fault fault = vulkan_fault(code);
    const long last = places(command, fault);
    take_reference({"out.raw"});
    int told = 0;
    for (const long place : some(last, most)) {
      if (place == 1) continue;  // the instance: whoever makes another loads the layer anew, which counts from there
      SCOPED_TRACE(fmt::format("{}, call {} of {}", fault.name, place, last));
      const Outcome outcome = run_with(command, fault, place);
      EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
      EXPECT_EQ(expect_whole_or_absent(), 1);
      told += outcome.err.empty() ? 0 : 1;
      remove_outputs();
    }
    return told;
  }
};

TEST_F(HostFault, AVulkanCallThatFails) {
  for (const char* look : {"single.lua", "back.lua"})
    for (const char* code : {"host", "device"}) EXPECT_GT(strike(look, code, 12), 3) << look << " " << code;
}

TEST_F(HostFault, AVulkanCallThatFailsWherePixelsAreStaged) {
  environment_["AFTERGLOW_FORCE"] = "staging";
  for (const char* look : {"single.lua", "back.lua"}) EXPECT_GT(strike(look, "device", 20), 4) << look;
}

/// Its memory is not coherent: what the processor writes, and reads, has to be carried, and that may fail.
TEST_F(HostFault, AVulkanCallThatFailsOnAnImitatedGpu) {
  environment_["VK_ADD_LAYER_PATH"] = fmt::format("{}:{}", AFTERGLOW_FAULT_LAYER_FOLDER, AFTERGLOW_GPU_LAYER_FOLDER);
  environment_["VK_INSTANCE_LAYERS"] = "VK_LAYER_AFTERGLOW_fault:VK_LAYER_AFTERGLOW_gpu";
  EXPECT_GT(strike("single.lua", "device", 24), 4);
}

TEST_F(HostFault, ADeviceThatIsLost) {
  const std::vector<std::string> command{"back.lua", "out.raw"};
  const Fault fault = vulkan_fault("lost");
  int failed = 0;
  for (const long place : some(places(command, fault), 8)) {
    const Outcome outcome = run_with(command, fault, place);
    EXPECT_TRUE(outcome.exit_code == kDone || outcome.exit_code == kDevice) << outcome.exit_code << outcome.err;
    failed += outcome.exit_code == kDevice ? 1 : 0;
  }
  EXPECT_GT(failed, 2);
}

// Sanitizers bring an operator new of their own, which no program takes the place of.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(HostFault, AllocationsThatFail) {
  for (const char* look : {"single.lua", "back.lua"}) {
    const Outcome outcome = run({look, "--memory", "60"}, {.program = program_});
    EXPECT_EQ(outcome.exit_code, kDone) << look << "\n" << outcome.out;
  }
}
#endif

}  // namespace
}  // namespace afterglow::test
