// SPDX-License-Identifier: MIT
// Pipelines that programs of one device share: those of kernels with the same text are made once.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>

#include "gpu/pipeline.h"
#include "shader/kernel.h"

namespace afterglow {

/// A pipeline and the layout that it was made with.
struct SharedPipeline {
  std::shared_ptr<const DrawLayout> layout;
  PipelineHandle pipeline;
  PipelineHandle rest;  ///< of a kernel with two draws: the second
};

/// Keeps no pipeline alive: it goes with the last program that uses it. Layouts, which are few, stay. Thread-safe. Must
/// outlive none of its users; the device must outlive it.
class PipelinePool {
 public:
  /// Errors: device.
  Result<std::shared_ptr<const DrawLayout>> layout(const Device& device, const DrawInterface& interface);
  /// Null when no program has it.
  std::shared_ptr<const SharedPipeline> find(const CompiledKernel& kernel, VkFormat format);
  /// The pipeline from now on; the one that another thread was quicker to add, if one was.
  std::shared_ptr<const SharedPipeline> add(const CompiledKernel& kernel, VkFormat format, SharedPipeline made);

  struct Counters {
    std::uint64_t made = 0, alive = 0;
    double milliseconds = 0;  ///< that makers waited for pipelines
  };
  Counters counters() const;
  void add_time(double milliseconds);

 private:
  using Key = std::tuple<Hash, VkFormat, int>;
  mutable std::mutex mutex_;
  std::map<DrawInterface, std::shared_ptr<const DrawLayout>> layouts_;
  std::map<Key, std::weak_ptr<const SharedPipeline>> pipelines_;
  std::uint64_t made_ = 0;
  double milliseconds_ = 0;
};

}  // namespace afterglow
