// SPDX-License-Identifier: MIT
// Move-only owners of Vulkan objects.
#pragma once

#include <cstdint>
#include <utility>

#include "gpu/device.h"

namespace afterglow {

/// Owns one object of a Device; destroys it at the end of its life. The GPU must be done with it then, and the Device
/// still be there.
template <class T, void (VKAPI_PTR* VulkanFunctions::*Destroy)(VkDevice, T, const VkAllocationCallbacks*)>
class Handle {
 public:
  Handle() = default;
  Handle(const Device& device, T handle) : device_(&device), handle_(handle) {}
  Handle(Handle&& other) noexcept : device_(other.device_), handle_(std::exchange(other.handle_, T{VK_NULL_HANDLE})) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Handle() {
    if (handle_ != VK_NULL_HANDLE) (device_->vk().*Destroy)(device_->handle(), handle_, nullptr);
  }

  T get() const { return handle_; }
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }
  std::uint64_t number() const { return reinterpret_cast<std::uint64_t>(handle_); }

 private:
  const Device* device_ = nullptr;
  T handle_ = VK_NULL_HANDLE;
};

using BufferHandle = Handle<VkBuffer, &VulkanFunctions::vkDestroyBuffer>;
using CommandPoolHandle = Handle<VkCommandPool, &VulkanFunctions::vkDestroyCommandPool>;
using DescriptorPoolHandle = Handle<VkDescriptorPool, &VulkanFunctions::vkDestroyDescriptorPool>;
using FenceHandle = Handle<VkFence, &VulkanFunctions::vkDestroyFence>;
using ImageHandle = Handle<VkImage, &VulkanFunctions::vkDestroyImage>;
using ImageViewHandle = Handle<VkImageView, &VulkanFunctions::vkDestroyImageView>;
using MemoryHandle = Handle<VkDeviceMemory, &VulkanFunctions::vkFreeMemory>;
using PipelineHandle = Handle<VkPipeline, &VulkanFunctions::vkDestroyPipeline>;
using PipelineLayoutHandle = Handle<VkPipelineLayout, &VulkanFunctions::vkDestroyPipelineLayout>;
using QueryPoolHandle = Handle<VkQueryPool, &VulkanFunctions::vkDestroyQueryPool>;
using SamplerHandle = Handle<VkSampler, &VulkanFunctions::vkDestroySampler>;
using SetLayoutHandle = Handle<VkDescriptorSetLayout, &VulkanFunctions::vkDestroyDescriptorSetLayout>;
using SemaphoreHandle = Handle<VkSemaphore, &VulkanFunctions::vkDestroySemaphore>;
using SwapchainHandle = Handle<VkSwapchainKHR, &VulkanFunctions::vkDestroySwapchainKHR>;
using ShaderModuleHandle = Handle<VkShaderModule, &VulkanFunctions::vkDestroyShaderModule>;

}  // namespace afterglow
