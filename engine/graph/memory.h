// SPDX-License-Identifier: MIT
// What the images of a graph cost a device, before anything is made: the memory that they take, and the bytes that
// kernels move. A model, without a device: each kernel reads every image that it binds once, as caches of devices make
// neighbouring reads one, and writes its image once.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "graph/region.h"
#include "shader/execution_config.h"

namespace afterglow {

/// Bytes, with the inputs and the result. Of `config` it reads `fusion`, `storage`, `four_channels` and `share_memory`.
std::uint64_t memory_needed(const Graph& graph, const ExecutionConfig& config);

/// Of a steady frame: kernels that run once move nothing.
struct KernelTraffic {
  std::string name;
  std::uint64_t read = 0, written = 0;
};

struct Traffic {
  std::vector<KernelTraffic> kernels;  ///< parallel to Plan::kernels
  std::uint64_t total = 0;
  std::uint64_t small = 0;  ///< of `total`: images of less than half of the result's pixels, as pyramids have them
  /// What cannot be spared: source and auxiliary images read once, the result written once, in the same formats.
  std::uint64_t unavoidable = 0;

  /// What moves at full size, in units of what cannot be spared; 0: nothing runs.
  double excess() const {
    return unavoidable > 0 ? static_cast<double>(total - small) / static_cast<double>(unavoidable) : 0;
  }
  /// At so many bytes a second.
  double milliseconds(double bandwidth) const { return static_cast<double>(total) / bandwidth * 1e3; }
};

/// Of `config` it reads `storage` and `four_channels`. `parts`: what is drawn and read, when that is not all
/// (regions()); else null.
Traffic traffic_of(const Graph& graph, const Plan& plan, const ExecutionConfig& config, const Regions* parts = nullptr);

}  // namespace afterglow
