// SPDX-License-Identifier: MIT
#include "gpu/swapchain_choice.h"

#include <algorithm>
#include <limits>

namespace afterglow {

std::optional<VkSurfaceFormatKHR> choose_surface_format(std::span<const VkSurfaceFormatKHR> formats) {
  constexpr VkFormat kOrder[] = {VK_FORMAT_B8G8R8A8_UNORM,
                                 VK_FORMAT_R8G8B8A8_UNORM,
                                 VK_FORMAT_A8B8G8R8_UNORM_PACK32,
                                 VK_FORMAT_A2B10G10R10_UNORM_PACK32,
                                 VK_FORMAT_A2R10G10B10_UNORM_PACK32,
                                 VK_FORMAT_B8G8R8A8_SRGB,
                                 VK_FORMAT_R8G8B8A8_SRGB,
                                 VK_FORMAT_A8B8G8R8_SRGB_PACK32};
  for (const VkFormat wanted : kOrder) {
    for (const auto& format : formats) {
      if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) return format;
    }
  }
  return std::nullopt;
}

bool encodes_srgb(VkFormat format) {
  return format == VK_FORMAT_B8G8R8A8_SRGB || format == VK_FORMAT_R8G8B8A8_SRGB ||
         format == VK_FORMAT_A8B8G8R8_SRGB_PACK32;
}

Size choose_extent(const VkSurfaceCapabilitiesKHR& surface, Size window) {
  constexpr auto kOpen = std::numeric_limits<std::uint32_t>::max();
  const auto size = [](VkExtent2D extent) {
    return Size{static_cast<int>(extent.width), static_cast<int>(extent.height)};
  };
  if (surface.currentExtent.width != kOpen) return size(surface.currentExtent);
  if (window.width <= 0 || window.height <= 0) return {};
  const Size least = size(surface.minImageExtent), most = size(surface.maxImageExtent);
  if (most.width == 0 || most.height == 0) return {};
  return {std::clamp(window.width, least.width, most.width), std::clamp(window.height, least.height, most.height)};
}

std::uint32_t choose_image_count(const VkSurfaceCapabilitiesKHR& surface) {
  const std::uint32_t wanted = surface.minImageCount + 1;
  return surface.maxImageCount == 0 ? wanted : std::min(wanted, surface.maxImageCount);
}

VkPresentModeKHR choose_present_mode(std::span<const VkPresentModeKHR> modes, bool tearing) {
  if (tearing) {
    for (const auto wanted : {VK_PRESENT_MODE_IMMEDIATE_KHR, VK_PRESENT_MODE_MAILBOX_KHR}) {
      if (std::ranges::find(modes, wanted) != modes.end()) return wanted;
    }
  }
  return VK_PRESENT_MODE_FIFO_KHR;
}

}  // namespace afterglow
