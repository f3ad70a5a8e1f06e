// SPDX-License-Identifier: MIT
#include "exec/loop_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace afterglow {

Result<LoopWatch> LoopWatch::create(const Device& device, const Plan& plan,
                                    const std::vector<const CompiledKernel*>& compiled) {
  const VkDeviceSize apart =
      std::max<VkDeviceSize>(device.properties().limits.minStorageBufferOffsetAlignment, sizeof(std::uint32_t));
  LoopWatch out;
  VkDeviceSize size = 0;
  for (std::size_t i = 0; i < compiled.size(); ++i) {
    out.kernels_.push_back({size, plan.kernels[i].name, compiled[i]->loops});
    if (!compiled[i]->loops.empty()) size += apart;
  }
  if (size == 0) return out;
  AFTERGLOW_TRY(out.buffer_,
                Buffer::create(device, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, HostAccess::read, "loops"));
  std::memset(out.buffer_.data(), 0, size);
  AFTERGLOW_CHECK(out.buffer_.memory().flush());
  return out;
}

std::optional<VkDescriptorBufferInfo> LoopWatch::word(std::size_t kernel) const {
  if (kernels_[kernel].loops.empty()) return std::nullopt;
  return VkDescriptorBufferInfo{buffer_.get(), kernels_[kernel].offset, sizeof(std::uint32_t)};
}

void LoopWatch::record(const Device& device, VkCommandBuffer commands) const {
  if (buffer_.size() == 0) return;
  record_to_host(device, commands, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                 VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
}

Result<void> LoopWatch::look() {
  if (buffer_.size() == 0) return {};
  AFTERGLOW_CHECK(buffer_.memory().invalidate());
  bool any = false;
  for (std::size_t i = kernels_.size(); i-- > 0;) {
    if (kernels_[i].loops.empty()) continue;
    std::uint32_t word = 0;
    std::memcpy(&word, buffer_.data() + kernels_[i].offset, sizeof word);
    if (word == 0) continue;
    any = true;  // of several the first: the others may have read what it left
    last_ = i;
    told_ = word;
  }
  if (!any) return {};
  ++runaways_;
  std::memset(buffer_.data(), 0, buffer_.size());
  AFTERGLOW_CHECK(buffer_.memory().flush());
  return {};
}

Error LoopWatch::error() const {
  const Watched& kernel = kernels_[last_];
  Error error{ErrorKind::script,
              fmt::format("a loop did not end within {} turns of one pixel, in '{}'", kMaxLoopTurns, kernel.kernel)};
  if (told_ >= 1 && told_ <= kernel.loops.size() && !kernel.loops[told_ - 1].file.empty()) {
    error.file = kernel.loops[told_ - 1].file;
    error.line = kernel.loops[told_ - 1].line;
  }
  error.allowed = fmt::format("at most {} turns of all loops of a pass", kMaxLoopTurns);
  return error;
}

}  // namespace afterglow
