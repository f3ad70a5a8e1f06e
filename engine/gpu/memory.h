// SPDX-License-Identifier: MIT
// Device memory and buffers.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace afterglow {

/// What the CPU does with a piece of memory.
enum class HostAccess { none, write, read };

/// The memory type of `bits` that suits best: `none` prefers device-local, `write` wants host-visible (coherent
/// preferred), `read` wants host-visible (cached preferred). None when no type will do. Pure.
std::optional<std::uint32_t> find_memory_type(const VkPhysicalDeviceMemoryProperties& memory, std::uint32_t bits,
                                              HostAccess access);

/// One VkDeviceMemory; mapped for its whole life unless its access is `none`.
class Memory {
 public:
  /// Errors: device; `what` names it in the message.
  static Result<Memory> allocate(const Device& device, const VkMemoryRequirements& needs, HostAccess access,
                                 std::string_view what);
  Memory() = default;

  VkDeviceMemory get() const { return memory_.get(); }
  VkDeviceSize size() const { return size_; }
  std::byte* data() const { return mapped_; }
  /// Makes CPU writes visible to the device before a submission; device writes visible to the CPU after a wait.
  /// Nothing on coherent memory. Errors: device.
  Result<void> flush() const;
  Result<void> invalidate() const;

 private:
  const Device* device_ = nullptr;
  MemoryHandle memory_;
  VkDeviceSize size_ = 0;
  std::byte* mapped_ = nullptr;
  bool coherent_ = true;
};

/// A buffer with memory of its own.
class Buffer {
 public:
  static Result<Buffer> create(const Device& device, VkDeviceSize size, VkBufferUsageFlags usage, HostAccess access,
                               std::string_view name);
  Buffer() = default;

  VkBuffer get() const { return buffer_.get(); }
  VkDeviceSize size() const { return size_; }
  const Memory& memory() const { return memory_; }
  std::byte* data() const { return memory_.data(); }

 private:
  Memory memory_;  // before the buffer: freed after it
  BufferHandle buffer_;
  VkDeviceSize size_ = 0;
};

/// Records that what was written in this stage is for the CPU to read, once its submission is over.
void record_to_host(const Device& device, VkCommandBuffer commands, VkPipelineStageFlags2 stage, VkAccessFlags2 access);

}  // namespace afterglow
