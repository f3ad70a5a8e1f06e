// SPDX-License-Identifier: MIT
// The commands of one kernel.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "exec/barriers.h"
#include "gpu/device.h"
#include "gpu/image.h"

namespace afterglow {

/// A full-screen draw, or a dispatch, that is ready to be recorded.
struct KernelCommands {
  std::string name;
  VkPipeline pipeline = VK_NULL_HANDLE;
  VkPipeline rest = VK_NULL_HANDLE;  ///< the second draw of a kernel with two of them, else null
  const GpuImage* marks = nullptr;   ///< with that: the depth image that tells them apart, at least as large
  VkPipelineLayout layout = VK_NULL_HANDLE;
  std::vector<VkImageView> targets;  ///< one for each row that an invocation makes; empty: the result
  int rows = 1;
  Size target_size, first_image_size;
  Rect part;                  ///< what is made of the target; whole groups of rows
  std::optional<Size> group;  ///< of a dispatch: the pixels that a workgroup makes
  VkImageLayout target_layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  bool turn_before = true,
       turn_after = true;   ///< of a dispatch: kernels that are drawn, or the caller, may stand there
  KernelBarriers barriers;  ///< that must come before it
  KernelBarriers after;     ///< and behind it
};

/// `set`: the images that it reads; `result`: the targets of kernels that make the program's result.
void record_kernel(const Device& device, VkCommandBuffer commands, const KernelCommands& kernel, VkDescriptorSet set,
                   const std::vector<VkImageView>& result);

}  // namespace afterglow
