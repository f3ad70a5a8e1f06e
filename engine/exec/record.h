// The commands of one kernel.
#pragma once

#include <string>
#include <vector>

#include "core/geometry.h"
#include "gpu/device.h"
#include "gpu/image.h"

namespace afterglow {

/// A full-screen draw that is ready to be recorded.
struct KernelCommands {
  std::string name;
  VkPipeline pipeline = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  VkImageView target = VK_NULL_HANDLE;  ///< null: the result that the program is bound to
  Size target_size, first_image_size;
  std::vector<VkImageMemoryBarrier2> barriers;  ///< that must come before it
};

void record_kernel(const Device& device, VkCommandBuffer commands, const KernelCommands& kernel, VkImageView result);

}  // namespace afterglow
