// SPDX-License-Identifier: MIT
#include "gpu/image.h"

#include <fmt/format.h>

#include "core/text.h"
#include "gpu/error.h"

namespace afterglow {

std::uint32_t bytes_per_pixel(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return 16;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R32G32_SFLOAT:
      return 8;
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_B8G8R8A8_UNORM:
      return 4;
    case kDepthFormat:
    case VK_FORMAT_R16_SFLOAT:
      return 2;
    default:
      return 0;
  }
}

namespace {

VkFormatFeatureFlags features_for(VkImageUsageFlags usage) {
  VkFormatFeatureFlags features = 0;
  if (usage & VK_IMAGE_USAGE_SAMPLED_BIT) features |= VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
  if (usage & VK_IMAGE_USAGE_STORAGE_BIT) features |= VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
  if (usage & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT) features |= VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT;
  if (usage & VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT) features |= VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT;
  return features;
}

}  // namespace

bool supports(const VulkanFunctions& vk, VkPhysicalDevice device, VkFormat format, VkFormatFeatureFlags wanted,
              VkImageTiling tiling) {
  VkFormatProperties properties{};
  vk.vkGetPhysicalDeviceFormatProperties(device, format, &properties);
  const VkFormatFeatureFlags has =
      tiling == VK_IMAGE_TILING_LINEAR ? properties.linearTilingFeatures : properties.optimalTilingFeatures;
  return (has & wanted) == wanted;
}

bool supports(const Device& device, VkFormat format, VkFormatFeatureFlags wanted) {
  return supports(device.vk(), device.physical(), format, wanted);
}

VkFormat float_format(int channels, bool half) {
  if (channels == 1) return half ? VK_FORMAT_R16_SFLOAT : VK_FORMAT_R32_SFLOAT;
  if (channels == 2) return half ? VK_FORMAT_R16G16_SFLOAT : VK_FORMAT_R32G32_SFLOAT;
  return half ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
}

Result<void> check_image(const Device& device, const ImageDesc& desc) {
  const int width = desc.size.width, height = desc.size.height;
  const auto fail = [&](const std::string& why) {
    return Error{ErrorKind::device, fmt::format("image '{}' of {}×{} pixels: {}", desc.name, width, height, why)};
  };
  if (width < 1 || height < 1) return fail("sizes start at 1×1");
  if (desc.tiling == VK_IMAGE_TILING_LINEAR && device.forced().unmapped)
    return fail("linear images are not to be used");
  VkImageFormatProperties limits{};
  const VkResult result = device.vk().vkGetPhysicalDeviceImageFormatProperties(
      device.physical(), desc.format, VK_IMAGE_TYPE_2D, desc.tiling, desc.usage, 0, &limits);
  // Some drivers make images that no view can be made of.
  const bool viewed = supports(device.vk(), device.physical(), desc.format, features_for(desc.usage), desc.tiling);
  if (result == VK_ERROR_FORMAT_NOT_SUPPORTED || (result == VK_SUCCESS && !viewed))
    return fail("the device does not support the format for this use");
  if (result != VK_SUCCESS) return vulkan_error(result, desc.name);
  const auto max_width = std::min(limits.maxExtent.width, device.properties().limits.maxFramebufferWidth);
  const auto max_height = std::min(limits.maxExtent.height, device.properties().limits.maxFramebufferHeight);
  if (static_cast<std::uint32_t>(width) > max_width || static_cast<std::uint32_t>(height) > max_height) {
    return fail(fmt::format("the device allows {}×{}", max_width, max_height));
  }
  const auto bytes = static_cast<VkDeviceSize>(desc.size.area()) * bytes_per_pixel(desc.format);
  const auto max_bytes = std::min(limits.maxResourceSize, device.max_allocation());
  if (bytes > max_bytes) {
    return fail(
        fmt::format("needs {}, the device allows {} for one image", memory_text(bytes), memory_text(max_bytes)));
  }
  return {};
}

