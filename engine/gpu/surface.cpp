// SPDX-License-Identifier: MIT
#include "gpu/surface.h"

namespace afterglow {

Result<Surface> Surface::create(const VulkanFunctions& vk, VkInstance instance, const Presentation& presentation) {
  AFTERGLOW_TRY(const VkSurfaceKHR surface, presentation.make_surface(instance));
  Surface out;
  out.instance_ = instance;
  out.destroy_ = vk.vkDestroySurfaceKHR;
  out.surface_ = surface;
  return out;
}

Surface::~Surface() {
  if (surface_ != VK_NULL_HANDLE) destroy_(instance_, surface_, nullptr);
}

}  // namespace afterglow
