// SPDX-License-Identifier: MIT
#include "window/paint_check.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>

namespace afterglow {

void copy_target(const Device& device, VkCommandBuffer commands, VkImage image, Size size, const Buffer& to) {
  const auto into =
      image_barrier(image, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                    VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_2_COPY_BIT,
                    VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  record_barriers(device, commands, &into, 1);
  const VkBufferImageCopy copy{
      .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
      .imageExtent = {static_cast<std::uint32_t>(size.width), static_cast<std::uint32_t>(size.height), 1}};
  device.vk().vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.get(), 1, &copy);
  const auto back = image_barrier(image, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                  0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  record_barriers(device, commands, &back, 1);
  record_to_host(device, commands, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
}

Result<PresentTarget> PaintCheck::begin(const Device& device, VkCommandBuffer commands, const PresentTarget& target) {
  if (size_ != target.size || !whole_) {
    const auto bytes = static_cast<VkDeviceSize>(target.size.area()) * 4;
    AFTERGLOW_TRY(
        whole_, GpuImage::create(device, {.name = "whole frame",
                                          .size = target.size,
                                          .format = target.format,
                                          .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                                   VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
    for (Buffer* buffer : {&parts_pixels_, &whole_pixels_}) {
      AFTERGLOW_TRY(*buffer, Buffer::create(device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HostAccess::read,
                                            "pixels to compare"));
    }
    size_ = target.size;
  }
  const auto into = image_barrier(whole_.get(), VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, 0,
                                  VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                  VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
                                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  record_barriers(device, commands, &into, 1);
  PresentTarget out = target;
  out.image = whole_.get();
  out.view = whole_.view();
  out.kept = false;
  return out;
}

Result<void> PaintCheck::end(const Device& device, VkCommandBuffer commands, const PresentTarget& target) {
  copy_target(device, commands, target.image, size_, parts_pixels_);
  copy_target(device, commands, whole_.get(), size_, whole_pixels_);
  return {};
}

Result<void> PaintCheck::compare() {
  AFTERGLOW_CHECK(parts_pixels_.memory().invalidate());
  AFTERGLOW_CHECK(whole_pixels_.memory().invalidate());
  const std::byte* parts = parts_pixels_.data();
  const std::byte* whole = whole_pixels_.data();
  const auto row = static_cast<std::size_t>(size_.width) * 4;
  for (int y = 0; y < size_.height; ++y, parts += row, whole += row) {
    if (std::memcmp(parts, whole, row) == 0) continue;
    std::size_t at = 0;
    while (parts[at] == whole[at]) ++at;
    at -= at % 4;
    const auto code = [&](const std::byte* pixels) {
      std::uint32_t out = 0;
      std::memcpy(&out, pixels + at, sizeof out);
      return out;
    };
    return Error{ErrorKind::device,
                 fmt::format("the window of {}x{} has {:08x} at {}, {}, a frame that is drawn wholly {:08x}",
                             size_.width, size_.height, code(parts), at / 4, y, code(whole))};
  }
  return {};
}

}  // namespace afterglow
