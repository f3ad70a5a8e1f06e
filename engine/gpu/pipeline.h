// Full-screen draws: descriptor layouts, pipeline layouts and pipelines.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace afterglow {

/// What a full-screen fragment shader reads. Set 0: binding 0 a uniform block (when `block`), bindings 1… its images,
/// as combined image samplers or storage images; `push_bytes` of push constants.
struct DrawInterface {
  bool block = false;
  std::vector<VkDescriptorType> images;
  std::uint32_t push_bytes = 0;
  friend auto operator<=>(const DrawInterface&, const DrawInterface&) = default;
};

struct DrawLayout {
  SetLayoutHandle set;
  PipelineLayoutHandle pipeline;
};

/// Errors: device (more images than a fragment shader may read).
Result<DrawLayout> create_draw_layout(const Device& device, const DrawInterface& interface);

Result<ShaderModuleHandle> create_shader_module(const Device& device, std::span<const std::uint32_t> spirv,
                                                const std::string& name);

/// Colour attachments of a draw: `count` of the same format.
struct DrawTargets {
  VkFormat format = VK_FORMAT_UNDEFINED;
  int count = 1;
};

/// A pipeline that runs `fragment` on every pixel of its targets; viewport and scissor are dynamic. Goes through the
/// device's pipeline cache. Thread-safe.
Result<PipelineHandle> create_draw_pipeline(const Device& device, const DrawLayout& layout, VkShaderModule vertex,
                                            VkShaderModule fragment, DrawTargets targets, const std::string& name);

/// Texels at their centres, or interpolated; clamped to the edge, level 0.
Result<SamplerHandle> create_sampler(const Device& device, VkFilter filter);

}  // namespace afterglow
