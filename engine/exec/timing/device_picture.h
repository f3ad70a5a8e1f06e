// SPDX-License-Identifier: MIT
// A picture and room for a result on the device, shared by all that is measured on that picture.
#pragma once

#include <compare>
#include <map>
#include <string>
#include <vector>

#include "exec/barriers.h"
#include "exec/frame_image.h"
#include "exec/program.h"
#include "image/picture.h"

namespace afterglow {

/// What stacks must have in common to share a picture.
struct PictureKind {
  VkFormat source = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< or RGBA16F
  VkFormat result = VK_FORMAT_R32G32B32A32_SFLOAT;
  int rows = 1;         ///< targets of the result (Program::result_rows)
  bool stored = false;  ///< the result is stored (Program::stores_result)
  friend auto operator<=>(const PictureKind&, const PictureKind&) = default;
};

class DevicePicture {
 public:
  /// Uploads the colour and auxiliary images, these as `input_format` says. Errors: device.
  static Result<DevicePicture> create(const Device& device, const Picture& picture, const PictureKind& kind);
  DevicePicture() = default;

  std::map<std::string, ImageBinding> inputs() const;
  ImageBinding source() const;
  ImageBinding result() const;

  /// Brings the inputs into the layout that a program wants and the result into that of a target; and back. Between
  /// uses inputs are in GENERAL.
  void before(VkCommandBuffer commands, VkImageLayout input_layout) const;
  void after(VkCommandBuffer commands, VkImageLayout input_layout) const;

 private:
  std::vector<VkImageMemoryBarrier2> turned(VkImageLayout from, VkImageLayout to) const;
  const Device* device_ = nullptr;
  std::map<std::string, FrameImage> inputs_;
  FrameImage result_;
  Writing writing_;
};

/// A new image on the device with the pixels of `image`, in `layout`. Errors: device.
Result<FrameImage> upload_image(const Device& device, const Image& image, VkFormat format, VkImageUsageFlags usage,
                                VkImageLayout layout);

}  // namespace afterglow
