// SPDX-License-Identifier: MIT
#include "window/view_table.h"

#include <cstring>
#include <utility>

namespace afterglow {

Result<void> ViewTable::take(const Device& device, const DisplayTable& table) {
  planes_ = 0;
  const std::size_t bytes = table.codes.size() * sizeof(float);
  AFTERGLOW_TRY(staging_,
                Buffer::create(device, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HostAccess::write, "display"));
  std::memcpy(staging_.data(), table.codes.data(), bytes);
  AFTERGLOW_CHECK(staging_.memory().flush());
  AFTERGLOW_TRY(image_,
                GpuImage::create(device, {.name = "display",
                                          .size = table.size,
                                          .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                          .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
  planes_ = table.planes;
  shaper_ = {table.bend, table.cells, table.cells_below, static_cast<float>(table.zero)};
  pending_ = true;
  return {};
}

void ViewTable::upload(const Device& device, VkCommandBuffer commands) {
  if (!std::exchange(pending_, false)) return;
  const auto into =
      image_barrier(image_.get(), VK_PIPELINE_STAGE_2_NONE, 0, VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_COPY_BIT,
                    VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  record_barriers(device, commands, &into, 1);
  const Size size = image_.desc().size;
  const VkBufferImageCopy copy{
      .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
      .imageExtent = {static_cast<std::uint32_t>(size.width), static_cast<std::uint32_t>(size.height), 1}};
  device.vk().vkCmdCopyBufferToImage(commands, staging_.get(), image_.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                                     &copy);
  const auto ready = image_barrier(image_.get(), VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                   VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  record_barriers(device, commands, &ready, 1);
}

}  // namespace afterglow
