#include "exec/record.h"

#include <array>

#include "shader/kernel.h"

namespace afterglow {

void record_kernel(const Device& device, VkCommandBuffer commands, const KernelCommands& kernel,
                   const std::vector<VkImageView>& result) {
  device.begin_label(commands, kernel.name);
  record_barriers(device, commands, kernel.barriers);

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
  const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = area,
                                  .layerCount = 1,
                                  .colorAttachmentCount = static_cast<std::uint32_t>(targets.size()),
                                  .pColorAttachments = colors.data()};
  device.vk().vkCmdBeginRendering(commands, &rendering);
  const VkViewport viewport{0, 0, static_cast<float>(width), static_cast<float>(height), 0, 1};
  device.vk().vkCmdSetViewport(commands, 0, 1, &viewport);
  device.vk().vkCmdSetScissor(commands, 0, 1, &area);
  device.vk().vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, kernel.pipeline);
  device.vk().vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, kernel.layout, 0, 1, &kernel.set, 0,
                                      nullptr);
  const std::array<std::int32_t, 4> sizes{kernel.target_size.width, kernel.target_size.height,
                                          kernel.first_image_size.width, kernel.first_image_size.height};
  static_assert(sizeof sizes == kPushConstantBytes);
  device.vk().vkCmdPushConstants(commands, kernel.layout, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof sizes, sizes.data());
  device.vk().vkCmdDraw(commands, 3, 1, 0, 0);
  device.vk().vkCmdEndRendering(commands);
  record_barriers(device, commands, kernel.after);
  device.end_label(commands);
}

}  // namespace afterglow
