// SPDX-License-Identifier: MIT
// Full-screen draws and dispatches: descriptor layouts, pipeline layouts and pipelines.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "gpu/device.h"
#include "gpu/handle.h"

namespace afterglow {

/// What a full-screen fragment shader, or a compute shader, reads and stores to. Set 0: binding 0 a uniform block (when
/// `block`), bindings 1… its images, as combined image samplers or storage images; `push_bytes` of push constants.
struct DrawInterface {
  bool block = false;
  std::vector<VkDescriptorType> images;
  std::uint32_t push_bytes = 0;
  bool compute = false;
  VkShaderStageFlagBits stage() const { return compute ? VK_SHADER_STAGE_COMPUTE_BIT : VK_SHADER_STAGE_FRAGMENT_BIT; }
  friend auto operator<=>(const DrawInterface&, const DrawInterface&) = default;
};

struct DrawLayout {
  SetLayoutHandle set;
  PipelineLayoutHandle pipeline;
};

/// Errors: device (more images than a shader may read).
Result<DrawLayout> create_draw_layout(const Device& device, const DrawInterface& interface);

Result<ShaderModuleHandle> create_shader_module(const Device& device, std::span<const std::uint32_t> spirv,
                                                const std::string& name);

/// Colour attachments of a draw: `count` of the same format.
struct DrawTargets {
  VkFormat format = VK_FORMAT_UNDEFINED;
  int count = 1;
};

/// One of two draws into the same target, with a depth image of kDepthFormat that is cleared to 1: the first one marks
/// the pixels that it makes, the second one makes those that are not marked. `value` is that of the fragment shader's
/// specialisation constant 0 (int).
struct DrawTurn {
  bool marks = false;
  std::int32_t value = 0;
};

/// A pipeline that runs `fragment` on every pixel of its targets; viewport and scissor are dynamic. Goes through the
/// device's pipeline cache. Thread-safe.
Result<PipelineHandle> create_draw_pipeline(const Device& device, const DrawLayout& layout, VkShaderModule vertex,
                                            VkShaderModule fragment, DrawTargets targets, const std::string& name,
                                            std::optional<DrawTurn> turn = {});

/// Errors (device): workgroups of this size, or with so many bytes to share, are more than the device has.
Result<void> check_workgroup(const Device& device, Size invocations, std::uint64_t shared_bytes,
                             const std::string& name);

/// A pipeline for vkCmdDispatchBase; the layout must be that of a compute shader. Goes through the device's pipeline
/// cache. Thread-safe.
Result<PipelineHandle> create_compute_pipeline(const Device& device, const DrawLayout& layout, VkShaderModule module,
                                               const std::string& name);

/// Texels at their centres, or interpolated; clamped to the edge, level 0.
Result<SamplerHandle> create_sampler(const Device& device, VkFilter filter);

}  // namespace afterglow
