// The "engine" side of the embedding test: a program with Vulkan objects of its own.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <vector>

struct HostImageVk {
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
};

/// Throws std::runtime_error on any Vulkan failure; a test program may.
class VulkanHost {
 public:
  VulkanHost();
  ~VulkanHost();
  VulkanHost(const VulkanHost&) = delete;

  HostImageVk make_image(std::uint32_t width, std::uint32_t height, VkImageUsageFlags usage);
  void destroy(HostImageVk& image);
  /// A host-visible buffer for transfers.
  VkBuffer make_buffer(VkDeviceSize size, VkDeviceMemory& memory, float** mapped);
  VkCommandBuffer begin();
  void submit_and_wait(VkCommandBuffer commands);
  static void barrier(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to,
                      VkPipelineStageFlags2 before, VkAccessFlags2 wrote, VkPipelineStageFlags2 after,
                      VkAccessFlags2 reads);
  static void barrier(VkCommandBuffer commands, const VkMemoryBarrier2& change);

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t family = 0;
  int validation_errors = 0;

 private:
  std::uint32_t memory_type(std::uint32_t bits, VkMemoryPropertyFlags wanted) const;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
};
