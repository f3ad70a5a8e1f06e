// What must happen between kernels, as data: pure functions of the plan.
#pragma once

#include <vulkan/vulkan.h>

#include <functional>
#include <vector>

#include "graph/plan.h"

namespace afterglow {

/// A target that is about to be drawn over. What it held is lost. Its memory may be that of images which earlier
/// kernels, or an earlier run, have read or written; those writes are available already (each image is read after it is
/// written, behind `before_reading`), so that waiting for the readers is enough.
VkImageMemoryBarrier2 before_drawing(VkImage image);

/// A target that was drawn and is read from here on, in `layout`: SHADER_READ_ONLY_OPTIMAL, or GENERAL where images are
/// also read as storage images.
VkImageMemoryBarrier2 before_reading(VkImage image, VkImageLayout layout);

/// How fragment shaders may read an image that is in `layout`.
VkAccessFlags2 reading_access(VkImageLayout layout);

/// The barriers before each kernel. `read`: the images that each kernel reads; `image_of`: the Vulkan image of a
/// transient image, null for those that are the caller's (inputs, the result), which the caller's barriers take care
/// of.
std::vector<std::vector<VkImageMemoryBarrier2>> kernel_barriers(const Plan& plan,
                                                                const std::vector<std::vector<ImageId>>& read,
                                                                const std::function<VkImage(ImageId)>& image_of,
                                                                VkImageLayout read_layout);

}  // namespace afterglow
