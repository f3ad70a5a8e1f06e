// SPDX-License-Identifier: MIT
#include "exec/frame_image.h"

namespace afterglow {

Result<FrameImage> FrameImage::create(const Device& device, ImageDesc desc, HostAccess access, int rows) {
  FrameImage out;
  ImageDesc linear = desc;
  linear.tiling = VK_IMAGE_TILING_LINEAR;
  if (rows > 1) {
    if (access == HostAccess::none) linear.usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    AFTERGLOW_TRY(UnboundImage image, UnboundImage::create(device, linear));
    AFTERGLOW_TRY(out.rows, RowTargets::create(device, image, rows));
    AFTERGLOW_TRY(out.image, GpuImage::create(device, std::move(image), out.rows.needs(), access));
    AFTERGLOW_CHECK(out.rows.bind(device, out.image.memory().get(), 0));
    out.direct = access != HostAccess::none;
  } else if (access != HostAccess::none && check_image(device, linear)) {
    AFTERGLOW_TRY(out.image, GpuImage::create(device, linear, access));
    out.direct = true;
  } else {
    desc.usage |= desc.usage & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT ? VK_IMAGE_USAGE_TRANSFER_SRC_BIT
                                                                   : VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    AFTERGLOW_TRY(out.image, GpuImage::create(device, desc));
  }
  out.layout = initial_layout(out.image.desc());
  return out;
}

ImageBinding binding_of(const FrameImage& image) {
  return {image.image.get(), image.image.view(), image.image.desc().format, image.image.desc().size,
          image.rows.views()};
}

StagedImage staged(const FrameImage& image) {
  return {image.image.get(), image.image.desc().format, image.image.desc().size};
}

VkPipelineStageFlags2 shown_stage(const FrameImage& image) {
  return VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | (image.direct ? VK_PIPELINE_STAGE_2_HOST_BIT : 0);
}

VkAccessFlags2 shown_access(const FrameImage& image, VkAccessFlags2 host) {
  return VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | (image.direct ? host : 0);
}

}  // namespace afterglow
