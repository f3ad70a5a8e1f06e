// SPDX-License-Identifier: MIT
#include "gpu/row_targets.h"

#include <algorithm>

namespace afterglow {
namespace {

VkSubresourceLayout layout_of(const Device& device, VkImage image) {
  const VkImageSubresource subresource{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0};
  VkSubresourceLayout layout{};
  device.vk().vkGetImageSubresourceLayout(device.handle(), image, &subresource, &layout);
  return layout;
}

ImageDesc target_desc(const ImageDesc& desc, VkDeviceSize pitch, int rows) {
  const auto texels = static_cast<int>(pitch / bytes_per_pixel(desc.format));  // of a row, with what pads it
  return {.name = desc.name + " by rows",
          .size = {texels * rows, (desc.size.height + rows - 1) / rows},
          .format = desc.format,
          .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
          .tiling = VK_IMAGE_TILING_LINEAR};
}

/// Whether targets of `rows` rows lie where the image's rows lie.
bool fits(const Device& device, const UnboundImage& image, int rows) {
  const VkSubresourceLayout layout = layout_of(device, image.get());
  const std::uint32_t texel = bytes_per_pixel(image.desc().format);
  if (texel == 0 || layout.offset != 0 || layout.rowPitch % texel != 0) return false;
  const ImageDesc desc = target_desc(image.desc(), layout.rowPitch, rows);
  if (!check_image(device, desc)) return false;
  const auto target = UnboundImage::create(device, desc);
  if (!target) return false;
  const VkSubresourceLayout wide = layout_of(device, target->get());
  return wide.offset == 0 && wide.rowPitch == layout.rowPitch * static_cast<VkDeviceSize>(rows) &&
         layout.rowPitch % target->needs().alignment == 0;
}

}  // namespace

int RowTargets::possible(const Device& device, const ImageDesc& desc, int wanted) {
  const auto& limits = device.properties().limits;
  const auto most = static_cast<int>(std::min(limits.maxColorAttachments, limits.maxFragmentOutputAttachments));
  int rows = 1;
  while (rows * 2 <= std::min(wanted, most)) rows *= 2;
  if (rows == 1 || desc.tiling != VK_IMAGE_TILING_LINEAR || !check_image(device, desc)) return 1;
  const auto image = UnboundImage::create(device, desc);
  if (!image) return 1;
  while (rows > 1 && !fits(device, *image, rows)) rows /= 2;
  return rows;
}

Result<RowTargets> RowTargets::create(const Device& device, const UnboundImage& image, int rows) {
  RowTargets out;
  out.pitch_ = layout_of(device, image.get()).rowPitch;
  out.needs_ = image.needs();
  for (int k = 0; k < rows; ++k) {
    AFTERGLOW_TRY(UnboundImage target, UnboundImage::create(device, target_desc(image.desc(), out.pitch_, rows)));
    const VkMemoryRequirements& needs = target.needs();
    out.needs_.size = std::max(out.needs_.size, static_cast<VkDeviceSize>(k) * out.pitch_ + needs.size);
    out.needs_.alignment = std::max(out.needs_.alignment, needs.alignment);
    out.needs_.memoryTypeBits &= needs.memoryTypeBits;
    out.targets_.push_back(std::move(target));
  }
  return out;
}

Result<void> RowTargets::bind(const Device& device, VkDeviceMemory memory, VkDeviceSize offset) {
  for (std::size_t k = 0; k < targets_.size(); ++k)
    AFTERGLOW_CHECK(targets_[k].bind(device, memory, offset + static_cast<VkDeviceSize>(k) * pitch_));
  return {};
}

std::vector<VkImageView> RowTargets::views() const {
  std::vector<VkImageView> views;
  for (const auto& target : targets_) views.push_back(target.view());
  return views;
}

}  // namespace afterglow
