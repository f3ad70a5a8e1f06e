// SPDX-License-Identifier: MIT
// Devices of this machine; lavapipe at least.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "gpu/device.h"
#include "gpu/image.h"
#include "gpu/memory.h"
#include "gpu/pipeline_cache.h"

namespace afterglow {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
namespace fs = std::filesystem;

/// Sets an environment variable for the life of the object.
class ScopedVariable {
 public:
  ScopedVariable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    setenv(name, value.c_str(), 1);
  }
  ~ScopedVariable() {
    if (old_)
      setenv(name_, old_->c_str(), 1);
    else
      unsetenv(name_);
  }

 private:
  const char* name_;
  std::optional<std::string> old_;
};

std::unique_ptr<Device> validated_device() {
  Diagnostics diagnostics;
  auto device = Device::create({.validate = true}, diagnostics);
  EXPECT_TRUE(device) << device.error().text();
  return device ? std::move(*device) : nullptr;
}

/// Programs that open and close devices all day load their drivers once.
TEST(DeviceTest, DriversStayLoadedBehindTheLastDevice) {
  const auto driver = [] {
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);)
      if (line.find("libvulkan_") != std::string::npos || line.find("nvidia") != std::string::npos) return true;
    return false;
  };
  { ASSERT_TRUE(validated_device()); }
  EXPECT_TRUE(driver());
}

TEST(DeviceList, ListsAtLeastOneUsableDevice) {
  const auto devices = list_devices();
  ASSERT_TRUE(devices) << devices.error().text();
  ASSERT_FALSE(devices->empty());
  bool usable = false;
  for (const auto& device : *devices) {
    EXPECT_FALSE(device.name.empty());
    EXPECT_EQ(device.uuid.size(), 32u);
    EXPECT_EQ(device.usable, device.why_not.empty());
    usable = usable || device.usable;
  }
  EXPECT_TRUE(usable);
}

TEST(DeviceList, NoDriverIsOneClearDeviceError) {
  const ScopedVariable files("VK_DRIVER_FILES", "/nowhere/no.json"), older("VK_ICD_FILENAMES", "/nowhere/no.json");
  const auto devices = list_devices();
  ASSERT_FALSE(devices);
  EXPECT_EQ(devices.error().kind, ErrorKind::device);
  EXPECT_THAT(devices.error().message, HasSubstr("no Vulkan driver found"));
  Diagnostics diagnostics;
  const auto device = Device::create({}, diagnostics);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().kind, ErrorKind::device);
}

TEST(DeviceTest, WorksWithoutARuntimeFolder) {
  const ScopedVariable runtime("XDG_RUNTIME_DIR", "/nowhere/at/all");
  unsetenv("XDG_RUNTIME_DIR");
  Diagnostics diagnostics;
  EXPECT_TRUE(Device::create({}, diagnostics));
}

TEST(DeviceTest, UnknownDeviceIsRefused) {
  Diagnostics diagnostics;
  const auto device = Device::create({.device = "no such thing"}, diagnostics);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().kind, ErrorKind::device);
  EXPECT_THAT(device.error().allowed, HasSubstr("auto"));
}

TEST(DeviceTest, MissingLayerIsAnError) {
  // A layer path hides the installed layers.
  const ScopedVariable layers("VK_LAYER_PATH", "/nowhere");
  Diagnostics diagnostics;
  const auto device = Device::create({.validate = true}, diagnostics);
  ASSERT_FALSE(device);
  EXPECT_THAT(device.error().message, HasSubstr("VK_LAYER_KHRONOS_validation is not installed"));
  EXPECT_TRUE(Device::create({.validate = false}, diagnostics));
}

TEST(DeviceTest, ValidationHearsAMistake) {
  auto device = validated_device();
  ASSERT_TRUE(device);
  EXPECT_EQ(device->validation_errors(), 0) << testing::PrintToString(device->validation_messages());
  const VkBufferCreateInfo empty{
      .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = 0, .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT};
  VkBuffer buffer = VK_NULL_HANDLE;
  if (device->vk().vkCreateBuffer(device->handle(), &empty, nullptr, &buffer) == VK_SUCCESS)
    device->vk().vkDestroyBuffer(device->handle(), buffer, nullptr);
  EXPECT_GT(device->validation_errors(), 0);
  ASSERT_FALSE(device->validation_messages().empty());
  EXPECT_THAT(device->validation_messages().front(), HasSubstr("VUID-VkBufferCreateInfo-size-00912"));
}

