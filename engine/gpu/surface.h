// SPDX-License-Identifier: MIT
// Owner of a window's surface.
#pragma once

#include <utility>

#include "gpu/device.h"
#include "gpu/vulkan.h"

namespace afterglow {

/// Destroys its surface, which must have no swapchain any more then; the instance must still be there.
class Surface {
 public:
  /// Errors: device.
  static Result<Surface> create(const VulkanFunctions& vk, VkInstance instance, const Presentation& presentation);
  Surface() = default;
  Surface(Surface&& other) noexcept
      : instance_(other.instance_), destroy_(other.destroy_), surface_(std::exchange(other.surface_, VK_NULL_HANDLE)) {}
  Surface& operator=(Surface&& other) noexcept {
    std::swap(instance_, other.instance_);
    std::swap(destroy_, other.destroy_);
    std::swap(surface_, other.surface_);
    return *this;
  }
  ~Surface();

  VkSurfaceKHR get() const { return surface_; }

 private:
  VkInstance instance_ = VK_NULL_HANDLE;
  PFN_vkDestroySurfaceKHR destroy_ = nullptr;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
};

}  // namespace afterglow
