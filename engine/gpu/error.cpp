// SPDX-License-Identifier: MIT
#include "gpu/error.h"

#include <fmt/format.h>

namespace afterglow {

namespace {

struct Known {
  VkResult result;
  const char* name;
  const char* meaning;
};

constexpr Known kKnown[] = {
    {VK_NOT_READY, "VK_NOT_READY", "not ready"},
    {VK_TIMEOUT, "VK_TIMEOUT", "timed out"},
    {VK_ERROR_OUT_OF_HOST_MEMORY, "VK_ERROR_OUT_OF_HOST_MEMORY", "out of host memory"},
    {VK_ERROR_OUT_OF_DEVICE_MEMORY, "VK_ERROR_OUT_OF_DEVICE_MEMORY", "out of device memory"},
    {VK_ERROR_INITIALIZATION_FAILED, "VK_ERROR_INITIALIZATION_FAILED", "the driver failed to initialise"},
    {VK_ERROR_DEVICE_LOST, "VK_ERROR_DEVICE_LOST", "device lost"},
    {VK_ERROR_MEMORY_MAP_FAILED, "VK_ERROR_MEMORY_MAP_FAILED", "memory could not be mapped"},
    {VK_ERROR_LAYER_NOT_PRESENT, "VK_ERROR_LAYER_NOT_PRESENT", "layer not installed"},
    {VK_ERROR_EXTENSION_NOT_PRESENT, "VK_ERROR_EXTENSION_NOT_PRESENT", "extension not supported"},
    {VK_ERROR_FEATURE_NOT_PRESENT, "VK_ERROR_FEATURE_NOT_PRESENT", "feature not supported"},
    {VK_ERROR_INCOMPATIBLE_DRIVER, "VK_ERROR_INCOMPATIBLE_DRIVER", "no usable Vulkan driver"},
    {VK_ERROR_TOO_MANY_OBJECTS, "VK_ERROR_TOO_MANY_OBJECTS", "too many objects"},
    {VK_ERROR_FORMAT_NOT_SUPPORTED, "VK_ERROR_FORMAT_NOT_SUPPORTED", "format not supported"},
    {VK_ERROR_FRAGMENTED_POOL, "VK_ERROR_FRAGMENTED_POOL", "fragmented pool"},
    {VK_ERROR_OUT_OF_POOL_MEMORY, "VK_ERROR_OUT_OF_POOL_MEMORY", "out of pool memory"},
    {VK_ERROR_SURFACE_LOST_KHR, "VK_ERROR_SURFACE_LOST_KHR", "the window's surface was lost"},
    {VK_ERROR_NATIVE_WINDOW_IN_USE_KHR, "VK_ERROR_NATIVE_WINDOW_IN_USE_KHR", "the window is in use"},
    {VK_ERROR_OUT_OF_DATE_KHR, "VK_ERROR_OUT_OF_DATE_KHR", "the window has changed"},
    {VK_ERROR_UNKNOWN, "VK_ERROR_UNKNOWN", "unknown error"},
};

}  // namespace

std::string result_name(VkResult result) {
  for (const auto& known : kKnown) {
    if (known.result == result) return known.name;
  }
  return fmt::format("VkResult {}", static_cast<int>(result));
}

Error vulkan_error(VkResult result, std::string_view what) {
  for (const auto& known : kKnown) {
    if (known.result == result) {
      return Error{ErrorKind::device, fmt::format("{}: {} ({})", what, known.meaning, known.name)};
    }
  }
  return Error{ErrorKind::device, fmt::format("{}: {}", what, result_name(result))};
}

}  // namespace afterglow
