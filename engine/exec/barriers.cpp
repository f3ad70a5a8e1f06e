#include "exec/barriers.h"

#include <set>

#include "gpu/image.h"

namespace afterglow {

VkImageMemoryBarrier2 before_drawing(VkImage image) {
  return image_barrier(image, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                       VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                       VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                       VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
}

VkImageMemoryBarrier2 into_general(VkImage image) {
  constexpr VkPipelineStageFlags2 kBoth =
      VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  return image_barrier(image, kBoth, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED, kBoth,
                       VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | reading_access(VK_IMAGE_LAYOUT_GENERAL),
                       VK_IMAGE_LAYOUT_GENERAL);
}

VkAccessFlags2 reading_access(VkImageLayout layout) {
  const VkAccessFlags2 storage = layout == VK_IMAGE_LAYOUT_GENERAL ? VK_ACCESS_2_SHADER_STORAGE_READ_BIT : 0;
  return VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | storage;
}

VkImageMemoryBarrier2 before_reading(VkImage image, VkImageLayout layout) {
  return image_barrier(image, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                       VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                       reading_access(layout), layout);
}

std::vector<KernelBarriers> kernel_barriers(const Plan& plan, const std::vector<std::vector<ImageId>>& read,
                                            const std::function<VkImage(ImageId)>& image_of,
                                            VkImageLayout read_layout) {
  std::vector<KernelBarriers> out(plan.kernels.size());
  std::set<ImageId> readable;
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    for (const ImageId id : read[i]) {
      const VkImage image = image_of(id);
      if (image != VK_NULL_HANDLE && readable.insert(id).second)
        out[i].images.push_back(before_reading(image, read_layout));
    }
    const VkImage target = image_of(plan.kernels[i].output);
    if (target != VK_NULL_HANDLE) out[i].images.push_back(before_drawing(target));
  }
  return out;
}

void record_barriers(const Device& device, VkCommandBuffer commands, const KernelBarriers& barriers) {
  if (barriers.images.empty() && !barriers.memory) return;
  const VkMemoryBarrier2 memory{
      .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
      .pNext = nullptr,
      .srcStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
      .srcAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
      .dstStageMask = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
      .dstAccessMask = reading_access(VK_IMAGE_LAYOUT_GENERAL) | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
  const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                              .memoryBarrierCount = barriers.memory ? 1u : 0u,
                              .pMemoryBarriers = &memory,
                              .imageMemoryBarrierCount = static_cast<std::uint32_t>(barriers.images.size()),
                              .pImageMemoryBarriers = barriers.images.data()};
  device.vk().vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace afterglow
