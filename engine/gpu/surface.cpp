#include "gpu/surface.h"

namespace afterglow {

Result<Surface> Surface::create(VkInstance instance, const Presentation& presentation) {
  AFTERGLOW_TRY(const VkSurfaceKHR surface, presentation.make_surface(instance));
  Surface out;
  out.instance_ = instance;
  out.surface_ = surface;
  return out;
}

Surface::~Surface() {
  if (surface_ != VK_NULL_HANDLE) vkDestroySurfaceKHR(instance_, surface_, nullptr);
}

}  // namespace afterglow
