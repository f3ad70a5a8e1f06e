// SPDX-License-Identifier: MIT
#include "exec/submit.h"

#include "gpu/error.h"
#include "gpu/fence.h"

namespace afterglow {

Result<Submitter> Submitter::create(const Device& device) {
  Submitter out;
  out.device_ = &device;
  const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = device.queue_family()};
  VkCommandPool pool = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreateCommandPool(device.handle(), &pool_info, nullptr, &pool),
               "cannot create a command pool");
  out.pool_ = CommandPoolHandle(device, pool);
  const VkCommandBufferAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                             .commandPool = pool,
                                             .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                             .commandBufferCount = kBuffers};
  AFTERGLOW_VK(device.vk().vkAllocateCommandBuffers(device.handle(), &allocate, out.commands_.data()),
               "cannot allocate a command buffer");
  const VkFenceCreateInfo fence_info{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence fence = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreateFence(device.handle(), &fence_info, nullptr, &fence), "cannot create a fence");
  out.fence_ = FenceHandle(device, fence);
  return out;
}

Submitter& Submitter::operator=(Submitter&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(pool_, other.pool_);
  std::swap(fence_, other.fence_);
  std::swap(commands_, other.commands_);
  std::swap(pending_, other.pending_);
  std::swap(recordings_, other.recordings_);
  return *this;
}

Result<void> Submitter::submit(const std::function<void(VkCommandBuffer)>& record, int which) {
  AFTERGLOW_CHECK(this->record(record, which));
  return submit_again(which);
}

Result<void> Submitter::record(const std::function<void(VkCommandBuffer)>& record, int which) {
  VkCommandBuffer commands = commands_[static_cast<std::size_t>(which)];
  AFTERGLOW_CHECK(wait());
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  AFTERGLOW_VK(device_->vk().vkBeginCommandBuffer(commands, &begin), "cannot record commands");
  try {
    record(commands);
  } catch (...) {
    device_->vk().vkEndCommandBuffer(commands);  // one that is being recorded may not begin again
    throw;
  }
  AFTERGLOW_VK(device_->vk().vkEndCommandBuffer(commands), "cannot record commands");
  ++recordings_;
  return {};
}

Result<void> Submitter::submit_again(int which) {
  AFTERGLOW_CHECK(wait());
  const VkCommandBufferSubmitInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                         .commandBuffer = commands_[static_cast<std::size_t>(which)]};
  const VkSubmitInfo2 info{
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &buffer};
  // Here, not behind the wait: a submission with a fence that could not be reset would seem to be over at once.
  const VkFence fence = fence_.get();
  AFTERGLOW_VK(device_->vk().vkResetFences(device_->handle(), 1, &fence), "cannot reset a fence");
  const auto lock = device_->lock_queue();
  AFTERGLOW_VK(device_->vk().vkQueueSubmit2(device_->queue(), 1, &info, fence), "cannot submit");
  pending_ = true;
  return {};
}

Result<void> Submitter::wait() {
  if (!pending_) return {};
  pending_ = false;
  AFTERGLOW_VK(wait_for_fence(*device_, fence_.get()), "the device did not finish");
  return {};
}

}  // namespace afterglow
