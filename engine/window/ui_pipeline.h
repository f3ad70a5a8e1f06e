// SPDX-License-Identifier: MIT
// The pipeline that draws the interface's triangles.
#pragma once

#include <array>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace afterglow {

/// As ui.vert declares it.
struct UiPush {
  std::array<float, 2> scale{}, shift{};
};

/// For one format of target: where its stores encode as sRGB, the shaders hand over linear values. Vertices are
/// ImDrawVert, colours blend over the target; viewport and scissor are dynamic. Set 0, binding 0: the atlas.
struct UiPipeline {
  SetLayoutHandle set;
  PipelineLayoutHandle layout;
  PipelineHandle pipeline;
  SamplerHandle sampler;  ///< linear, clamped

  /// Errors: device.
  static Result<UiPipeline> create(const Device& device, VkFormat target);
};

}  // namespace afterglow
