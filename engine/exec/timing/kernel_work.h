// SPDX-License-Identifier: MIT
// One kernel alone on one picture: what floors and calibration measure.
#pragma once

#include "exec/descriptors.h"
#include "exec/kernel_pipelines.h"
#include "exec/timing/device_picture.h"
#include "exec/timing/timed_work.h"
#include "gpu/memory.h"
#include "shader/kernel.h"

namespace afterglow {

/// A full-size draw of a kernel that reads the source alone. The picture must outlive it.
class KernelWork {
 public:
  /// Errors: script (a filter that is no filter), device.
  static Result<KernelWork> create(const Device& device, KernelCompiler& compiler, const KernelDesc& kernel,
                                   const ImageBinding& source, const ImageBinding& target, const std::string& name);
  KernelWork() = default;
  TimedWork& work() { return work_; }

 private:
  CompiledKernel compiled_;
  KernelPipelines pipelines_;
  SamplerHandle sampler_;
  Descriptors descriptors_;
  TimedWork work_;
};

/// A copy of `bytes` from one buffer to another by the device: what its memory allows.
class BufferCopy {
 public:
  static Result<BufferCopy> create(const Device& device, VkDeviceSize bytes);
  BufferCopy() = default;
  TimedWork& work() { return work_; }

 private:
  Buffer from_, to_;
  TimedWork work_;
};

}  // namespace afterglow