TEST(DeviceTest, TheLogOutlivesTheDeviceAndHearsLeaks) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "leaks on purpose";
#endif
  auto device = validated_device();
  ASSERT_TRUE(device);
  const auto log = device->validation_log();
  const VkFenceCreateInfo info{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence leaked = VK_NULL_HANDLE;
  ASSERT_EQ(device->vk().vkCreateFence(device->handle(), &info, nullptr, &leaked), VK_SUCCESS);
  EXPECT_EQ(log->errors(), 0);
  device.reset();
  EXPECT_GT(log->errors(), 0);
}

TEST(DeviceTest, NamesAndLabelsAreHarmlessWithoutValidation) {
  Diagnostics diagnostics;
  auto device = Device::create({}, diagnostics);
  ASSERT_TRUE(device);
  (*device)->set_name(VK_OBJECT_TYPE_DEVICE, reinterpret_cast<std::uint64_t>((*device)->handle()), "it");
  (*device)->begin_label(VK_NULL_HANDLE, "label");
  (*device)->end_label(VK_NULL_HANDLE);
}

TEST(DeviceTest, AdoptUsesAndKeepsTheCallersObjects) {
  auto owner = validated_device();
  ASSERT_TRUE(owner);
  const auto log = owner->validation_log();
  Diagnostics diagnostics;
  {
    auto adopted = Device::adopt({.instance = owner->instance(),
                                  .physical_device = owner->physical(),
                                  .device = owner->handle(),
                                  .queue = owner->queue(),
                                  .queue_family = owner->queue_family()},
                                 diagnostics);
    ASSERT_TRUE(adopted) << adopted.error().text();
    EXPECT_EQ((*adopted)->handle(), owner->handle());
    EXPECT_EQ((*adopted)->info().name, owner->info().name);
    EXPECT_TRUE(Buffer::create(**adopted, 64, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HostAccess::write, "test"));
  }
  EXPECT_EQ(owner->vk().vkQueueWaitIdle(owner->queue()), VK_SUCCESS);  // still alive
  owner.reset();
  EXPECT_EQ(log->errors(), 0) << testing::PrintToString(log->messages());
}

PFN_vkGetInstanceProcAddr the_loader = nullptr;
int asked = 0;
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL ask(VkInstance instance, const char* name) {
  ++asked;
  return std::string_view(name) == "vkGetPhysicalDeviceFeatures2" && asked < 0 ? nullptr : the_loader(instance, name);
}

TEST(DeviceTest, AnAdoptedDeviceTakesItsFunctionsFromTheCaller) {
  auto owner = validated_device();
  ASSERT_TRUE(owner);
  the_loader = owner->vk().vkGetInstanceProcAddr;
  const AdoptedDevice objects{.instance = owner->instance(),
                              .physical_device = owner->physical(),
                              .device = owner->handle(),
                              .queue = owner->queue(),
                              .queue_family = owner->queue_family(),
                              .get_instance_proc_addr = ask};
  Diagnostics diagnostics;
  asked = 0;
  EXPECT_TRUE(Device::adopt(objects, diagnostics));
  EXPECT_GT(asked, 10);
  asked = -1000;  // one that lacks a function
  const auto lacking = Device::adopt(objects, diagnostics);
  ASSERT_FALSE(lacking);
  EXPECT_THAT(lacking.error().message, HasSubstr("vkGetPhysicalDeviceFeatures2"));
}

TEST(DeviceTest, AdoptRefusesWhatItCannotUse) {
  Diagnostics diagnostics;
  EXPECT_FALSE(Device::adopt({}, diagnostics));
  auto owner = validated_device();
  ASSERT_TRUE(owner);
  const auto bad_family = Device::adopt({.instance = owner->instance(),
                                         .physical_device = owner->physical(),
                                         .device = owner->handle(),
                                         .queue = owner->queue(),
                                         .queue_family = 99},
                                        diagnostics);
  ASSERT_FALSE(bad_family);
  EXPECT_THAT(bad_family.error().message, HasSubstr("queue family 99"));
}

TEST(PipelineCache, DamagedFilesAreIgnored) {
  auto device = validated_device();
  ASSERT_TRUE(device);
  const fs::path folder = fs::path(testing::TempDir()) / "afterglow_pipeline_cache";
  fs::remove_all(folder);
  device->use_pipeline_cache(folder.string());  // nothing there
  device->save_pipeline_cache();
  fs::create_directories(folder);
  std::string name;
  {
    const char* digits = "0123456789abcdef";
    for (const auto byte : device->properties().pipelineCacheUUID) {
      name += digits[byte >> 4];
      name += digits[byte & 15];
    }
  }
  for (const std::string& content : {std::string(), std::string("short"), std::string(5000, 'x')}) {
    std::ofstream(folder / ("pipelines-" + name + ".bin")) << content;
    device->use_pipeline_cache(folder.string());
  }
  EXPECT_NE(device->pipeline_cache(), VkPipelineCache{VK_NULL_HANDLE});
  EXPECT_THAT(device->validation_messages(), IsEmpty());
  fs::remove_all(folder);
}

