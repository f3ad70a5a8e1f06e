// SPDX-License-Identifier: MIT
#include "gpu/fence.h"

#include <chrono>
#include <limits>
#include <thread>

namespace afterglow {

VkResult wait_for_fence(const Device& device, VkFence fence) {
  constexpr int kMostRefusals = 10'000;
  VkResult result =
      device.vk().vkWaitForFences(device.handle(), 1, &fence, VK_TRUE, std::numeric_limits<std::uint64_t>::max());
  for (int refusals = 0; result != VK_SUCCESS && result != VK_ERROR_DEVICE_LOST && refusals < kMostRefusals;) {
    if (result != VK_NOT_READY) ++refusals;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    result = device.vk().vkGetFenceStatus(device.handle(), fence);
  }
  return result;
}

}  // namespace afterglow
