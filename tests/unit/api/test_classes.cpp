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

TEST_F(ClassesTest, NumbersOfAllTypesAreSet) {
  const Device device;
  Stack stack(device, file("look.lua"));
  const auto becomes = [&](auto value) {
    stack.set("gain.amount", value);
    return stack.get_number("gain.amount");
  };
  enum Times { kFive = 5 };
  EXPECT_EQ(becomes(1), 1);
  EXPECT_EQ(becomes(2u), 2);
  EXPECT_EQ(becomes(3l), 3);
  EXPECT_EQ(becomes(std::size_t{4}), 4);
  EXPECT_EQ(becomes(kFive), 5);
  EXPECT_EQ(becomes(std::uint8_t{6}), 6);
  EXPECT_EQ(becomes(0.5f), 0.5);
  stack.set("gain.off", true);
  EXPECT_TRUE(stack.get_boolean("gain.off"));
  stack.set("gain.way", "twice");
  stack.set({{"gain.amount", "7"}, {"gain.off", "false"}});
  EXPECT_EQ(stack.get_number("gain.amount"), 7);
  EXPECT_FALSE(stack.get_boolean("gain.off"));
  EXPECT_EQ(stack.get_text("gain.way"), "twice");
}

TEST_F(ClassesTest, ArgumentsAreGiven) {
  write("look.lua",
        "local fx = require 'afterglow'\nlocal args = fx.args { strength = fx.float { default = 2, min = 0, max = 9, "
        "doc = 'How much.' } }\nreturn fx.stack { fx.gain { amount = args.strength } }\n");
  const Device device;
  StackOptions options;
  options.arguments = {"strength=4"};
  Stack stack(device, file("look.lua"), options);
  EXPECT_EQ(stack.get_number("gain.amount"), 4);
  stack.set_argument("strength", "6");
  EXPECT_EQ(stack.get_number("gain.amount"), 6);
  EXPECT_THAT(stack.arguments(), HasSubstr("How much."));
  stack.unset_argument("strength");
  EXPECT_EQ(stack.get_number("gain.amount"), 2);
}

}  // namespace
}  // namespace afterglow::test
