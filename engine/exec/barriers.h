// SPDX-License-Identifier: MIT
// What must happen between kernels, as data: pure functions of the plan.
#pragma once

#include <functional>
#include <vector>

#include "gpu/device.h"
#include "graph/plan.h"

namespace afterglow {

/// How a kernel writes its target: by a draw, or by a compute shader that stores.
struct Writing {
  VkPipelineStageFlags2 stage = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  VkAccessFlags2 access = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
  VkImageLayout layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
};
inline constexpr Writing kStored{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                 VK_IMAGE_LAYOUT_GENERAL};
Writing writing_of(const PlanKernel& kernel);

/// A target that is about to be written over. What it held is lost. Its memory may be that of images which earlier
/// kernels, or an earlier run, have read or written; those writes are available already (each image is read after it is
/// written, behind `before_reading`), so that waiting for the readers is enough.
VkImageMemoryBarrier2 before_writing(VkImage image, const Writing& writing = {});

/// A target that was written and is read from here on, in `layout`: SHADER_READ_ONLY_OPTIMAL, or GENERAL where images
/// are also read as storage images.
VkImageMemoryBarrier2 before_reading(VkImage image, VkImageLayout layout, const Writing& writing = {});

/// An image that is written and read in GENERAL from here on. What it held is lost.
VkImageMemoryBarrier2 into_general(VkImage image);

/// How shaders may read an image that is in `layout`.
VkAccessFlags2 reading_access(VkImageLayout layout);

/// What must happen before a kernel.
struct KernelBarriers {
  std::vector<VkImageMemoryBarrier2> images;
  /// Everything written so far becomes readable, and what was read may be drawn over: for images that stay in GENERAL
  /// and are seen through several VkImages each, which no image barrier can name.
  bool memory = false;
};

/// The barriers before each kernel. `read`: the images that each kernel reads; `image_of`: the Vulkan image of a
/// transient image, null for those that are the caller's (inputs, the result), which the caller's barriers take care
/// of.
std::vector<KernelBarriers> kernel_barriers(const Plan& plan, const std::vector<std::vector<ImageId>>& read,
                                            const std::function<VkImage(ImageId)>& image_of, VkImageLayout read_layout);

/// Callers make their images ready for fragment shaders, and wait for those. A compute kernel that reads them takes its
/// place between: `before` it, and behind.
void record_compute_turn(const Device& device, VkCommandBuffer commands, bool before);

/// Records what must happen; nothing when that is nothing.
void record_barriers(const Device& device, VkCommandBuffer commands, const KernelBarriers& barriers);

}  // namespace afterglow
