// SPDX-License-Identifier: MIT
// From graph to plan: passes nobody reads are dropped, neighbouring passes are fused into kernels, transient images
// get places in shared memory. Plain data; no Vulkan.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "graph/graph.h"
#include "shader/execution_config.h"

namespace afterglow {

/// One draw or dispatch: an anchor pass and the pixel passes fused to it. Indices into Graph::passes: a pass that
/// begins kernels first, then pixel passes, each behind those whose colours it takes. The last one makes the kernel's
/// image; what the others make is read by passes of the kernel alone, at their own pixel.
struct PlanKernel {
  std::vector<int> passes;
  std::string name;  ///< "glow.up[0]+glow.combine+curve"
  ImageId output = kNoImage;
  bool workgroups = false;  ///< its anchor is a shader of workgroups
  bool dispatched = false;  ///< it is a compute shader, which stores into the image; else it is drawn
};

struct Plan {
  std::vector<PlanKernel> kernels;  ///< in order of execution
  std::vector<Skipped> skipped;     ///< passes dropped here
  std::vector<ImageId>
      transient;  ///< images that need memory, in order of first use (result included when it is not an input)
  struct Lifetime {
    int first = 0, last = 0;
  };  ///< kernel indices, inclusive
  /// Parallel to `transient`; the result and what histories keep live to the end, what is made once from end to end.
  std::vector<Lifetime> lifetimes;
  /// Parallel to `kernels`: what they make depends on settings and sizes alone, on no picture of a frame. It shares
  /// memory with nothing, and is made again only when its settings change.
  std::vector<bool> once;
};

/// Of `config` it reads `fusion`, `compute`, `dispatched`, `rows` and `storage`. Shaders of workgroups make neither the
/// result nor what histories keep; other kernels are dispatched for all but a result that may not be stored to
/// (`stores_result`).
Plan make_plan(const Graph& graph, const ExecutionConfig& config, bool stores_result = false);

/// Is input `input` of a pass read at the target's own pixel alone: the colour of a pixel pass, a pixel-wise input?
bool reads_own_pixel(const Pass& pass, const PassInput& input);

/// Where the kernel has an image's colour at hand when one of its passes wants it, as a number: 0 for the colour that
/// the anchor makes or reads, n for what the n-th pixel pass makes (the first stage, KernelStage, is 1). Nothing: it
/// has to be read.
std::optional<int> value_in(const Graph& graph, const PlanKernel& kernel, ImageId image);

/// A block of memory wanted from kernel `first` to kernel `last` (inclusive).
struct Block {
  std::uint64_t size = 0, alignment = 1;
  int first = 0, last = 0;
};
struct Placement {
  std::vector<std::uint64_t> offsets;  ///< parallel to the blocks
  std::uint64_t total = 0;             ///< bytes of the arena: the peak
  std::uint64_t sum = 0;               ///< bytes without sharing
  std::uint64_t lower_bound = 0;       ///< largest sum of sizes alive at once
};
/// Greedy by size; blocks whose lifetimes overlap never share bytes.
Placement place(const std::vector<Block>& blocks, bool share);

}  // namespace afterglow
