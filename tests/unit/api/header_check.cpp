// SPDX-License-Identifier: MIT
// afterglow.h and afterglow.hpp are C++17 without a warning.
#define AFTERGLOW_VULKAN
#include "afterglow.hpp"

afterglow::Stack afterglow_header_check_cpp(const afterglow::Device& device);
afterglow::Stack afterglow_header_check_cpp(const afterglow::Device& device) {
  return afterglow::Stack(device, "look.lua");
}
