// SPDX-License-Identifier: MIT
// Vulkan's functions, fetched at run time for one instance and one device. Nothing of Vulkan is linked.
#pragma once

#include "core/result.h"
#include "gpu/vulkan.h"

namespace afterglow {

// Functions that need no instance.
#define AFTERGLOW_GLOBAL_FUNCTIONS(F) \
  F(vkCreateInstance) F(vkEnumerateInstanceExtensionProperties) F(vkEnumerateInstanceLayerProperties)

// Functions of an instance. Those of extensions are null unless the instance has them.
#define AFTERGLOW_INSTANCE_FUNCTIONS(F)       \
  F(vkCreateDevice)                           \
  F(vkDestroyInstance)                        \
  F(vkEnumerateDeviceExtensionProperties)     \
  F(vkEnumeratePhysicalDevices)               \
  F(vkGetDeviceProcAddr)                      \
  F(vkGetPhysicalDeviceFeatures2)             \
  F(vkGetPhysicalDeviceFormatProperties)      \
  F(vkGetPhysicalDeviceImageFormatProperties) \
  F(vkGetPhysicalDeviceMemoryProperties)      \
  F(vkGetPhysicalDeviceProperties)            \
  F(vkGetPhysicalDeviceProperties2)           \
  F(vkGetPhysicalDeviceQueueFamilyProperties)
#define AFTERGLOW_INSTANCE_EXTENSION_FUNCTIONS(F) \
  F(vkCreateDebugUtilsMessengerEXT)               \
  F(vkDestroyDebugUtilsMessengerEXT)              \
  F(vkDestroySurfaceKHR)                          \
  F(vkCmdBeginDebugUtilsLabelEXT)                 \
  F(vkCmdEndDebugUtilsLabelEXT)                   \
  F(vkSetDebugUtilsObjectNameEXT)                 \
  F(vkGetPhysicalDeviceSurfaceCapabilitiesKHR)    \
  F(vkGetPhysicalDeviceSurfaceFormatsKHR)         \
  F(vkGetPhysicalDeviceSurfacePresentModesKHR)    \
  F(vkGetPhysicalDeviceSurfaceSupportKHR)

// Functions of a device.
#define AFTERGLOW_DEVICE_FUNCTIONS(F) \
  F(vkAllocateCommandBuffers)         \
  F(vkAllocateDescriptorSets)         \
  F(vkAllocateMemory)                 \
  F(vkBeginCommandBuffer)             \
  F(vkBindBufferMemory)               \
  F(vkBindImageMemory)                \
  F(vkCmdBindDescriptorSets)          \
  F(vkCmdBindIndexBuffer)             \
  F(vkCmdBindPipeline)                \
  F(vkCmdBindVertexBuffers)           \
  F(vkCmdClearColorImage)             \
  F(vkCmdCopyBuffer)                  \
  F(vkCmdCopyBufferToImage)           \
  F(vkCmdCopyImage)                   \
  F(vkCmdCopyImageToBuffer)           \
  F(vkCmdDispatch)                    \
  F(vkCmdDispatchBase)                \
  F(vkCmdDraw)                        \
  F(vkCmdDrawIndexed)                 \
  F(vkCmdFillBuffer)                  \
  F(vkCmdPushConstants)               \
  F(vkCmdResetQueryPool)              \
  F(vkCmdSetScissor)                  \
  F(vkCmdSetViewport)                 \
  F(vkCmdUpdateBuffer)                \
  F(vkCreateBuffer)                   \
  F(vkCreateCommandPool)              \
  F(vkCreateComputePipelines)         \
  F(vkCreateDescriptorPool)           \
  F(vkCreateDescriptorSetLayout)      \
  F(vkCreateFence)                    \
  F(vkCreateGraphicsPipelines)        \
  F(vkCreateImage)                    \
  F(vkCreateImageView)                \
  F(vkCreatePipelineCache)            \
  F(vkCreatePipelineLayout)           \
  F(vkCreateQueryPool)                \
  F(vkCreateSampler)                  \
  F(vkCreateSemaphore)                \
  F(vkCreateShaderModule)             \
  F(vkDestroyBuffer)                  \
  F(vkDestroyCommandPool)             \
  F(vkDestroyDescriptorPool)          \
  F(vkDestroyDescriptorSetLayout)     \
  F(vkDestroyDevice)                  \
  F(vkDestroyFence)                   \
  F(vkDestroyImage)                   \
  F(vkDestroyImageView)               \
  F(vkDestroyPipeline)                \
  F(vkDestroyPipelineCache)           \
  F(vkDestroyPipelineLayout)          \
  F(vkDestroyQueryPool)               \
  F(vkDestroySampler)                 \
  F(vkDestroySemaphore)               \
  F(vkDestroyShaderModule)            \
  F(vkDeviceWaitIdle)                 \
  F(vkEndCommandBuffer)               \
  F(vkFlushMappedMemoryRanges)        \
  F(vkFreeCommandBuffers)             \
  F(vkFreeMemory)                     \
  F(vkGetBufferMemoryRequirements)    \
  F(vkGetDeviceQueue)                 \
  F(vkGetFenceStatus)                 \
  F(vkGetImageMemoryRequirements)     \
  F(vkGetImageSubresourceLayout)      \
  F(vkGetPipelineCacheData)           \
  F(vkGetQueryPoolResults)            \
  F(vkInvalidateMappedMemoryRanges)   \
  F(vkMapMemory)                      \
  F(vkMergePipelineCaches)            \
  F(vkQueueWaitIdle)                  \
  F(vkResetCommandPool)               \
  F(vkResetFences)                    \
  F(vkUnmapMemory)                    \
  F(vkUpdateDescriptorSets)           \
  F(vkWaitForFences)
/// Of Vulkan 1.3, or of VK_KHR_dynamic_rendering and VK_KHR_synchronization2, where they end in KHR.
#define AFTERGLOW_DEVICE_PROMOTED_FUNCTIONS(F) \
  F(vkCmdBeginRendering)                       \
  F(vkCmdEndRendering)                         \
  F(vkCmdPipelineBarrier2)                     \
  F(vkCmdWriteTimestamp2)                      \
  F(vkQueueSubmit2)
/// Null where their extension is not enabled.
#define AFTERGLOW_DEVICE_EXTENSION_FUNCTIONS(F) \
  F(vkAcquireNextImageKHR)                      \
  F(vkCreateSwapchainKHR)                       \
  F(vkDestroySwapchainKHR)                      \
  F(vkGetSwapchainImagesKHR)                    \
  F(vkQueuePresentKHR)

/// The functions have the names that Vulkan gives them: `functions.vkCmdDraw(commands, 3, 1, 0, 0)`. Immutable once
/// loaded; may be copied.
struct VulkanFunctions {
  PFN_vkGetInstanceProcAddr vkGetInstanceProcAddr = nullptr;
  PFN_vkEnumerateInstanceVersion vkEnumerateInstanceVersion = nullptr;  ///< null: a loader of Vulkan 1.0
#define AFTERGLOW_DECLARE(name) PFN_##name name = nullptr;
  AFTERGLOW_GLOBAL_FUNCTIONS(AFTERGLOW_DECLARE)
  AFTERGLOW_INSTANCE_FUNCTIONS(AFTERGLOW_DECLARE)
  AFTERGLOW_INSTANCE_EXTENSION_FUNCTIONS(AFTERGLOW_DECLARE)
  AFTERGLOW_DEVICE_FUNCTIONS(AFTERGLOW_DECLARE)
  AFTERGLOW_DEVICE_PROMOTED_FUNCTIONS(AFTERGLOW_DECLARE)
  AFTERGLOW_DEVICE_EXTENSION_FUNCTIONS(AFTERGLOW_DECLARE)
#undef AFTERGLOW_DECLARE

  /// From `get`, or where that is null from the system's loader, libvulkan.so.1, which stays loaded. Thread-safe.
  /// Errors: device (no loader; a function is missing, named). Then those of one instance and one device.
  static Result<VulkanFunctions> load(PFN_vkGetInstanceProcAddr get = nullptr);
  Result<void> load_instance(VkInstance instance);
  /// `api_version`: of the device; below 1.3 the promoted functions are those of the extensions.
  Result<void> load_device(VkDevice device, std::uint32_t api_version);
};

}  // namespace afterglow
