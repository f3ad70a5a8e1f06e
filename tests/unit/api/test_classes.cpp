// SPDX-License-Identifier: MIT
// The classes of afterglow.hpp.
#include <memory>

#include "fixture.h"

namespace afterglow::test {
namespace {

bool device_is_freed = false, stack_is_freed = false;

void free_device(afterglow_device* device) {
  afterglow_device_free(device);
  if (device) device_is_freed = true;
}
void free_stack(afterglow_stack* stack) {
  afterglow_stack_free(stack);
  if (stack) stack_is_freed = true;
}

}  // namespace
}  // namespace afterglow::test

// What the classes free is seen here.
#define afterglow_device_free afterglow::test::free_device
#define afterglow_stack_free afterglow::test::free_stack
#include "afterglow.hpp"
#undef afterglow_device_free
#undef afterglow_stack_free

namespace afterglow::test {
namespace {

/// To be held by a callback: when it goes, says in `late` whether `freed` was set before.
std::shared_ptr<int> witness(const bool& freed, bool& late) {
  return {new int(0), [&](const int* number) {
            late = freed;
            delete number;
          }};
}

using ClassesTest = ApiTest;

TEST_F(ClassesTest, AStackThatIsReplacedEndsBeforeItsCallbacks) {
  const Device device;
  const auto options = [](const std::shared_ptr<int>& held) {
    StackOptions out;
    out.follow = true;
    out.wake = [held] { (void)held; };
    return out;
  };
  bool late = false;
  Stack stack(device, file("look.lua"), options(witness(stack_is_freed, late)));
  stack_is_freed = false;
  stack = Stack(device, file("look.lua"), options(nullptr));
  EXPECT_TRUE(stack_is_freed);
  EXPECT_TRUE(late);
  EXPECT_EQ(stack.get_number("gain.amount"), 2);

  Stack moved = std::move(stack);
  stack = std::move(moved);
  EXPECT_EQ(stack.get_number("gain.amount"), 2);
}

TEST_F(ClassesTest, ADeviceThatIsReplacedEndsBeforeItsSink) {
  const auto options = [](const std::shared_ptr<int>& held) {
    DeviceOptions out;
    out.message = [held](afterglow_severity, std::string_view) { (void)held; };
    return out;
  };
  bool late = false;
  Device device(options(witness(device_is_freed, late)));
  device_is_freed = false;
  device = Device(options(nullptr));
  EXPECT_TRUE(device_is_freed);
  EXPECT_TRUE(late);
  EXPECT_THAT(device.describe(), HasSubstr("\"name\""));
}

}  // namespace
}  // namespace afterglow::test
