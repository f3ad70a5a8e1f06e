// SPDX-License-Identifier: MIT
// Which device an option means: as data, without a driver.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gpu/device_list.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

std::vector<DeviceInfo> three_devices() {
  return {
      {.name = "GeForce Titan", .type = "discrete", .driver = "", .uuid = "00ff1234", .usable = true, .why_not = {}},
      {.name = "Old Iris",
       .type = "integrated",
       .driver = "",
       .uuid = "abcd",
       .usable = false,
       .why_not = "needs Vulkan 1.1, has 1.0"},
      {.name = "llvmpipe (LLVM 15.0.6, 256 bits)",
       .type = "cpu",
       .driver = "",
       .uuid = "6d657361",
       .usable = true,
       .why_not = {}}};
}

TEST(ChooseDevice, AutoTakesTheFirstUsable) {
  auto devices = three_devices();
  EXPECT_EQ(*choose_device(devices, "auto"), 0u);
  EXPECT_EQ(*choose_device(devices, ""), 0u);
  devices[0].usable = false;
  EXPECT_EQ(*choose_device(devices, "auto"), 2u);
}

TEST(ChooseDevice, ByIndexNameAndUuidWithoutCase) {
  const auto devices = three_devices();
  EXPECT_EQ(*choose_device(devices, "2"), 2u);
  EXPECT_EQ(*choose_device(devices, "TITAN"), 0u);
  EXPECT_EQ(*choose_device(devices, "llvm"), 2u);
  EXPECT_EQ(*choose_device(devices, "6D65"), 2u);
}

TEST(ChooseDevice, UnknownNameListsAllAndSaysTheNearest) {
  const auto result = choose_device(three_devices(), "llvmpype");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::device);
  EXPECT_EQ(result.error().nearest, "llvmpipe");
  EXPECT_THAT(result.error().text(), HasSubstr("no device 'llvmpype'"));
  EXPECT_THAT(result.error().text(), HasSubstr("0 (GeForce Titan), 1 (Old Iris), 2 (llvmpipe"));
}

TEST(ChooseDevice, IndexOutOfRangeIsAnErrorUnlessItIsPartOfAName) {
  EXPECT_FALSE(choose_device(three_devices(), "7"));
  EXPECT_FALSE(choose_device(three_devices(), "15"));  // though a name holds it
  EXPECT_EQ(*choose_device(three_devices(), "256"), 2u);
}

TEST(ChooseDevice, AnUnusableDeviceSaysWhy) {
  for (const char* choice : {"1", "iris"}) {
    const auto result = choose_device(three_devices(), choice);
    ASSERT_FALSE(result);
    EXPECT_THAT(result.error().message, HasSubstr("device 1 (Old Iris) is not usable: needs Vulkan 1.1, has 1.0"));
  }
  auto devices = three_devices();
  for (auto& device : devices) device.usable = false;
  EXPECT_FALSE(choose_device(devices, "auto"));
}

TEST(ChooseDevice, NoDeviceAtAll) {
  const auto result = choose_device({}, "auto");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message, "no Vulkan device found");
}

}  // namespace
}  // namespace afterglow
