// SPDX-License-Identifier: MIT
// A linear image as several draw targets: target k is every n-th row of it, from row k on, so that one fragment can
// write a pixel into each of n neighbouring rows. Memory and readers of the image stay as they are.
#pragma once

#include <vector>

#include "gpu/image.h"

namespace afterglow {

/// Target k is an image of n times the row pitch, bound k rows further into the same memory. This is what Vulkan calls
/// consistent interpretation: linear images, in GENERAL layout as long as both ways are in use.
class RowTargets {
 public:
  /// How many rows such targets can have for an image like this: the largest power of two of at most `wanted` within
  /// the device's limits; 1 when there is no way. Allocates nothing.
  static int possible(const Device& device, const ImageDesc& desc, int wanted);
  /// For `image`, which must be linear and not bound yet. `rows` as `possible` said. Errors: device.
  static Result<RowTargets> create(const Device& device, const UnboundImage& image, int rows);
  RowTargets() = default;

  /// Memory for the image and for the rows below its last that fill up the last group.
  const VkMemoryRequirements& needs() const { return needs_; }
  /// To be called once, with memory and offset that the image is bound to. Errors: device.
  Result<void> bind(const Device& device, VkDeviceMemory memory, VkDeviceSize offset);

  int rows() const { return static_cast<int>(targets_.size()); }
  VkImage image(int k) const { return targets_[static_cast<std::size_t>(k)].get(); }
  std::vector<VkImageView> views() const;

 private:
  std::vector<UnboundImage> targets_;
  VkDeviceSize pitch_ = 0;
  VkMemoryRequirements needs_{};
};

}  // namespace afterglow
