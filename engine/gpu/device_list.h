// SPDX-License-Identifier: MIT
// What devices there are, what they lack, and which one an option means. Used by gpu/device alone.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "gpu/device.h"
#include "gpu/vulkan.h"

namespace afterglow {

struct PhysicalDevice {
  VkPhysicalDevice handle = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;
  DeviceInfo info;
};

std::vector<VkQueueFamilyProperties> queue_families(const VulkanFunctions& vk, VkPhysicalDevice device);

/// Whether queues of this family can do all that is recorded.
inline bool can_draw_and_compute(const VkQueueFamilyProperties& family) {
  constexpr VkQueueFlags kBoth = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  return (family.queueFlags & kBoth) == kBoth;
}

/// All devices of the instance in the order of preference. Errors: device (none).
Result<std::vector<PhysicalDevice>> enumerate_devices(const VulkanFunctions& vk, VkInstance instance,
                                                      VkSurfaceKHR surface = VK_NULL_HANDLE);

/// What a device of this version is opened with, `present`: to show pictures in a window too.
std::vector<const char*> extensions_to_enable(const VulkanFunctions& vk, VkPhysicalDevice device,
                                              std::uint32_t api_version, bool present);

/// Whether reads beside an image can be made to give zeros (robustImageAccess): authors may use texelFetch.
bool can_bound_image_reads(const VulkanFunctions& vk, VkPhysicalDevice device, std::uint32_t api_version);

/// Name, type, driver, uuid and whether it can be used; with `surface`, whether it can present to it too.
PhysicalDevice describe_device(const VulkanFunctions& vk, VkPhysicalDevice device,
                               VkSurfaceKHR surface = VK_NULL_HANDLE);

/// Index into `devices` that `choice` (DeviceOptions::device) means. Pure. Errors: device, with the names there are and
/// the nearest.
Result<std::size_t> choose_device(std::span<const DeviceInfo> devices, const std::string& choice);

}  // namespace afterglow
