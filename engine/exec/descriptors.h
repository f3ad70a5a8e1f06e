// SPDX-License-Identifier: MIT
// One descriptor set for each kernel of a program.
#pragma once

#include <vector>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace afterglow {

/// What one set holds: binding 0 a uniform block unless its range is 0, bindings 1… images of these kinds.
struct SetNeeds {
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  VkDescriptorBufferInfo block{};
  std::vector<VkDescriptorType> images{};
};

class Descriptors {
 public:
  /// Uniform blocks are written for good; images follow by `write_image`. Errors: device.
  static Result<Descriptors> create(const Device& device, const std::vector<SetNeeds>& needs);
  Descriptors() = default;

  VkDescriptorSet set(std::size_t kernel) const { return sets_[kernel]; }
  /// `layout`: in which the kernel finds the image. Must not be called while a submission that uses the set is in
  /// flight.
  void write_image(std::size_t kernel, std::size_t slot, VkImageView view, VkImageLayout layout,
                   VkSampler sampler) const;

  /// The whole of it, or a part; `slot` as for images. As above.
  void write_buffer(std::size_t kernel, std::size_t slot, const VkDescriptorBufferInfo& buffer) const;

 private:
  const Device* device_ = nullptr;
  DescriptorPoolHandle pool_;
  std::vector<VkDescriptorSet> sets_;
  std::vector<std::vector<VkDescriptorType>> images_;  ///< parallel to `sets_`
};

}  // namespace afterglow
