// Owner of a window's surface.
#pragma once

#include <vulkan/vulkan.h>

#include <utility>

#include "gpu/device.h"

namespace afterglow {

/// Destroys its surface, which must have no swapchain any more then; the instance must still be there.
class Surface {
 public:
  /// Errors: device.
  static Result<Surface> create(VkInstance instance, const Presentation& presentation);
  Surface() = default;
  Surface(Surface&& other) noexcept
      : instance_(other.instance_), surface_(std::exchange(other.surface_, VK_NULL_HANDLE)) {}
  Surface& operator=(Surface&& other) noexcept {
    std::swap(instance_, other.instance_);
    std::swap(surface_, other.surface_);
    return *this;
  }
  ~Surface();

  VkSurfaceKHR get() const { return surface_; }

 private:
  VkInstance instance_ = VK_NULL_HANDLE;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
};

}  // namespace afterglow
