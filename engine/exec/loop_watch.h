// SPDX-License-Identifier: MIT
// What the guarded loops of a program's kernels tell, see CompiledKernel::loops: a word for each kernel, in one buffer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu/memory.h"
#include "graph/plan.h"
#include "shader/kernel.h"

namespace afterglow {

class LoopWatch {
 public:
  /// `compiled` is parallel to the plan's kernels. Errors: device.
  static Result<LoopWatch> create(const Device& device, const Plan& plan,
                                  const std::vector<const CompiledKernel*>& compiled);
  LoopWatch() = default;

  /// To bind; nothing for a kernel without guarded loops.
  std::optional<VkDescriptorBufferInfo> word(std::size_t kernel) const;
  /// Makes what kernels wrote known to the CPU: behind the last of them.
  void record(const Device& device, VkCommandBuffer commands) const;
  /// Notes a loop that has run away since it was called last, and lets all loops turn again. To be called when a run is
  /// over. Errors: device.
  Result<void> look();
  std::uint64_t runaways() const { return runaways_; }
  /// About the loop that ran away last: script.
  Error error() const;

 private:
  struct Watched {
    VkDeviceSize offset = 0;
    std::string kernel;
    std::vector<CompiledKernel::LoopPlace> loops;  ///< empty: not guarded
  };
  std::vector<Watched> kernels_;
  std::size_t last_ = 0;  ///< the kernel whose loop ran away last, and the word that it wrote
  std::uint32_t told_ = 0;
  std::uint64_t runaways_ = 0;
  Buffer buffer_;
};

}  // namespace afterglow
