// SPDX-License-Identifier: MIT
#include "exec/record.h"

#include <array>
#include <utility>

#include "shader/kernel.h"

namespace afterglow {

namespace {

void bind(const Device& device, VkCommandBuffer commands, const KernelCommands& kernel, VkDescriptorSet set) {
  const bool compute = kernel.group.has_value();
  const VkPipelineBindPoint point = compute ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS;
  device.vk().vkCmdBindPipeline(commands, point, kernel.pipeline);
  device.vk().vkCmdBindDescriptorSets(commands, point, kernel.layout, 0, 1, &set, 0, nullptr);
  const std::array<std::int32_t, 4> sizes{kernel.target_size.width, kernel.target_size.height,
                                          kernel.first_image_size.width, kernel.first_image_size.height};
  static_assert(sizeof sizes == kPushConstantBytes);
  const VkShaderStageFlags stages =
      compute ? VK_SHADER_STAGE_COMPUTE_BIT : VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
  device.vk().vkCmdPushConstants(commands, kernel.layout, stages, 0, sizeof sizes, sizes.data());
}

/// The image that tells two draws apart, wherever it was used last.
void begin_marks(const Device& device, VkCommandBuffer commands, const GpuImage& marks) {
  constexpr VkPipelineStageFlags2 kTests =
      VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
  constexpr VkAccessFlags2 kWrite = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  VkImageMemoryBarrier2 barrier =
      image_barrier(marks.get(), kTests, kWrite, VK_IMAGE_LAYOUT_UNDEFINED, kTests,
                    kWrite | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, VK_IMAGE_LAYOUT_GENERAL);
  barrier.subresourceRange.aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT;
  record_barriers(device, commands, &barrier, 1);
}

/// Every workgroup that makes a pixel of the part.
void dispatch(const Device& device, VkCommandBuffer commands, const KernelCommands& kernel, VkDescriptorSet set) {
  if (kernel.turn_before) record_compute_turn(device, commands, true);
  bind(device, commands, kernel, set);
  const auto groups = [](int first, int count, int pixels) {
    const int begin = first / pixels, end = (first + count + pixels - 1) / pixels;
    return std::pair(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end - begin));
  };
  const auto [x, across] = groups(kernel.part.x, kernel.part.width, kernel.group->width);
  const auto [y, down] = groups(kernel.part.y, kernel.part.height, kernel.group->height);
  device.vk().vkCmdDispatchBase(commands, x, y, 0, across, down, 1);
  if (kernel.turn_after) record_compute_turn(device, commands, false);
}

void draw(const Device& device, VkCommandBuffer commands, const KernelCommands& kernel, VkDescriptorSet set,
          const std::vector<VkImageView>& result) {
  const auto width = static_cast<std::uint32_t>(kernel.target_size.width);
  const auto height = static_cast<std::uint32_t>((kernel.target_size.height + kernel.rows - 1) / kernel.rows);
  const Rect& part = kernel.part;
  const int first_row = part.y / kernel.rows, last_row = (part.y + part.height + kernel.rows - 1) / kernel.rows;
  const VkRect2D area{{part.x, first_row},
                      {static_cast<std::uint32_t>(part.width), static_cast<std::uint32_t>(last_row - first_row)}};
  const auto& targets = kernel.targets.empty() ? result : kernel.targets;
  std::array<VkRenderingAttachmentInfo, kMaxRows> colors;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    // Every pixel that anybody reads is drawn: what the target held need not be loaded.
    colors[i] = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                 .imageView = targets[i],
                 .imageLayout = kernel.target_layout,
                 .loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                 .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
  }
  if (kernel.marks) begin_marks(device, commands, *kernel.marks);
  const VkRenderingAttachmentInfo marks{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                        .imageView = kernel.marks ? kernel.marks->view() : VK_NULL_HANDLE,
                                        .imageLayout = VK_IMAGE_LAYOUT_GENERAL,
                                        .loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                        .storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE};
  const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = area,
                                  .layerCount = 1,
                                  .colorAttachmentCount = static_cast<std::uint32_t>(targets.size()),
                                  .pColorAttachments = colors.data(),
                                  .pDepthAttachment = kernel.marks ? &marks : nullptr};
  device.vk().vkCmdBeginRendering(commands, &rendering);
  const VkViewport viewport{0, 0, static_cast<float>(width), static_cast<float>(height), 0, 1};
  device.vk().vkCmdSetViewport(commands, 0, 1, &viewport);
  device.vk().vkCmdSetScissor(commands, 0, 1, &area);
  bind(device, commands, kernel, set);
  device.vk().vkCmdDraw(commands, 3, 1, 0, 0);
  if (kernel.rest != VK_NULL_HANDLE) {
    device.vk().vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, kernel.rest);
    device.vk().vkCmdDraw(commands, 3, 1, 0, 0);
  }
  device.vk().vkCmdEndRendering(commands);
}

}  // namespace

void record_kernel(const Device& device, VkCommandBuffer commands, const KernelCommands& kernel, VkDescriptorSet set,
                   const std::vector<VkImageView>& result) {
  device.begin_label(commands, kernel.name);
  record_barriers(device, commands, kernel.barriers);
  if (kernel.group)
    dispatch(device, commands, kernel, set);
  else
    draw(device, commands, kernel, set, result);
  record_barriers(device, commands, kernel.after);
  device.end_label(commands);
}

}  // namespace afterglow
