// SPDX-License-Identifier: MIT
// Full-screen draws and dispatches: descriptor layouts, pipeline layouts and pipelines.
#pragma once

#include <cstdint>
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
  bool vertex = false;  ///< its vertex shader may read the block and the push constants too
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

/// Two draws into the same targets share a depth image of kDepthFormat: the first one's shader writes gl_FragDepth, 0
/// where it is done and else 1, and the second one makes the pixels that are not done.
enum class DrawMarks { none, writes, tests };

/// Colour attachments of a draw: `count` of the same format.
struct DrawTargets {
  VkFormat format = VK_FORMAT_UNDEFINED;
  int count = 1;
  DrawMarks marks = DrawMarks::none;
};

/// A pipeline that runs `fragment` on every pixel of its targets; viewport and scissor are dynamic. Goes through the
/// device's pipeline cache. `constants`: values of the fragment shader's specialisation constants 0, 1, … Thread-safe.
Result<PipelineHandle> create_draw_pipeline(const Device& device, const DrawLayout& layout, VkShaderModule vertex,
                                            VkShaderModule fragment, DrawTargets targets, const std::string& name,
                                            std::span<const std::int32_t> constants = {});

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
