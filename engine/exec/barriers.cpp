// SPDX-License-Identifier: MIT
#include "exec/barriers.h"

#include <map>
#include <set>

#include "gpu/image.h"

namespace afterglow {

namespace {

constexpr VkPipelineStageFlags2 kShaders =
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkPipelineStageFlags2 kKernels = kShaders | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;

void record(const Device& device, VkCommandBuffer commands, const VkMemoryBarrier2* memory,
            const std::vector<VkImageMemoryBarrier2>& images) {
  const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                              .memoryBarrierCount = memory ? 1u : 0u,
                              .pMemoryBarriers = memory,
                              .imageMemoryBarrierCount = static_cast<std::uint32_t>(images.size()),
                              .pImageMemoryBarriers = images.data()};
  device.vk().vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace

Writing writing_of(const PlanKernel& kernel) {
  if (!kernel.dispatched) return {};
  return kStored;
}

VkImageMemoryBarrier2 before_writing(VkImage image, const Writing& writing) {
  return image_barrier(image, kKernels, kWrites, VK_IMAGE_LAYOUT_UNDEFINED, writing.stage, writing.access,
                       writing.layout);
}

VkImageMemoryBarrier2 into_general(VkImage image) {
  return image_barrier(image, kKernels, kWrites, VK_IMAGE_LAYOUT_UNDEFINED, kKernels,
                       kWrites | reading_access(VK_IMAGE_LAYOUT_GENERAL), VK_IMAGE_LAYOUT_GENERAL);
}

VkAccessFlags2 reading_access(VkImageLayout layout) {
  const VkAccessFlags2 storage = layout == VK_IMAGE_LAYOUT_GENERAL ? VK_ACCESS_2_SHADER_STORAGE_READ_BIT : 0;
  return VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | storage;
}

VkImageMemoryBarrier2 before_reading(VkImage image, VkImageLayout layout, const Writing& writing) {
  return image_barrier(image, writing.stage, writing.access, writing.layout, kShaders, reading_access(layout), layout);
}

std::vector<KernelBarriers> kernel_barriers(const Plan& plan, const std::vector<std::vector<ImageId>>& read,
                                            const std::function<VkImage(ImageId)>& image_of,
                                            VkImageLayout read_layout) {
  std::vector<KernelBarriers> out(plan.kernels.size());
  std::set<ImageId> readable;
  std::map<ImageId, Writing> written;
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    for (const ImageId id : read[i]) {
      const VkImage image = image_of(id);
      if (image != VK_NULL_HANDLE && readable.insert(id).second)
        out[i].images.push_back(before_reading(image, read_layout, written[id]));
    }
    const VkImage target = image_of(plan.kernels[i].output);
    written[plan.kernels[i].output] = writing_of(plan.kernels[i]);
    if (target != VK_NULL_HANDLE) out[i].images.push_back(before_writing(target, written[plan.kernels[i].output]));
  }
  return out;
}

void record_compute_turn(const Device& device, VkCommandBuffer commands, bool before) {
  // What is ready for fragment shaders is available: no writes need to be waited for.
  const VkMemoryBarrier2 turn{
      .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
      .pNext = nullptr,
      .srcStageMask = before ? VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT : VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
      .srcAccessMask = 0,
      .dstStageMask = before ? VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT : VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
      .dstAccessMask = before ? reading_access(VK_IMAGE_LAYOUT_GENERAL) : 0};
  record(device, commands, &turn, {});
}

void record_barriers(const Device& device, VkCommandBuffer commands, const KernelBarriers& barriers) {
  if (barriers.images.empty() && !barriers.memory) return;
  const VkMemoryBarrier2 memory{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                .pNext = nullptr,
                                .srcStageMask = kKernels,
                                .srcAccessMask = kWrites,
                                .dstStageMask = kKernels,
                                .dstAccessMask = reading_access(VK_IMAGE_LAYOUT_GENERAL) | kWrites};
  record(device, commands, barriers.memory ? &memory : nullptr, barriers.images);
}

}  // namespace afterglow
