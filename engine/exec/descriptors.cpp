#include "exec/descriptors.h"

#include <algorithm>

#include "gpu/error.h"

namespace afterglow {

namespace {

Result<DescriptorPoolHandle> create_pool(const Device& device, const std::vector<SetNeeds>& needs) {
  std::uint32_t blocks = 0, images = 0;
  for (const auto& need : needs) {
    blocks += need.block.range > 0;
    images += static_cast<std::uint32_t>(need.images);
  }
  // A pool holds at least one of each kind: kernels without blocks or images are possible, pools without are not.
  const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, std::max(blocks, 1u)},
                                        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, std::max(images, 1u)}};
  const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .maxSets = static_cast<std::uint32_t>(needs.size()),
                                        .poolSizeCount = 2,
                                        .pPoolSizes = sizes};
  VkDescriptorPool pool = VK_NULL_HANDLE;
  AFTERGLOW_VK(vkCreateDescriptorPool(device.handle(), &info, nullptr, &pool), "cannot create a descriptor pool");
  return DescriptorPoolHandle(device.handle(), pool);
}

}  // namespace

Result<Descriptors> Descriptors::create(const Device& device, const std::vector<SetNeeds>& needs) {
  Descriptors out;
  out.device_ = device.handle();
  AFTERGLOW_TRY(out.pool_, create_pool(device, needs));
  for (const auto& need : needs) {
    const VkDescriptorSetAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               .descriptorPool = out.pool_.get(),
                                               .descriptorSetCount = 1,
                                               .pSetLayouts = &need.layout};
    VkDescriptorSet set = VK_NULL_HANDLE;
    AFTERGLOW_VK(vkAllocateDescriptorSets(device.handle(), &allocate, &set), "cannot allocate descriptors");
    out.sets_.push_back(set);
    if (need.block.range == 0) continue;
    const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                     .dstSet = set,
                                     .dstBinding = 0,
                                     .descriptorCount = 1,
                                     .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                                     .pBufferInfo = &need.block};
    vkUpdateDescriptorSets(device.handle(), 1, &write, 0, nullptr);
  }
  return out;
}

void Descriptors::write_image(std::size_t kernel, std::size_t slot, VkImageView view, VkSampler sampler) const {
  const VkDescriptorImageInfo image{sampler, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = sets_[kernel],
                                   .dstBinding = static_cast<std::uint32_t>(slot) + 1,
                                   .descriptorCount = 1,
                                   .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                   .pImageInfo = &image};
  vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
}

}  // namespace afterglow
