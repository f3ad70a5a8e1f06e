// A picture of a frame on the device.
#pragma once

#include "gpu/image.h"

namespace afterglow {

struct FrameImage {
  GpuImage image;
  bool direct = false;                               ///< the CPU touches its pixels; else they go over Staging
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< between frames

  /// With `access`, an image that the CPU can touch, if the device has such images of this size; else one for staging.
  static Result<FrameImage> create(const Device& device, ImageDesc desc, HostAccess access);
  /// Whether it can serve for `desc` (tiling aside).
  bool fits(const ImageDesc& desc) const {
    return image && image.desc().size == desc.size && image.desc().format == desc.format &&
           (image.desc().usage & desc.usage) == desc.usage;
  }
};

}  // namespace afterglow
