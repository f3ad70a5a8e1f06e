// SPDX-License-Identifier: MIT
// Under validation: what an image of the window has after its changed parts were drawn, held against a frame that is
// drawn wholly.
#pragma once

#include "gpu/image.h"
#include "gpu/swapchain.h"

namespace afterglow {

/// Drawing thread alone.
class PaintCheck {
 public:
  /// A target of the same size and format, which arrives in COLOR_ATTACHMENT_OPTIMAL. Errors: device.
  Result<PresentTarget> begin(const Device& device, VkCommandBuffer commands, const PresentTarget& target);
  /// Once both are recorded. Errors: device.
  Result<void> end(const Device& device, VkCommandBuffer commands, const PresentTarget& target);
  /// When all of that has run. Errors: device, naming the first pixel that differs.
  Result<void> compare();

 private:
  GpuImage whole_;
  Buffer parts_pixels_, whole_pixels_;
  Size size_;
};

/// Copies pixels of a target (COLOR_ATTACHMENT_OPTIMAL, before and after; 4 bytes a pixel) for the host to read.
/// Outside of rendering.
void copy_target(const Device& device, VkCommandBuffer commands, VkImage image, Size size, const Buffer& to);

}  // namespace afterglow
