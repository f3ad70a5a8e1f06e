// One descriptor set for each kernel of a program.
#pragma once

#include <vector>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace afterglow {

/// What one set holds: binding 0 a uniform block unless its range is 0, bindings 1… `images` sampled images.
struct SetNeeds {
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  VkDescriptorBufferInfo block{};
  std::size_t images = 0;
};

class Descriptors {
 public:
  /// Uniform blocks are written for good; images follow by `write_image`. Errors: device.
  static Result<Descriptors> create(const Device& device, const std::vector<SetNeeds>& needs);
  Descriptors() = default;

  VkDescriptorSet set(std::size_t kernel) const { return sets_[kernel]; }
  /// Must not be called while a submission that uses the set is in flight.
  void write_image(std::size_t kernel, std::size_t slot, VkImageView view, VkSampler sampler) const;

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  DescriptorPoolHandle pool_;
  std::vector<VkDescriptorSet> sets_;
};

}  // namespace afterglow