TEST(PipelineCache, OnlyWholeFilesOfTheSameDeviceAreRead) {
  VkPhysicalDeviceProperties device{};
  device.vendorID = 7;
  device.deviceID = 8;
  device.pipelineCacheUUID[3] = 9;
  VkPipelineCacheHeaderVersionOne header{sizeof header, VK_PIPELINE_CACHE_HEADER_VERSION_ONE, 7, 8, {}};
  header.pipelineCacheUUID[3] = 9;
  const std::string data = std::string(reinterpret_cast<const char*>(&header), sizeof header) + "compiled pipelines";
  const std::string content = pipeline_cache_file_content(data);
  const fs::path file = fs::path(testing::TempDir()) / "afterglow_pipelines.bin";
  const auto read_back = [&](const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
    return read_pipeline_cache(file.string(), device);
  };
  EXPECT_EQ(read_back(content), data);
  std::string flipped = content;
  flipped.back() ^= 1;
  EXPECT_EQ(read_back(flipped), "");
  EXPECT_EQ(read_back(content.substr(0, content.size() - 1)), "");
  EXPECT_EQ(read_back(content + "x"), "");
  for (auto* number : {&device.vendorID, &device.deviceID}) {
    ++*number;
    EXPECT_EQ(read_back(content), "");
    --*number;
  }
  device.pipelineCacheUUID[0] = 1;
  EXPECT_EQ(read_back(content), "");
  fs::remove(file);
  EXPECT_EQ(read_pipeline_cache(file.string(), device), "");
}

TEST(ImageTest, OverLimitSizesAreRefusedBeforeAnythingIsAllocated) {
  auto device = validated_device();
  ASSERT_TRUE(device);
  const VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  const auto wide = check_image(*device, {.name = "wide", .size = {1 << 20, 4}, .usage = usage});
  ASSERT_FALSE(wide);
  EXPECT_THAT(wide.error().message, HasSubstr("image 'wide' of 1048576×4 pixels: the device allows"));
  const auto empty = check_image(*device, {.name = "empty", .size = {0, 4}, .usage = usage});
  ASSERT_FALSE(empty);
  EXPECT_THAT(empty.error().message, HasSubstr("sizes start at 1×1"));
  EXPECT_TRUE(check_image(*device, {.name = "fits", .size = {64, 64}, .usage = usage}));
  if (device->max_allocation() < (4ull << 30)) {
    const auto large = check_image(*device, {.name = "large", .size = {16384, 16384}, .usage = usage});
    ASSERT_FALSE(large);
    EXPECT_EQ(large.error().kind, ErrorKind::device);
    EXPECT_THAT(large.error().message, HasSubstr("needs 4.0 GiB, the device allows"));
  }
  EXPECT_EQ(device->validation_errors(), 0) << testing::PrintToString(device->validation_messages());
}

TEST(MemoryTest, TooLargeAnAllocationIsRefused) {
  auto device = validated_device();
  ASSERT_TRUE(device);
  const auto memory =
      Memory::allocate(*device, {.size = device->max_allocation() + 1, .alignment = 16, .memoryTypeBits = ~0u},
                       HostAccess::none, "too much");
  ASSERT_FALSE(memory);
  EXPECT_THAT(memory.error().message, HasSubstr("too much: needs"));
  const auto no_type =
      Memory::allocate(*device, {.size = 64, .alignment = 16, .memoryTypeBits = 0}, HostAccess::none, "odd");
  ASSERT_FALSE(no_type);
  EXPECT_EQ(device->validation_errors(), 0);
}

TEST(HandleTest, MovesOwnershipAndDestroysOnce) {
  auto device = validated_device();
  ASSERT_TRUE(device);
  const auto log = device->validation_log();
  {
    auto a = Buffer::create(*device, 256, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, HostAccess::write, "a");
    auto b = Buffer::create(*device, 256, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, HostAccess::read, "b");
    ASSERT_TRUE(a && b);
    Buffer moved = std::move(*a);
    moved = std::move(*b);
    EXPECT_NE(moved.get(), VkBuffer{VK_NULL_HANDLE});
    ASSERT_NE(moved.data(), nullptr);
    moved.data()[255] = std::byte{1};
  }
  device.reset();
  EXPECT_EQ(log->errors(), 0) << testing::PrintToString(log->messages());
}

}  // namespace
}  // namespace afterglow
