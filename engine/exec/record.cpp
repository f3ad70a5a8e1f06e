#include "exec/record.h"

#include <array>

#include "shader/kernel.h"

namespace afterglow {

void record_kernel(const Device& device, VkCommandBuffer commands, const KernelCommands& kernel, VkImageView result) {
  device.begin_label(commands, kernel.name);
  record_barriers(commands, kernel.barriers.data(), kernel.barriers.size());

  const auto width = static_cast<std::uint32_t>(kernel.target_size.width);
  const auto height = static_cast<std::uint32_t>(kernel.target_size.height);
  const VkRect2D area{{0, 0}, {width, height}};
  // Every pixel is drawn: what the target held need not be loaded.
  const VkRenderingAttachmentInfo color{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                        .imageView = kernel.target != VK_NULL_HANDLE ? kernel.target : result,
                                        .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                        .loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                        .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
  const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = area,
                                  .layerCount = 1,
                                  .colorAttachmentCount = 1,
                                  .pColorAttachments = &color};
  vkCmdBeginRendering(commands, &rendering);
  const VkViewport viewport{0, 0, static_cast<float>(width), static_cast<float>(height), 0, 1};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &area);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, kernel.pipeline);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, kernel.layout, 0, 1, &kernel.set, 0, nullptr);
  const std::array<std::int32_t, 4> sizes{kernel.target_size.width, kernel.target_size.height,
                                          kernel.first_image_size.width, kernel.first_image_size.height};
  static_assert(sizeof sizes == kPushConstantBytes);
  vkCmdPushConstants(commands, kernel.layout, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof sizes, sizes.data());
  vkCmdDraw(commands, 3, 1, 0, 0);
  vkCmdEndRendering(commands);
  device.end_label(commands);
}

}  // namespace afterglow
