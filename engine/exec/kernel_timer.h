// SPDX-License-Identifier: MIT
// Timestamps around kernels, and what they tell when the device is lost.
#pragma once

#include <vector>

#include "exec/frame.h"
#include "gpu/handle.h"

namespace afterglow {

class KernelTimer {
 public:
  explicit KernelTimer(const Device& device) : device_(&device) {}

  /// A pool for at least `count` timestamps, kept until more are wanted. Errors: device.
  Result<VkQueryPool> queries(std::size_t count);
  /// Times of the plan's kernels in the run that is done. Errors: device.
  Result<std::vector<KernelTime>> read(const Plan& plan) const;
  /// Milliseconds between the first two timestamps. Errors: device.
  Result<double> between() const;
  /// Names the kernels that a failed run was about.
  static Error blame(Error error, const Plan& plan);
  int pools() const { return pools_; }

 private:
  const Device* device_;
  QueryPoolHandle pool_;
  std::size_t size_ = 0;
  int pools_ = 0;
};

}  // namespace afterglow
