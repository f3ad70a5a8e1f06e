// SPDX-License-Identifier: MIT
// What every Vulkan layer of the tests does to stand between the program and the driver.
#pragma once

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <cstdint>
#include <string_view>

namespace chain {

/// What the loader leaves for each layer in the chain of a create info; null when it left nothing.
template <typename Info, VkStructureType kType>
Info* link_of(const void* next) {
  auto* info = static_cast<const Info*>(next);
  while (info && !(info->sType == kType && info->function == VK_LAYER_LINK_INFO))
    info = static_cast<const Info*>(info->pNext);
  return const_cast<Info*>(info);
}

/// A function of an instance or a device.
template <typename Function, typename Get, typename Owner>
Function function_of(Get get, Owner owner, const char* name) {
  return reinterpret_cast<Function>(get(owner, name));
}

/// Takes this layer's link out of the chain. `below`: where the functions of the layer below are found, then.
inline bool take_link(const VkInstanceCreateInfo& info, PFN_vkGetInstanceProcAddr& below) {
  auto* link = link_of<VkLayerInstanceCreateInfo, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO>(info.pNext);
  if (!link) return false;
  below = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  return true;
}
inline bool take_link(const VkDeviceCreateInfo& info, PFN_vkGetInstanceProcAddr& create,
                      PFN_vkGetDeviceProcAddr& below) {
  auto* link = link_of<VkLayerDeviceCreateInfo, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO>(info.pNext);
  if (!link) return false;
  create = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  below = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  return true;
}

/// Whether a function is asked for, under its own name or that of the extension which it came from.
inline bool is_named(std::string_view asked, std::string_view name) {
  return asked == name || (asked.ends_with("KHR") && asked.substr(0, asked.size() - 3) == name);
}

/// What every layer answers for itself; null: another function.
struct Entries {
  PFN_vkCreateInstance create_instance;
  PFN_vkCreateDevice create_device;
  PFN_vkGetInstanceProcAddr get_instance;
  PFN_vkGetDeviceProcAddr get_device;
};
inline PFN_vkVoidFunction entry_named(std::string_view asked, const Entries& of) {
  if (asked == "vkCreateInstance") return reinterpret_cast<PFN_vkVoidFunction>(of.create_instance);
  if (asked == "vkCreateDevice") return reinterpret_cast<PFN_vkVoidFunction>(of.create_device);
  if (asked == "vkGetInstanceProcAddr") return reinterpret_cast<PFN_vkVoidFunction>(of.get_instance);
  if (asked == "vkGetDeviceProcAddr") return reinterpret_cast<PFN_vkVoidFunction>(of.get_device);
  return nullptr;
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
