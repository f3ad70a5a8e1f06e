// SPDX-License-Identifier: MIT
// Recording into command buffers of the caller.
#include <fmt/format.h>

#include <initializer_list>
#include <string_view>
#include <utility>
#include <vulkan/vulkan_format_traits.hpp>

#include "api/handles.h"

using namespace afterglow;
using namespace afterglow::api;

namespace {

ImageBinding binding_of(const afterglow_vulkan_image& image) {
  return {image.image, image.view, image.format, {static_cast<int>(image.width), static_cast<int>(image.height)}};
}

/// Shaders read floats.
bool is_of_integers(VkFormat format) {
  const std::string_view numbers = vk::componentNumericFormat(static_cast<vk::Format>(format), 0);
  return numbers == "UINT" || numbers == "SINT";
}

Result<void> check_image(const char* name, const afterglow_vulkan_image& image, const afterglow_vulkan_image& result) {
  const auto fail = [&](const char* what) { return usage(fmt::format("afterglow_bindings: {} {}", name, what)); };
  if (image.format == VK_FORMAT_UNDEFINED) return fail("has the format VK_FORMAT_UNDEFINED");
  if (is_of_integers(image.format)) return fail("has a format of integers; allowed: what shaders read as floats");
  if (vk::planeCount(static_cast<vk::Format>(image.format)) > 1)
    return fail("has a format of several planes; allowed: what shaders read without a conversion");
  if (image.image == result.image || image.view == result.view)
    return fail("is the image of the result, which cannot be read meanwhile");
  return {};
}

Result<Backend*> recording_backend(const afterglow_stack* stack, const char* function) {
  AFTERGLOW_TRY(Backend * backend, backend_of(stack, function));
  if (backend->options().commands) return backend;
  return usage(std::string(function) + ": the stack was not made with AFTERGLOW_USE_COMMANDS");
}

}  // namespace

VkFormat afterglow_stack_result_format(const afterglow_stack* stack) {
  return stack ? stack->backend->result_format() : VK_FORMAT_UNDEFINED;
}

afterglow_error* afterglow_stack_bind(afterglow_stack* stack, const afterglow_bindings* bindings) {
  return call([&]() -> Result<void> {
    AFTERGLOW_TRY(Backend * backend, recording_backend(stack, "afterglow_stack_bind"));
    AFTERGLOW_TRY(const auto given, take(bindings, afterglow_bindings_default(), "afterglow_bindings"));
    std::map<std::string, ImageBinding> inputs;
    for (const auto& [name, image] : std::initializer_list<std::pair<const char*, const afterglow_vulkan_image&>>{
             {"source", given.source}, {"depth", given.depth}, {"normal", given.normal}, {"motion", given.motion}}) {
      if (image.image == VK_NULL_HANDLE) continue;
      AFTERGLOW_CHECK(check_image(name, image, given.result));
      inputs[name] = binding_of(image);
    }
    return backend->bind(inputs, binding_of(given.result));
  });
}

afterglow_error* afterglow_stack_record(afterglow_stack* stack, VkCommandBuffer commands) {
  return call([&]() -> Result<void> {
    AFTERGLOW_TRY(Backend * backend, recording_backend(stack, "afterglow_stack_record"));
    if (commands == VK_NULL_HANDLE) return usage("afterglow_stack_record: commands is VK_NULL_HANDLE");
    return backend->record(commands);
  });
}
