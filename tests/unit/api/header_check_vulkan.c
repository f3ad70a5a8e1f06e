// SPDX-License-Identifier: MIT
/* The same with Vulkan. */
#define AFTERGLOW_VULKAN
#include "afterglow.h"

size_t afterglow_header_check_vulkan(void);
size_t afterglow_header_check_vulkan(void) { return afterglow_adopted_device_default().struct_size; }
