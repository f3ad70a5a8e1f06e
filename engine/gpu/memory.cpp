// SPDX-License-Identifier: MIT
#include "gpu/memory.h"

#include <fmt/format.h>

#include <cstdint>

#include "core/large_pages.h"
#include "core/text.h"
#include "gpu/error.h"

namespace afterglow {

namespace {

bool is_visible(const Device& device, std::uint32_t type) {
  return device.memory().memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
}

}  // namespace

std::optional<std::uint32_t> find_memory_type(const VkPhysicalDeviceMemoryProperties& memory, std::uint32_t bits,
                                              HostAccess access) {
  constexpr VkMemoryPropertyFlags kVisible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
  constexpr VkMemoryPropertyFlags kCoherent = VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  constexpr VkMemoryPropertyFlags kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
  constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  struct Wishes {
    VkMemoryPropertyFlags flags[3];
  };
  // Not to be had without more: protected submissions, transient attachments, features of AMD's that nobody turns on.
  constexpr VkMemoryPropertyFlags kOfOthers =
      VK_MEMORY_PROPERTY_PROTECTED_BIT | VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT |
      VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD | VK_MEMORY_PROPERTY_DEVICE_UNCACHED_BIT_AMD;
  // From the best to what will do.
  const Wishes wishes = access == HostAccess::none ? Wishes{{kLocal, 0, 0}}
                        : access == HostAccess::write
                            ? Wishes{{kVisible | kCoherent, kVisible, kVisible}}
                            : Wishes{{kVisible | kCached | kCoherent, kVisible | kCached, kVisible}};
  for (const VkMemoryPropertyFlags wanted : wishes.flags) {
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
      const VkMemoryPropertyFlags flags = memory.memoryTypes[i].propertyFlags;
      if (flags & kOfOthers) continue;
      if ((bits & (1u << i)) && (flags & wanted) == wanted) return i;
    }
  }
  return std::nullopt;
}

namespace {

struct Taken {
  VkDeviceMemory handle = VK_NULL_HANDLE;
  std::uint32_t type = 0;
};

/// Of the best type that has room: when a device's own memory is full, that of the host may do.
Result<Taken> take_memory(const Device& device, const VkMemoryRequirements& needs, HostAccess access,
                          std::string_view what) {
  Error refused{ErrorKind::device, fmt::format("{}: the device has no suitable memory", what)};
  std::uint32_t bits = needs.memoryTypeBits;
  while (const auto type = find_memory_type(device.memory(), bits, access)) {
    const VkMemoryAllocateInfo info{
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs.size, .memoryTypeIndex = *type};
    Taken taken{VK_NULL_HANDLE, *type};
    const VkResult done = device.vk().vkAllocateMemory(device.handle(), &info, nullptr, &taken.handle);
    if (done == VK_SUCCESS) return taken;
    refused = vulkan_error(done, fmt::format("cannot allocate {} for {}", memory_text(needs.size), what));
    if (done != VK_ERROR_OUT_OF_DEVICE_MEMORY) break;
    bits &= ~(1u << *type);
  }
  return refused;
}

}  // namespace

Result<Memory> Memory::allocate(const Device& device, const VkMemoryRequirements& needs, HostAccess access,
                                std::string_view what) {
  if (needs.size > device.max_allocation()) {
    return Error{ErrorKind::device, fmt::format("{}: needs {} in one piece, the device allows {}", what,
                                                memory_text(needs.size), memory_text(device.max_allocation()))};
  }
  AFTERGLOW_TRY(const Taken taken, take_memory(device, needs, access, what));
  const auto [handle, type] = taken;
  Memory out;
  out.device_ = &device;
  out.memory_ = MemoryHandle(device, handle);
  out.size_ = needs.size;
  out.coherent_ = device.memory().memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  if (access != HostAccess::none) {
    void* mapped = nullptr;
    AFTERGLOW_VK(device.vk().vkMapMemory(device.handle(), handle, 0, VK_WHOLE_SIZE, 0, &mapped), what);
    out.mapped_ = static_cast<std::byte*>(mapped);
    if (device.is_cpu()) use_large_pages(out.mapped_, needs.size);
  } else if (device.is_cpu() && is_visible(device, type) && !device.forced().unmapped) {
    void* mapped = nullptr;
    AFTERGLOW_VK(device.vk().vkMapMemory(device.handle(), handle, 0, VK_WHOLE_SIZE, 0, &mapped), what);
    use_large_pages(static_cast<std::byte*>(mapped), needs.size);
    device.vk().vkUnmapMemory(device.handle(), handle);
  }
  return out;
}

Result<void> Memory::flush() const {
  if (coherent_ || !mapped_) return {};
  const VkMappedMemoryRange range{
      .sType = VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE, .memory = memory_.get(), .size = VK_WHOLE_SIZE};
  AFTERGLOW_VK(device_->vk().vkFlushMappedMemoryRanges(device_->handle(), 1, &range),
               "cannot bring memory to the device");
  return {};
}

Result<void> Memory::invalidate() const {
  if (coherent_ || !mapped_) return {};
  const VkMappedMemoryRange range{
      .sType = VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE, .memory = memory_.get(), .size = VK_WHOLE_SIZE};
  AFTERGLOW_VK(device_->vk().vkInvalidateMappedMemoryRanges(device_->handle(), 1, &range),
               "cannot bring memory back from the device");
  return {};
}

Result<Buffer> Buffer::create(const Device& device, VkDeviceSize size, VkBufferUsageFlags usage, HostAccess access,
                              std::string_view name) {
  const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
  VkBuffer handle = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreateBuffer(device.handle(), &info, nullptr, &handle), name);
  Buffer out;
  out.buffer_ = BufferHandle(device, handle);
  out.size_ = size;
  VkMemoryRequirements needs{};
  device.vk().vkGetBufferMemoryRequirements(device.handle(), handle, &needs);
  AFTERGLOW_TRY(out.memory_, Memory::allocate(device, needs, access, name));
  AFTERGLOW_VK(device.vk().vkBindBufferMemory(device.handle(), handle, out.memory_.get(), 0), name);
  device.set_name(VK_OBJECT_TYPE_BUFFER, out.buffer_.number(), std::string(name));
  return out;
}

void record_to_host(const Device& device, VkCommandBuffer commands, VkPipelineStageFlags2 stage,
                    VkAccessFlags2 access) {
  const VkMemoryBarrier2 to_host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                 .srcStageMask = stage,
                                 .srcAccessMask = access,
                                 .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                 .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
  const VkDependencyInfo dependency{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &to_host};
  device.vk().vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace afterglow
