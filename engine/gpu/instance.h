// SPDX-License-Identifier: MIT
// Vulkan instances and what the validation layer says. Used by gpu/device alone.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/result.h"
#include "gpu/device.h"
#include "gpu/vulkan.h"

namespace afterglow {

/// Destroys a VkInstance with its messenger.
class Instance {
 public:
  /// `log`: collect validation messages there (and load the layer); null: no validation. Errors: device.
  /// `extensions`: what a window system needs besides.
  static Result<Instance> create(std::shared_ptr<ValidationLog> log, const std::vector<std::string>& extensions = {});
  Instance() = default;
  Instance(Instance&& other) noexcept { *this = std::move(other); }
  Instance& operator=(Instance&& other) noexcept;
  ~Instance();

  VkInstance get() const { return instance_; }
  const VulkanFunctions& functions() const { return functions_; }
  /// Gives up ownership of the instance and its messenger.
  VkInstance release(VkDebugUtilsMessengerEXT& messenger);

 private:
  VulkanFunctions functions_;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::shared_ptr<ValidationLog> log_;
};

/// The first one of a process stays, so that drivers stay loaded: NVIDIA's, loaded anew each time, was not found any
/// more after some forty times (as it seems, for want of room for variables of threads).
void destroy_instance(const VulkanFunctions& vk, VkInstance instance, VkDebugUtilsMessengerEXT messenger);

}  // namespace afterglow
