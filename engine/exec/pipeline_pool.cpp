// SPDX-License-Identifier: MIT
#include "exec/pipeline_pool.h"

namespace afterglow {

Result<std::shared_ptr<const DrawLayout>> PipelinePool::layout(const Device& device, const DrawInterface& interface) {
  const std::lock_guard lock(mutex_);
  auto& known = layouts_[interface];
  if (!known) {
    auto made = create_draw_layout(device, interface);
    if (!made) {
      layouts_.erase(interface);
      return std::move(made).error();
    }
    known = std::make_shared<const DrawLayout>(std::move(made).value());
  }
  return known;
}

std::shared_ptr<const SharedPipeline> PipelinePool::find(const CompiledKernel& kernel, VkFormat format) {
  const std::lock_guard lock(mutex_);
  const auto known = pipelines_.find({kernel.hash, format, kernel.rows});
  return known == pipelines_.end() ? nullptr : known->second.lock();
}

std::shared_ptr<const SharedPipeline> PipelinePool::add(const CompiledKernel& kernel, VkFormat format,
                                                        SharedPipeline made) {
  const std::lock_guard lock(mutex_);
  auto& known = pipelines_[{kernel.hash, format, kernel.rows}];
  if (auto quicker = known.lock()) return quicker;
  auto shared = std::make_shared<const SharedPipeline>(std::move(made));
  known = shared;
  ++made_;
  std::erase_if(pipelines_, [](const auto& entry) { return entry.second.expired(); });
  return shared;
}

PipelinePool::Counters PipelinePool::counters() const {
  const std::lock_guard lock(mutex_);
  Counters counters{.made = made_, .alive = 0, .milliseconds = milliseconds_};
  for (const auto& [key, pipeline] : pipelines_) counters.alive += pipeline.expired() ? 0 : 1;
  return counters;
}

void PipelinePool::add_time(double milliseconds) {
  const std::lock_guard lock(mutex_);
  milliseconds_ += milliseconds;
}

}  // namespace afterglow
