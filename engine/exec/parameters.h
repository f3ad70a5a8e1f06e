// SPDX-License-Identifier: MIT
// The uniform buffer of a program: one block for each kernel, filled by name from the passes' parameters.
#pragma once

#include <string_view>
#include <vector>

#include "exec/describe.h"
#include "gpu/memory.h"

namespace afterglow {

/// Where the values of one kernel's block come from.
struct KernelBlock {
  PlanKernel kernel;
  const CompiledKernel* compiled = nullptr;
  VkDeviceSize offset = 0;  ///< in the buffer; meaningless when the block is empty
};

class ParameterBuffer {
 public:
  /// `compiled` is parallel to the plan's kernels and must outlive the buffer. Errors: script (a parameter that is not
  /// given), device.
  static Result<ParameterBuffer> create(const Device& device, const Graph& graph, const Plan& plan,
                                        const std::vector<const CompiledKernel*>& compiled);
  ParameterBuffer() = default;

  /// Writes the values of `graph`, which has the structure of the one given to `create`. Touches bytes alone. Errors:
  /// device.
  Result<void> write(const Graph& graph);
  /// The block of a kernel as the buffer holds it.
  std::string_view bytes(std::size_t kernel) const;

  VkBuffer buffer() const { return buffer_.get(); }  ///< null when no kernel has parameters
  VkDeviceSize offset(std::size_t kernel) const { return blocks_[kernel].offset; }

 private:
  std::vector<KernelBlock> blocks_;
  std::vector<std::byte> values_;  ///< what the buffer holds: device memory is slow to read
  Buffer buffer_;
};

}  // namespace afterglow
