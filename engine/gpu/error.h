// SPDX-License-Identifier: MIT
// VkResult → Error.
#pragma once

#include <string_view>

#include "core/result.h"
#include "gpu/vulkan.h"

namespace afterglow {

/// "VK_ERROR_DEVICE_LOST"; "VkResult -12345" for codes we do not know.
std::string result_name(VkResult result);

/// A `device` error: "WHAT: out of device memory (VK_ERROR_OUT_OF_DEVICE_MEMORY)".
Error vulkan_error(VkResult result, std::string_view what);

/// Returns the error of a Vulkan call that did not succeed.
#define AFTERGLOW_VK(call, what) \
  if (const VkResult vk_result_ = (call); vk_result_ != VK_SUCCESS) return ::afterglow::vulkan_error(vk_result_, what)

}  // namespace afterglow
