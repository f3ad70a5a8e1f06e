// SPDX-License-Identifier: MIT
// Recording into command buffers of the caller.
#include "api/handles.h"

using namespace afterglow;
using namespace afterglow::api;

namespace {

ImageBinding binding_of(const afterglow_vulkan_image& image) {
  return {image.image, image.view, image.format, {static_cast<int>(image.width), static_cast<int>(image.height)}};
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
    const auto add = [&](const char* name, const afterglow_vulkan_image& image) {
      if (image.image != VK_NULL_HANDLE) inputs[name] = binding_of(image);
    };
    add("source", given.source);
    add("depth", given.depth);
    add("normal", given.normal);
    add("motion", given.motion);
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
