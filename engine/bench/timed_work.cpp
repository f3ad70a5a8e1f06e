#include "bench/timed_work.h"

#include <chrono>
#include <limits>

#include "gpu/error.h"

namespace afterglow::bench {

Result<TimedWork> TimedWork::create(const Device& device, const std::function<void(VkCommandBuffer)>& record) {
  TimedWork out;
  out.device_ = &device;
  const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .queueFamilyIndex = device.queue_family()};
  VkCommandPool pool = VK_NULL_HANDLE;
  AFTERGLOW_VK(vkCreateCommandPool(device.handle(), &pool_info, nullptr, &pool), "cannot create a command pool");
  out.pool_ = CommandPoolHandle(device.handle(), pool);
  const VkCommandBufferAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                             .commandPool = pool,
                                             .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                             .commandBufferCount = 1};
  AFTERGLOW_VK(vkAllocateCommandBuffers(device.handle(), &allocate, &out.commands_),
               "cannot allocate a command buffer");
  const VkFenceCreateInfo fence_info{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence fence = VK_NULL_HANDLE;
  AFTERGLOW_VK(vkCreateFence(device.handle(), &fence_info, nullptr, &fence), "cannot create a fence");
  out.fence_ = FenceHandle(device.handle(), fence);

  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  AFTERGLOW_VK(vkBeginCommandBuffer(out.commands_, &begin), "cannot record commands");
  record(out.commands_);
  AFTERGLOW_VK(vkEndCommandBuffer(out.commands_), "cannot record commands");
  return out;
}

Result<double> TimedWork::run() {
  const VkFence fence = fence_.get();
  const VkCommandBufferSubmitInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                         .commandBuffer = commands_};
  const VkSubmitInfo2 info{
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &buffer};
  const auto start = std::chrono::steady_clock::now();
  AFTERGLOW_VK(vkQueueSubmit2(device_->queue(), 1, &info, fence), "cannot submit");
  AFTERGLOW_VK(vkWaitForFences(device_->handle(), 1, &fence, VK_TRUE, std::numeric_limits<std::uint64_t>::max()),
               "the device did not finish");
  const double time = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  AFTERGLOW_VK(vkResetFences(device_->handle(), 1, &fence), "cannot reset a fence");
  return time;
}

Result<std::vector<Spread>> run_in_turns(const std::vector<Measured>& all, int repeat,
                                         const std::function<Result<void>(int round)>& step) {
  std::vector<std::vector<double>> samples(all.size());
  for (int round = 0; round <= repeat; ++round) {
    AFTERGLOW_CHECK(step(round));
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::size_t at = (i + static_cast<std::size_t>(round)) % all.size();
      AFTERGLOW_TRY(const double time, all[at]());
      if (round > 0) samples[at].push_back(time);
    }
  }
  std::vector<Spread> out;
  for (auto& one : samples) out.push_back(Spread::of(std::move(one)));
  return out;
}

}  // namespace afterglow::bench
