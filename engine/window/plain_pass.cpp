// SPDX-License-Identifier: MIT
#include "window/plain_pass.h"

#include <bit>

#include "gpu/device.h"
#include "gpu/image.h"

namespace afterglow {

PlainPass::PlainPass(const Device& device, VkFormat target, std::size_t slots) : device_(device), codes_(slots) {
  blue_first_ = target == VK_FORMAT_B8G8R8A8_UNORM || target == VK_FORMAT_B8G8R8A8_SRGB;
  const bool red_first = target == VK_FORMAT_R8G8B8A8_UNORM || target == VK_FORMAT_R8G8B8A8_SRGB;
  works_ = device.is_cpu() && (blue_first_ || red_first);
}

void PlainPass::begin(std::size_t slot) {
  slot_ = slot;
  parts_.clear();
}

void PlainPass::add(const PlainView& view, const Rect& pixels) {
  if (pixels.size().area() > 0) parts_.push_back({view, pixels});
}

Result<bool> PlainPass::record(VkCommandBuffer commands, VkImage target) {
  if (parts_.empty()) return false;
  std::size_t bytes = 0;
  for (const Part& part : parts_) bytes += static_cast<std::size_t>(part.pixels.size().area()) * 4;
  Buffer& codes = codes_[slot_];
  if (codes.get() == VK_NULL_HANDLE || codes.size() < bytes) {
    AFTERGLOW_TRY(codes, Buffer::create(device_, std::bit_ceil(bytes), VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                        HostAccess::write, "view"));
  }
  std::vector<VkBufferImageCopy> copies;
  std::size_t at = 0;
  for (const auto& [view, pixels] : parts_) {
    write_plain_view(view, pixels, codes.data() + at);
    copies.push_back(
        {.bufferOffset = at,
         .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
         .imageOffset = {pixels.x, pixels.y, 0},
         .imageExtent = {static_cast<std::uint32_t>(pixels.width), static_cast<std::uint32_t>(pixels.height), 1}});
    at += static_cast<std::size_t>(pixels.size().area()) * 4;
  }
  AFTERGLOW_CHECK(codes.memory().flush());
  const auto into =
      image_barrier(target, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                    VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_2_COPY_BIT,
                    VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  record_barriers(device_, commands, &into, 1);
  device_.begin_label(commands, "view");
  device_.vk().vkCmdCopyBufferToImage(commands, codes.get(), target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                      static_cast<std::uint32_t>(copies.size()), copies.data());
  device_.end_label(commands);
  const auto back = image_barrier(target, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                  VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                  VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
                                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  record_barriers(device_, commands, &back, 1);
  return true;
}

}  // namespace afterglow
