// SPDX-License-Identifier: MIT
#include "gpu/fence.h"

#include <limits>

namespace afterglow {

VkResult wait_for_fence(const Device& device, VkFence fence) {
  const VkResult result =
      device.vk().vkWaitForFences(device.handle(), 1, &fence, VK_TRUE, std::numeric_limits<std::uint64_t>::max());
  if (result != VK_SUCCESS && result != VK_ERROR_DEVICE_LOST) {
    const auto lock = device.lock_queue();  // waiting for the device is using all its queues
    device.vk().vkDeviceWaitIdle(device.handle());
  }
  return result;
}

}  // namespace afterglow
