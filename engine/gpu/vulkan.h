// SPDX-License-Identifier: MIT
// Vulkan's types without its functions: those are fetched for each instance and device (gpu/functions.h), so that the
// library works in programs that have function pointers of the same names.
#pragma once

#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <vulkan/vulkan.h>
