// SPDX-License-Identifier: MIT
// The pipelines of a program's distinct kernels.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "exec/pipeline_pool.h"
#include "gpu/pipeline.h"
#include "shader/kernel.h"

namespace afterglow {

/// What the image slots of a kernel are bound as, in order, with the target that a compute kernel stores to.
std::vector<VkDescriptorType> descriptor_types(const CompiledKernel& kernel);

class KernelPipelines {
 public:
  /// Made over threads through the device's pipeline cache. `names` is parallel to `kernels`, for messages and
  /// debuggers. `format`: of the targets, in place of what the kernels are made for. `pool`: those that it has are
  /// taken from it, the others added; null: nothing is shared. Errors: device.
  static Result<KernelPipelines> create(const Device& device, const std::vector<CompiledKernel>& kernels,
                                        const std::vector<std::string>& names, VkFormat format = VK_FORMAT_UNDEFINED,
                                        PipelinePool* pool = nullptr);
  KernelPipelines() = default;

  VkPipeline pipeline(int kernel) const { return pipelines_[static_cast<std::size_t>(kernel)]->pipeline.get(); }
  /// The second draw of a kernel that has one, else null.
  VkPipeline rest(int kernel) const { return pipelines_[static_cast<std::size_t>(kernel)]->rest.get(); }
  const DrawLayout& layout(const CompiledKernel& kernel) const;
  int size() const { return static_cast<int>(pipelines_.size()); }

 private:
  std::map<DrawInterface, std::shared_ptr<const DrawLayout>> layouts_;  // kernels that read alike share one
  std::vector<std::shared_ptr<const SharedPipeline>> pipelines_;
};

}  // namespace afterglow
