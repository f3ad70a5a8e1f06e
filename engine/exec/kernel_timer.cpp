// SPDX-License-Identifier: MIT
#include "exec/kernel_timer.h"

#include <fmt/format.h>

#include <array>

#include "gpu/error.h"

namespace afterglow {

Result<VkQueryPool> KernelTimer::queries(std::size_t count) {
  if (count <= size_) return pool_.get();
  const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                   .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                   .queryCount = static_cast<std::uint32_t>(count)};
  VkQueryPool pool = VK_NULL_HANDLE;
  AFTERGLOW_VK(device_->vk().vkCreateQueryPool(device_->handle(), &info, nullptr, &pool), "cannot create a query pool");
  pool_ = QueryPoolHandle(*device_, pool);
  size_ = count;
  ++pools_;
  return pool;
}

Result<std::vector<KernelTime>> KernelTimer::read(const Plan& plan) const {
  std::vector<std::uint64_t> ticks(plan.kernels.size() + 1);
  AFTERGLOW_VK(
      device_->vk().vkGetQueryPoolResults(device_->handle(), pool_.get(), 0, static_cast<std::uint32_t>(ticks.size()),
                                          ticks.size() * sizeof ticks[0], ticks.data(), sizeof ticks[0],
                                          VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
      "cannot read timestamps");
  const double milliseconds_per_tick = static_cast<double>(device_->properties().limits.timestampPeriod) * 1e-6;
  std::vector<KernelTime> times;
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    times.push_back({plan.kernels[i].name, static_cast<double>((ticks[i + 1] - ticks[i]) & device_->timestamp_mask()) *
                                               milliseconds_per_tick});
  }
  return times;
}

Result<double> KernelTimer::between() const {
  std::array<std::uint64_t, 2> ticks{};
  AFTERGLOW_VK(device_->vk().vkGetQueryPoolResults(device_->handle(), pool_.get(), 0, 2, sizeof ticks, ticks.data(),
                                                   sizeof ticks[0], VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
               "cannot read timestamps");
  return static_cast<double>((ticks[1] - ticks[0]) & device_->timestamp_mask()) *
         static_cast<double>(device_->properties().limits.timestampPeriod) * 1e-6;
}

Error KernelTimer::blame(Error error, const Plan& plan) {
  if (plan.kernels.empty()) return error;
  error.message +=
      fmt::format(" while running {} kernel(s), the last of them '{}'", plan.kernels.size(), plan.kernels.back().name);
  error.trail.emplace_back("times per pass (--stats=passes) run each kernel alone and name the one that fails");
  return error;
}

}  // namespace afterglow
