// SPDX-License-Identifier: MIT
// The copy of a picture by a compute shader, for comparison with a full-screen draw.
#pragma once

#include "exec/program.h"
#include "exec/timing/timed_work.h"
#include "gpu/image.h"

namespace afterglow {

class ComputeCopy {
 public:
  /// `source` is RGBA32F and in GENERAL. Errors: device.
  static Result<ComputeCopy> create(const Device& device, const ImageBinding& source);
  ComputeCopy() = default;
  TimedWork& work() { return work_; }

 private:
  GpuImage target_;
  SamplerHandle sampler_;
  SetLayoutHandle set_layout_;
  PipelineLayoutHandle layout_;
  PipelineHandle pipeline_;
  DescriptorPoolHandle pool_;
  TimedWork work_;
};

}  // namespace afterglow
