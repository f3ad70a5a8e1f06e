// SPDX-License-Identifier: MIT
// A picture and room for a result on the device, shared by all that is measured on that picture.
#pragma once

#include <compare>
#include <map>
#include <string>

#include "exec/frame_image.h"
#include "exec/program.h"
#include "image/picture.h"

namespace afterglow {

/// What stacks must have in common to share a picture.
struct PictureKind {
  VkFormat source = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< or RGBA16F
  VkFormat result = VK_FORMAT_R32G32B32A32_SFLOAT;
  int rows = 1;  ///< targets of the result (Program::result_rows)
  friend auto operator<=>(const PictureKind&, const PictureKind&) = default;
};

class DevicePicture {
 public:
  /// Uploads the colour, and auxiliary images as full floats. Errors: device.
  static Result<DevicePicture> create(const Device& device, const Picture& picture, const PictureKind& kind);
  DevicePicture() = default;

  std::map<std::string, ImageBinding> inputs() const;
  ImageBinding source() const;
  ImageBinding result() const;

  /// Brings the source into the layout that a program wants and the result into that of a target; and back. Between
  /// uses the source is in GENERAL.
  void before(VkCommandBuffer commands, VkImageLayout source_layout) const;
  void after(VkCommandBuffer commands, VkImageLayout source_layout) const;

 private:
  const Device* device_ = nullptr;
  std::map<std::string, FrameImage> inputs_;
  FrameImage result_;
};

/// A new image on the device with the pixels of `image`, in GENERAL, or in SHADER_READ_ONLY_OPTIMAL. Errors: device.
Result<FrameImage> upload_image(const Device& device, const Image& image, VkFormat format, VkImageUsageFlags usage,
                                VkImageLayout layout);

}  // namespace afterglow
