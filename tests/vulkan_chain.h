// SPDX-License-Identifier: MIT
// What every Vulkan layer of the tests does to stand between the program and the driver.
#pragma once

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <cstdint>

namespace chain {

/// What the loader leaves for each layer in the chain of a create info; null when it left nothing.
template <typename Info, VkStructureType kType>
Info* link_of(const void* next) {
  auto* info = static_cast<const Info*>(next);
  while (info && !(info->sType == kType && info->function == VK_LAYER_LINK_INFO))
    info = static_cast<const Info*>(info->pNext);
  return const_cast<Info*>(info);
}

/// The body of vkNegotiateLoaderLayerInterfaceVersion.
inline VkResult negotiate(VkNegotiateLayerInterface* wanted, PFN_vkGetInstanceProcAddr instance,
                          PFN_vkGetDeviceProcAddr device) {
  constexpr std::uint32_t kVersion = 2;
  if (wanted->loaderLayerInterfaceVersion < kVersion) return VK_ERROR_INITIALIZATION_FAILED;
  wanted->loaderLayerInterfaceVersion = kVersion;
  wanted->pfnGetInstanceProcAddr = instance;
  wanted->pfnGetDeviceProcAddr = device;
  wanted->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}

}  // namespace chain
