// The pipelines of a program's distinct kernels.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gpu/pipeline.h"
#include "shader/kernel.h"

namespace afterglow {

/// What the image slots of a kernel are bound as, in order.
std::vector<VkDescriptorType> descriptor_types(const CompiledKernel& kernel);

class KernelPipelines {
 public:
  /// Made over threads through the device's pipeline cache. `names` is parallel to `kernels`, for messages and
  /// debuggers. `format`: of the targets, in place of what the kernels are made for. Errors: device.
  static Result<KernelPipelines> create(const Device& device, const std::vector<CompiledKernel>& kernels,
                                        const std::vector<std::string>& names, VkFormat format = VK_FORMAT_UNDEFINED);
  KernelPipelines() = default;

  VkPipeline pipeline(int kernel) const { return pipelines_[static_cast<std::size_t>(kernel)].get(); }
  const DrawLayout& layout(const CompiledKernel& kernel) const;
  int size() const { return static_cast<int>(pipelines_.size()); }

 private:
  std::map<DrawInterface, DrawLayout> layouts_;  // kernels that read alike share one
  std::vector<PipelineHandle> pipelines_;
};

}  // namespace afterglow
