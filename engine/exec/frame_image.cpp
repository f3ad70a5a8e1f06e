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

}  // namespace afterglow
