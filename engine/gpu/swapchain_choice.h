// SPDX-License-Identifier: MIT
// What a swapchain is to be like, from what a surface can do: pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/geometry.h"
#include "gpu/vulkan.h"

namespace afterglow {

/// The format and colour space to present in: 8 bits of sRGB codes that shaders encode themselves, so that interfaces
/// blend as they are used to; else one whose stores encode. None when the surface has neither.
std::optional<VkSurfaceFormatKHR> choose_surface_format(std::span<const VkSurfaceFormatKHR> formats);

/// Whether stores to this format encode sRGB: shaders hand over linear values then.
bool encodes_srgb(VkFormat format);

/// Size of the images: what the surface prescribes; where it leaves that open, the window's, within its limits. Empty
/// (a side of 0) while the window is minimised.
Size choose_extent(const VkSurfaceCapabilitiesKHR& surface, Size window);

/// One more than the surface needs, so that drawing need not wait for the display; within its limits.
std::uint32_t choose_image_count(const VkSurfaceCapabilitiesKHR& surface);

/// FIFO (there is always that), or with `tearing` one that does not wait for the display, where there is one.
VkPresentModeKHR choose_present_mode(std::span<const VkPresentModeKHR> modes, bool tearing);

}  // namespace afterglow
