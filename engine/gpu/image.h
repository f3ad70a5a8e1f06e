// SPDX-License-Identifier: MIT
// 2-D images: one level, one layer.
#pragma once

#include <array>
#include <string>

#include "core/geometry.h"
#include "gpu/memory.h"

namespace afterglow {

/// Of images that draws are tested against; every device has it.
inline constexpr VkFormat kDepthFormat = VK_FORMAT_D16_UNORM;

struct ImageDesc {
  std::string name;  ///< for messages and debuggers
  Size size;
  VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
  VkImageUsageFlags usage = 0;
  VkImageTiling tiling = VK_IMAGE_TILING_OPTIMAL;
};

/// Bytes of one pixel of the formats used here (R32F, RGBA32F, RGBA16F, RGBA8, BGRA8, kDepthFormat).
std::uint32_t bytes_per_pixel(VkFormat format);
/// Of 1, 2 or 4 channels of 16-bit or 32-bit floats.
VkFormat float_format(int channels, bool half);

/// Floats of one and two channels. Vulkan asks no device for them.
inline constexpr std::array kFewChannels{VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R16_SFLOAT,
                                         VK_FORMAT_R16G16_SFLOAT};
/// What every image between kernels is used for.
inline constexpr VkFormatFeatureFlags kDrawnAndSampled =
    VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT;
/// Whether optimally tiled images of the format can be used so.
bool supports(const VulkanFunctions& vk, VkPhysicalDevice device, VkFormat format, VkFormatFeatureFlags wanted,
              VkImageTiling tiling = VK_IMAGE_TILING_OPTIMAL);
bool supports(const Device& device, VkFormat format, VkFormatFeatureFlags wanted);

/// The layout of a new image: PREINITIALIZED for linear tiling, so that pixels written by the CPU stay; else UNDEFINED.
VkImageLayout initial_layout(const ImageDesc& desc);

/// Whether the device can make such an image at all. Errors: device, naming the limit that is exceeded. Allocates
/// nothing.
Result<void> check_image(const Device& device, const ImageDesc& desc);

/// An image with its view; the memory is bound by whoever made it.
class UnboundImage {
 public:
  static Result<UnboundImage> create(const Device& device, const ImageDesc& desc);
  UnboundImage() = default;
  /// To be called once. Errors: device.
  Result<void> bind(const Device& device, VkDeviceMemory memory, VkDeviceSize offset);

  VkImage get() const { return image_.get(); }
  VkImageView view() const { return view_.get(); }
  const VkMemoryRequirements& needs() const { return needs_; }
  const ImageDesc& desc() const { return desc_; }

 private:
  ImageDesc desc_;
  VkMemoryRequirements needs_{};
  ImageHandle image_;
  ImageViewHandle view_;  // after the image: destroyed before it
};

/// An image with memory of its own; with `access` other than `none` (linear tiling only) its pixels can be touched by
/// the CPU.
class GpuImage {
 public:
  static Result<GpuImage> create(const Device& device, const ImageDesc& desc, HostAccess access = HostAccess::none);
  /// For an image of the caller's and memory that it need not have to itself; `needs` says how much.
  static Result<GpuImage> create(const Device& device, UnboundImage image, const VkMemoryRequirements& needs,
                                 HostAccess access);
  GpuImage() = default;

  VkImage get() const { return image_.get(); }
  VkImageView view() const { return image_.view(); }
  const ImageDesc& desc() const { return image_.desc(); }
  const Memory& memory() const { return memory_; }
  explicit operator bool() const { return image_.get() != VK_NULL_HANDLE; }
  /// First byte of row y, for images with host access.
  std::byte* row(int y) const {
    return memory_.data() + layout_.offset + static_cast<VkDeviceSize>(y) * layout_.rowPitch;
  }
  VkDeviceSize row_pitch() const { return layout_.rowPitch; }

 private:
  Memory memory_;  // before the image: freed after it
  UnboundImage image_;
  VkSubresourceLayout layout_{};
};

/// A barrier for the whole of a colour image.
VkImageMemoryBarrier2 image_barrier(VkImage image, VkPipelineStageFlags2 from_stage, VkAccessFlags2 from_access,
                                    VkImageLayout from, VkPipelineStageFlags2 to_stage, VkAccessFlags2 to_access,
                                    VkImageLayout to);

/// Records image barriers as one dependency; nothing when there are none.
void record_barriers(const Device& device, VkCommandBuffer commands, const VkImageMemoryBarrier2* barriers,
                     std::size_t count);

}  // namespace afterglow
