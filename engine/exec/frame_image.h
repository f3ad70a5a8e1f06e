// SPDX-License-Identifier: MIT
// A picture of a frame on the device.
#pragma once

#include "exec/program.h"
#include "exec/staging.h"
#include "gpu/row_targets.h"

namespace afterglow {

struct FrameImage {
  GpuImage image;
  RowTargets rows;                                   ///< of an image that is written several rows at a time
  bool direct = false;                               ///< the CPU touches its pixels; else they go over Staging
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< between frames
  std::uint64_t writer = 0;                          ///< of a result: id of the program whose last run it holds

  /// With `access`, an image that the CPU can touch, if the device has such images of this size; else one for staging.
  /// `rows` above 1: linear, with targets by so many rows.
  static Result<FrameImage> create(const Device& device, ImageDesc desc, HostAccess access, int rows = 1);
  /// Whether it can serve for `desc` (tiling aside).
  bool fits(const ImageDesc& desc, int wanted_rows = 1) const {
    return image && std::max(rows.rows(), 1) == wanted_rows && image.desc().size == desc.size &&
           image.desc().format == desc.format && (image.desc().usage & desc.usage) == desc.usage;
  }
};

ImageBinding binding_of(const FrameImage& image);
StagedImage staged(const FrameImage& image);
/// Who reads an image after its frame: shaders of whoever shows it, and of direct ones the CPU (`host`: how).
VkPipelineStageFlags2 shown_stage(const FrameImage& image);
VkAccessFlags2 shown_access(const FrameImage& image, VkAccessFlags2 host);

}  // namespace afterglow