VkImageLayout initial_layout(const ImageDesc& desc) {
  return desc.tiling == VK_IMAGE_TILING_LINEAR ? VK_IMAGE_LAYOUT_PREINITIALIZED : VK_IMAGE_LAYOUT_UNDEFINED;
}

Result<UnboundImage> UnboundImage::create(const Device& device, const ImageDesc& desc) {
  AFTERGLOW_CHECK(check_image(device, desc));
  const VkImageCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
      .imageType = VK_IMAGE_TYPE_2D,
      .format = desc.format,
      .extent = {static_cast<std::uint32_t>(desc.size.width), static_cast<std::uint32_t>(desc.size.height), 1},
      .mipLevels = 1,
      .arrayLayers = 1,
      .samples = VK_SAMPLE_COUNT_1_BIT,
      .tiling = desc.tiling,
      .usage = desc.usage,
      .initialLayout = initial_layout(desc)};
  VkImage handle = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreateImage(device.handle(), &info, nullptr, &handle),
               fmt::format("cannot create image '{}' of {}×{} pixels", desc.name, desc.size.width, desc.size.height));
  UnboundImage out;
  out.desc_ = desc;
  out.image_ = ImageHandle(device, handle);
  device.vk().vkGetImageMemoryRequirements(device.handle(), handle, &out.needs_);
  device.set_name(VK_OBJECT_TYPE_IMAGE, out.image_.number(), desc.name);
  return out;
}

Result<void> UnboundImage::bind(const Device& device, VkDeviceMemory memory, VkDeviceSize offset) {
  AFTERGLOW_VK(device.vk().vkBindImageMemory(device.handle(), image_.get(), memory, offset), desc_.name);
  constexpr VkImageUsageFlags kViewed =
      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  const VkImageAspectFlags aspect =
      desc_.format == kDepthFormat ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
  if (!(desc_.usage & kViewed)) return {};
  const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                   .image = image_.get(),
                                   .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                   .format = desc_.format,
                                   .subresourceRange = {aspect, 0, 1, 0, 1}};
  VkImageView view = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreateImageView(device.handle(), &info, nullptr, &view), desc_.name);
  view_ = ImageViewHandle(device, view);
  return {};
}

Result<GpuImage> GpuImage::create(const Device& device, const ImageDesc& desc, HostAccess access) {
  AFTERGLOW_TRY(UnboundImage image, UnboundImage::create(device, desc));
  const VkMemoryRequirements needs = image.needs();
  return create(device, std::move(image), needs, access);
}

Result<GpuImage> GpuImage::create(const Device& device, UnboundImage image, const VkMemoryRequirements& needs,
                                  HostAccess access) {
  GpuImage out;
  out.image_ = std::move(image);
  AFTERGLOW_TRY(out.memory_, Memory::allocate(device, needs, access, "image '" + out.desc().name + "'"));
  AFTERGLOW_CHECK(out.image_.bind(device, out.memory_.get(), 0));
  if (access != HostAccess::none) {
    const VkImageSubresource subresource{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0};
    device.vk().vkGetImageSubresourceLayout(device.handle(), out.get(), &subresource, &out.layout_);
  }
  return out;
}

VkImageMemoryBarrier2 image_barrier(VkImage image, VkPipelineStageFlags2 from_stage, VkAccessFlags2 from_access,
                                    VkImageLayout from, VkPipelineStageFlags2 to_stage, VkAccessFlags2 to_access,
                                    VkImageLayout to) {
  return {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
          .pNext = nullptr,
          .srcStageMask = from_stage,
          .srcAccessMask = from_access,
          .dstStageMask = to_stage,
          .dstAccessMask = to_access,
          .oldLayout = from,
          .newLayout = to,
          .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
          .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
          .image = image,
          .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
}

void record_barriers(const Device& device, VkCommandBuffer commands, const VkImageMemoryBarrier2* barriers,
                     std::size_t count) {
  if (count == 0) return;
  const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                              .imageMemoryBarrierCount = static_cast<std::uint32_t>(count),
                              .pImageMemoryBarriers = barriers};
  device.vk().vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace afterglow
