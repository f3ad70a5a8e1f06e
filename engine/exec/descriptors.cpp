// SPDX-License-Identifier: MIT
#include "exec/descriptors.h"

#include <map>

#include "gpu/error.h"

namespace afterglow {

namespace {

Result<DescriptorPoolHandle> create_pool(const Device& device, const std::vector<SetNeeds>& needs) {
  // One block too many: a pool of nothing is not possible, a program that needs nothing is.
  std::map<VkDescriptorType, std::uint32_t> counts{{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1u}};
  for (const auto& need : needs) {
    counts[VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER] += need.block.range > 0;
    for (const auto type : need.images) ++counts[type];
  }
  std::vector<VkDescriptorPoolSize> sizes;
  for (const auto& [type, count] : counts) sizes.push_back({type, count});
  const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .maxSets = static_cast<std::uint32_t>(needs.size()),
                                        .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
                                        .pPoolSizes = sizes.data()};
  VkDescriptorPool pool = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreateDescriptorPool(device.handle(), &info, nullptr, &pool),
               "cannot create a descriptor pool");
  return DescriptorPoolHandle(device, pool);
}

}  // namespace

Result<Descriptors> Descriptors::create(const Device& device, const std::vector<SetNeeds>& needs) {
  Descriptors out;
  out.device_ = &device;
  AFTERGLOW_TRY(out.pool_, create_pool(device, needs));
  for (const auto& need : needs) {
    const VkDescriptorSetAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               .descriptorPool = out.pool_.get(),
                                               .descriptorSetCount = 1,
                                               .pSetLayouts = &need.layout};
    VkDescriptorSet set = VK_NULL_HANDLE;
    AFTERGLOW_VK(device.vk().vkAllocateDescriptorSets(device.handle(), &allocate, &set), "cannot allocate descriptors");
    out.sets_.push_back(set);
    out.images_.push_back(need.images);
    if (need.block.range == 0) continue;
    const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                     .dstSet = set,
                                     .dstBinding = 0,
                                     .descriptorCount = 1,
                                     .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                                     .pBufferInfo = &need.block};
    device.vk().vkUpdateDescriptorSets(device.handle(), 1, &write, 0, nullptr);
  }
  return out;
}

void Descriptors::write_image(std::size_t kernel, std::size_t slot, VkImageView view, VkImageLayout layout,
                              VkSampler sampler) const {
  const VkDescriptorImageInfo image{sampler, view, layout};
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = sets_[kernel],
                                   .dstBinding = static_cast<std::uint32_t>(slot) + 1,
                                   .descriptorCount = 1,
                                   .descriptorType = images_[kernel][slot],
                                   .pImageInfo = &image};
  device_->vk().vkUpdateDescriptorSets(device_->handle(), 1, &write, 0, nullptr);
}

void Descriptors::write_buffer(std::size_t kernel, std::size_t slot, const VkDescriptorBufferInfo& buffer) const {
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = sets_[kernel],
                                   .dstBinding = static_cast<std::uint32_t>(slot) + 1,
                                   .descriptorCount = 1,
                                   .descriptorType = images_[kernel][slot],
                                   .pBufferInfo = &buffer};
  device_->vk().vkUpdateDescriptorSets(device_->handle(), 1, &write, 0, nullptr);
}

}  // namespace afterglow
