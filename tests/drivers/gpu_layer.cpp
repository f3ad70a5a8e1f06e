// SPDX-License-Identifier: MIT
// VK_LAYER_AFTERGLOW_gpu: makes any Vulkan driver look like a discrete GPU of the least abilities that Vulkan allows,
// so that a machine without one runs the ways of execution that GPUs take.
//
// - Memory of the device cannot be mapped and begins full of NaN. Memory of the host is not coherent: the program
//   writes into a copy, and only vkFlushMappedMemoryRanges and vkInvalidateMappedMemoryRanges carry bytes across.
// - Linear images can neither be drawn to nor be storage images.
// - Limits are the least that the specification allows (4 attachments, 16 samplers, 128 bytes of push constants, …).
// - Timestamps have 36 bits, tick every 38.4 ns, and run over soon after the first one.
//
//   AFTERGLOW_GPU_COHERENT=1   the host's memory is coherent, as a driver must have some; without, a forgotten flush
//   shows AFTERGLOW_GPU_SIDE=N       images and framebuffers have sides of at most N
//
//   AFTERGLOW_GPU_VULKAN=1.1   or 1.2: the device has no newer Vulkan; later functions, features and SPIR-V are refused
//   AFTERGLOW_GPU_QUEUES=compute   its queues only compute
//
// A call that no GPU would stand ends the program with a line that names it. Put the validation layer before this one
// (VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation:VK_LAYER_AFTERGLOW_gpu): it then checks against these limits. One
// device at a time, as the program has it.
#include <vulkan/vulkan.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string_view>

#include "../vulkan_chain.h"

namespace {

#define INSTANCE_CALLS(call)                                                                                        \
  call(GetPhysicalDeviceProperties) call(GetPhysicalDeviceProperties2) call(GetPhysicalDeviceQueueFamilyProperties) \
      call(GetPhysicalDeviceQueueFamilyProperties2) call(GetPhysicalDeviceMemoryProperties)                         \
          call(GetPhysicalDeviceMemoryProperties2) call(GetPhysicalDeviceFormatProperties)                          \
              call(GetPhysicalDeviceFormatProperties2) call(GetPhysicalDeviceImageFormatProperties)                 \
                  call(GetPhysicalDeviceImageFormatProperties2)
#define DEVICE_CALLS(call)                                                                                             \
  call(GetImageMemoryRequirements) call(GetImageMemoryRequirements2) call(GetBufferMemoryRequirements)                 \
      call(GetBufferMemoryRequirements2) call(GetDeviceImageMemoryRequirements)                                        \
          call(GetDeviceBufferMemoryRequirements) call(AllocateMemory) call(FreeMemory) call(MapMemory)                \
              call(UnmapMemory) call(FlushMappedMemoryRanges) call(InvalidateMappedMemoryRanges) call(CreateQueryPool) \
                  call(DestroyQueryPool) call(GetQueryPoolResults) call(CreateShaderModule)

/// The functions below this layer.
struct Next {
  PFN_vkGetInstanceProcAddr instance = nullptr;
  PFN_vkGetDeviceProcAddr device = nullptr;
#define MEMBER(name) PFN_vk##name name = nullptr;
  INSTANCE_CALLS(MEMBER) DEVICE_CALLS(MEMBER)
#undef MEMBER
};
Next next;
VkInstance the_instance = VK_NULL_HANDLE;

[[noreturn]] void refuse(const char* what) {
  std::fprintf(stderr, "imitated GPU: %s\n", what);
  std::abort();
}

// What the device can do.

std::uint32_t largest_side() {
  static const char* text = std::getenv("AFTERGLOW_GPU_SIDE");
  return text && *text ? static_cast<std::uint32_t>(std::atoi(text)) : ~0u;
}

/// Minor version of the Vulkan that the device has.
std::uint32_t minor_version() {
  static const char* text = std::getenv("AFTERGLOW_GPU_VULKAN");
  return text && std::strlen(text) == 3 ? static_cast<std::uint32_t>(text[2] - '0') : 3;
}
bool only_computes() {
  static const char* text = std::getenv("AFTERGLOW_GPU_QUEUES");
  return text && std::string_view(text) == "compute";
}

constexpr int kTimestampBits = 36;
constexpr float kTimestampPeriod = 38.4f;  // nanoseconds

void imitate(VkPhysicalDeviceProperties& properties) {
  properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
  properties.apiVersion = std::min(properties.apiVersion, VK_MAKE_API_VERSION(0, 1, minor_version(), 200));
  std::snprintf(properties.deviceName, sizeof properties.deviceName, "Imitated GPU");
  VkPhysicalDeviceLimits& limits = properties.limits;
  for (auto* side : {&limits.maxImageDimension2D, &limits.maxFramebufferWidth, &limits.maxFramebufferHeight})
    *side = std::min(*side, largest_side());
  limits.maxUniformBufferRange = 16384;
  limits.maxPushConstantsSize = 128;
  limits.maxMemoryAllocationCount = 4096;
  limits.maxBoundDescriptorSets = 4;
  limits.maxPerStageDescriptorSamplers = limits.maxPerStageDescriptorSampledImages = 16;
  limits.maxPerStageDescriptorUniformBuffers = 12;
  limits.maxPerStageDescriptorStorageImages = limits.maxPerStageDescriptorStorageBuffers = 4;
  limits.maxFragmentCombinedOutputResources = 4;
  limits.maxPerStageResources = 128;
  limits.maxComputeWorkGroupInvocations = limits.maxComputeWorkGroupSize[0] = limits.maxComputeWorkGroupSize[1] = 128;
  limits.maxComputeSharedMemorySize = 16384;
  limits.maxColorAttachments = limits.maxFragmentOutputAttachments = 4;
  limits.minMemoryMapAlignment = 64;
  limits.minUniformBufferOffsetAlignment = limits.minStorageBufferOffsetAlignment = 256;
  limits.nonCoherentAtomSize = 256;
  limits.bufferImageGranularity = 65536;
  limits.timestampPeriod = kTimestampPeriod;
}

void imitate(VkQueueFamilyProperties& family) {
  family.timestampValidBits = kTimestampBits;
  if (only_computes()) family.queueFlags &= ~VkQueueFlags{VK_QUEUE_GRAPHICS_BIT};
}

/// Whether images of this kind exist only where the processor made them.
bool needs_optimal(VkImageTiling tiling, VkImageUsageFlags usage) {
  return tiling == VK_IMAGE_TILING_LINEAR &&
         (usage & (VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT)) != 0;
}

/// With AFTERGLOW_GPU_FOUR_CHANNELS=1, images of two channels of floats cannot be drawn to or stored to.
bool lacks(VkFormat format) {
  static const char* text = std::getenv("AFTERGLOW_GPU_FOUR_CHANNELS");
  return text && *text == '1' && (format == VK_FORMAT_R16G16_SFLOAT || format == VK_FORMAT_R32G32_SFLOAT);
}

constexpr VkFormatFeatureFlags kNotLinear = VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT |
                                            VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT |
                                            VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;

// Memory.

bool is_coherent() {
  static const char* text = std::getenv("AFTERGLOW_GPU_COHERENT");
  return text && *text == '1';
}

enum Type : std::uint32_t { kLocal, kWritten, kReadBack, kTypes };
constexpr std::uint32_t kImageTypes = 1u << kLocal;
constexpr std::uint32_t kBufferTypes = 1u << kLocal | 1u << kWritten | 1u << kReadBack;
constexpr VkDeviceSize kImageAlignment = 65536;

void imitate(VkPhysicalDeviceMemoryProperties& memory) {
  const VkDeviceSize size = memory.memoryHeaps[0].size;
  memory = {.memoryTypeCount = kTypes, .memoryTypes = {}, .memoryHeapCount = 2, .memoryHeaps = {}};
  memory.memoryHeaps[0] = {size, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT};
  memory.memoryHeaps[1] = {size, 0};
  memory.memoryTypes[kLocal] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
  memory.memoryTypes[kWritten] = {VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT, 1};
  memory.memoryTypes[kReadBack] = {VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, 1};
  if (!is_coherent()) return;
  for (const Type type : {kWritten, kReadBack})
    memory.memoryTypes[type].propertyFlags |= VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
}

void imitate_image(VkMemoryRequirements& needs) {
  needs.memoryTypeBits = kImageTypes;
  needs.alignment = std::max(needs.alignment, kImageAlignment);
  needs.size = (needs.size + kImageAlignment - 1) / kImageAlignment * kImageAlignment;
}

/// An allocation. `seen` is what the program has mapped, `real` what the device works on.
struct Piece {
  std::uint32_t type = kLocal;
  VkDeviceSize size = 0;
  std::byte* real = nullptr;
  struct Free {
    void operator()(std::byte* bytes) const { std::free(bytes); }
  };
  std::unique_ptr<std::byte, Free> seen;
};
std::mutex pieces_mutex;
std::map<VkDeviceMemory, Piece> pieces;

VKAPI_ATTR VkResult VKAPI_CALL AllocateMemory(VkDevice device, const VkMemoryAllocateInfo* info,
                                              const VkAllocationCallbacks* allocator, VkDeviceMemory* memory) {
  VkMemoryAllocateInfo below = *info;
  below.memoryTypeIndex = 0;
  const std::lock_guard lock(pieces_mutex);
  if (const VkResult result = next.AllocateMemory(device, &below, allocator, memory); result != VK_SUCCESS)
    return result;
  Piece& piece = pieces[*memory];
  piece.type = info->memoryTypeIndex;
  piece.size = info->allocationSize;
  void* bytes = nullptr;
  if (next.MapMemory(device, *memory, 0, VK_WHOLE_SIZE, 0, &bytes) != VK_SUCCESS) refuse("the driver maps no memory");
  std::memset(bytes, 0xff, piece.size);
  piece.real = static_cast<std::byte*>(bytes);
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL FreeMemory(VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks* allocator) {
  {
    const std::lock_guard lock(pieces_mutex);
    pieces.erase(memory);
  }
  next.FreeMemory(device, memory, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL MapMemory(VkDevice, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize,
                                         VkMemoryMapFlags, void** out) {
  const std::lock_guard lock(pieces_mutex);
  Piece& piece = pieces.at(memory);
  if (piece.type == kLocal) refuse("memory of the device is mapped");
  if (is_coherent()) {
    *out = piece.real + offset;
    return VK_SUCCESS;
  }
  const std::size_t size = (piece.size + 63) / 64 * 64;
  if (!piece.seen) piece.seen.reset(static_cast<std::byte*>(std::aligned_alloc(64, size)));
  std::memset(piece.seen.get(), 0xff, size);
  *out = piece.seen.get() + offset;
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL UnmapMemory(VkDevice, VkDeviceMemory memory) {
  const std::lock_guard lock(pieces_mutex);
  pieces.at(memory).seen.reset();
}

template <typename Copy>
VkResult carry(std::uint32_t count, const VkMappedMemoryRange* ranges, Copy copy) {
  if (is_coherent()) return VK_SUCCESS;
  const std::lock_guard lock(pieces_mutex);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Piece& piece = pieces.at(ranges[i].memory);
    if (!piece.seen) refuse("memory is flushed or invalidated that is not mapped");
    const VkDeviceSize from = ranges[i].offset;
    const VkDeviceSize size = ranges[i].size == VK_WHOLE_SIZE ? piece.size - from : ranges[i].size;
    copy(piece.seen.get() + from, piece.real + from, size);
  }
  return VK_SUCCESS;
}
VKAPI_ATTR VkResult VKAPI_CALL FlushMappedMemoryRanges(VkDevice, std::uint32_t count,
                                                       const VkMappedMemoryRange* ranges) {
  return carry(count, ranges,
               [](std::byte* seen, std::byte* real, VkDeviceSize size) { std::memcpy(real, seen, size); });
}
VKAPI_ATTR VkResult VKAPI_CALL InvalidateMappedMemoryRanges(VkDevice, std::uint32_t count,
                                                            const VkMappedMemoryRange* ranges) {
  return carry(count, ranges,
               [](std::byte* seen, std::byte* real, VkDeviceSize size) { std::memcpy(seen, real, size); });
}

VKAPI_ATTR void VKAPI_CALL GetImageMemoryRequirements(VkDevice device, VkImage image, VkMemoryRequirements* needs) {
  next.GetImageMemoryRequirements(device, image, needs);
  imitate_image(*needs);
}
VKAPI_ATTR void VKAPI_CALL GetImageMemoryRequirements2(VkDevice device, const VkImageMemoryRequirementsInfo2* info,
                                                       VkMemoryRequirements2* needs) {
  next.GetImageMemoryRequirements2(device, info, needs);
  imitate_image(needs->memoryRequirements);
}
VKAPI_ATTR void VKAPI_CALL GetDeviceImageMemoryRequirements(VkDevice device,
                                                            const VkDeviceImageMemoryRequirements* info,
                                                            VkMemoryRequirements2* needs) {
  next.GetDeviceImageMemoryRequirements(device, info, needs);
  imitate_image(needs->memoryRequirements);
}
VKAPI_ATTR void VKAPI_CALL GetBufferMemoryRequirements(VkDevice device, VkBuffer buffer, VkMemoryRequirements* needs) {
  next.GetBufferMemoryRequirements(device, buffer, needs);
  needs->memoryTypeBits = kBufferTypes;
}
VKAPI_ATTR void VKAPI_CALL GetBufferMemoryRequirements2(VkDevice device, const VkBufferMemoryRequirementsInfo2* info,
                                                        VkMemoryRequirements2* needs) {
  next.GetBufferMemoryRequirements2(device, info, needs);
  needs->memoryRequirements.memoryTypeBits = kBufferTypes;
}
VKAPI_ATTR void VKAPI_CALL GetDeviceBufferMemoryRequirements(VkDevice device,
                                                             const VkDeviceBufferMemoryRequirements* info,
                                                             VkMemoryRequirements2* needs) {
  next.GetDeviceBufferMemoryRequirements(device, info, needs);
  needs->memoryRequirements.memoryTypeBits = kBufferTypes;
}

// Timestamps.

std::mutex pools_mutex;
std::set<VkQueryPool> timestamp_pools;

VKAPI_ATTR VkResult VKAPI_CALL CreateQueryPool(VkDevice device, const VkQueryPoolCreateInfo* info,
                                               const VkAllocationCallbacks* allocator, VkQueryPool* pool) {
  const VkResult result = next.CreateQueryPool(device, info, allocator, pool);
  const std::lock_guard lock(pools_mutex);
  if (result == VK_SUCCESS && info->queryType == VK_QUERY_TYPE_TIMESTAMP) timestamp_pools.insert(*pool);
  return result;
}
VKAPI_ATTR void VKAPI_CALL DestroyQueryPool(VkDevice device, VkQueryPool pool, const VkAllocationCallbacks* allocator) {
  {
    const std::lock_guard lock(pools_mutex);
    timestamp_pools.erase(pool);
  }
  next.DestroyQueryPool(device, pool, allocator);
}

/// Of nanoseconds, as the drivers that this layer stands on count them.
std::uint64_t imitated_ticks(std::uint64_t nanoseconds) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << kTimestampBits) - 1, kTicksBeforeTheEnd = 1000;
  static const std::uint64_t first = nanoseconds;
  const double since = static_cast<double>(nanoseconds) - static_cast<double>(first);
  const auto ticks = static_cast<std::int64_t>(since / static_cast<double>(kTimestampPeriod));
  return (kMask - kTicksBeforeTheEnd + static_cast<std::uint64_t>(ticks)) & kMask;
}

VKAPI_ATTR VkResult VKAPI_CALL GetQueryPoolResults(VkDevice device, VkQueryPool pool, std::uint32_t first,
                                                   std::uint32_t count, std::size_t size, void* data,
                                                   VkDeviceSize stride, VkQueryResultFlags flags) {
  const VkResult result = next.GetQueryPoolResults(device, pool, first, count, size, data, stride, flags);
  const std::lock_guard lock(pools_mutex);
  if (result != VK_SUCCESS || !timestamp_pools.contains(pool)) return result;
  if (!(flags & VK_QUERY_RESULT_64_BIT)) refuse("timestamps are read by 32 bits");
  for (std::uint32_t i = 0; i < count; ++i) {
    auto* value = reinterpret_cast<std::uint64_t*>(static_cast<std::byte*>(data) + i * stride);
    *value = imitated_ticks(*value);
  }
  return result;
}

// Questions about the device.

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceProperties(VkPhysicalDevice physical, VkPhysicalDeviceProperties* out) {
  next.GetPhysicalDeviceProperties(physical, out);
  imitate(*out);
}
VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceProperties2(VkPhysicalDevice physical, VkPhysicalDeviceProperties2* out) {
  next.GetPhysicalDeviceProperties2(physical, out);
  imitate(out->properties);
}
VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceQueueFamilyProperties(VkPhysicalDevice physical, std::uint32_t* count,
                                                                  VkQueueFamilyProperties* out) {
  next.GetPhysicalDeviceQueueFamilyProperties(physical, count, out);
  for (std::uint32_t i = 0; out && i < *count; ++i) imitate(out[i]);
}
VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceQueueFamilyProperties2(VkPhysicalDevice physical, std::uint32_t* count,
                                                                   VkQueueFamilyProperties2* out) {
  next.GetPhysicalDeviceQueueFamilyProperties2(physical, count, out);
  for (std::uint32_t i = 0; out && i < *count; ++i) imitate(out[i].queueFamilyProperties);
}
VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceMemoryProperties(VkPhysicalDevice physical,
                                                             VkPhysicalDeviceMemoryProperties* out) {
  next.GetPhysicalDeviceMemoryProperties(physical, out);
  imitate(*out);
}
VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceMemoryProperties2(VkPhysicalDevice physical,
                                                              VkPhysicalDeviceMemoryProperties2* out) {
  next.GetPhysicalDeviceMemoryProperties2(physical, out);
  imitate(out->memoryProperties);
}
VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceFormatProperties(VkPhysicalDevice physical, VkFormat format,
                                                             VkFormatProperties* out) {
  next.GetPhysicalDeviceFormatProperties(physical, format, out);
  out->linearTilingFeatures &= ~kNotLinear;
  if (lacks(format)) out->optimalTilingFeatures &= ~kNotLinear;
}
VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceFormatProperties2(VkPhysicalDevice physical, VkFormat format,
                                                              VkFormatProperties2* out) {
  next.GetPhysicalDeviceFormatProperties2(physical, format, out);
  out->formatProperties.linearTilingFeatures &= ~kNotLinear;
  if (lacks(format)) out->formatProperties.optimalTilingFeatures &= ~kNotLinear;
  for (auto* more = static_cast<VkBaseOutStructure*>(out->pNext); more; more = more->pNext)
    if (more->sType == VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_3)
      reinterpret_cast<VkFormatProperties3*>(more)->linearTilingFeatures &= ~VkFormatFeatureFlags2{kNotLinear};
}
void limit_sides(VkImageFormatProperties& out) {
  out.maxExtent.width = std::min(out.maxExtent.width, largest_side());
  out.maxExtent.height = std::min(out.maxExtent.height, largest_side());
}
VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceImageFormatProperties(VkPhysicalDevice physical, VkFormat format,
                                                                      VkImageType type, VkImageTiling tiling,
                                                                      VkImageUsageFlags usage, VkImageCreateFlags flags,
                                                                      VkImageFormatProperties* out) {
  // Linear images are not refused, as NVIDIA's driver does not: that none can be drawn to, their features say alone.
  if (lacks(format) && needs_optimal(VK_IMAGE_TILING_LINEAR, usage)) return VK_ERROR_FORMAT_NOT_SUPPORTED;
  const VkResult result =
      next.GetPhysicalDeviceImageFormatProperties(physical, format, type, tiling, usage, flags, out);
  if (result == VK_SUCCESS) limit_sides(*out);
  return result;
}
VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceImageFormatProperties2(VkPhysicalDevice physical,
                                                                       const VkPhysicalDeviceImageFormatInfo2* info,
                                                                       VkImageFormatProperties2* out) {
  if (lacks(info->format) && needs_optimal(VK_IMAGE_TILING_LINEAR, info->usage)) return VK_ERROR_FORMAT_NOT_SUPPORTED;
  const VkResult result = next.GetPhysicalDeviceImageFormatProperties2(physical, info, out);
  if (result == VK_SUCCESS) limit_sides(out->imageFormatProperties);
  return result;
}

// The layer itself.

/// Functions of later versions than the device has, as far as a program may be tempted.
bool is_too_new(std::string_view name) {
  static const std::set<std::string_view> of_3{"vkCmdBeginRendering",   "vkCmdEndRendering",
                                               "vkCmdPipelineBarrier2", "vkCmdWriteTimestamp2",
                                               "vkQueueSubmit2",        "vkCmdCopyImage2",
                                               "vkCmdCopyBuffer2",      "vkCmdBlitImage2",
                                               "vkCmdSetEvent2",        "vkGetDeviceImageMemoryRequirements"};
  static const std::set<std::string_view> of_2{"vkWaitSemaphores",    "vkSignalSemaphore", "vkGetSemaphoreCounterValue",
                                               "vkCreateRenderPass2", "vkResetQueryPool",  "vkCmdDrawIndirectCount"};
  return (minor_version() < 3 && of_3.contains(name)) || (minor_version() < 2 && of_2.contains(name));
}

/// Ends the program when a device of the older Vulkan would not know what it is given.
void check_age(const VkDeviceCreateInfo& info) {
  for (auto* more = static_cast<const VkBaseInStructure*>(info.pNext); more; more = more->pNext) {
    if (minor_version() < 3 && more->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES)
      refuse("features of Vulkan 1.3 are enabled");
    if (minor_version() < 2 && more->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES)
      refuse("features of Vulkan 1.2 are enabled");
  }
  std::set<std::string_view> enabled(info.ppEnabledExtensionNames,
                                     info.ppEnabledExtensionNames + info.enabledExtensionCount);
  if (minor_version() < 3)
    for (const char* name : {VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME, VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME})
      if (!enabled.contains(name)) refuse("an extension is used that is not enabled");
}

VKAPI_ATTR VkResult VKAPI_CALL CreateShaderModule(VkDevice device, const VkShaderModuleCreateInfo* info,
                                                  const VkAllocationCallbacks* allocator, VkShaderModule* module) {
  constexpr std::uint32_t kNewest[] = {0x10000, 0x10300, 0x10500, 0x10600};  // by Vulkan's minor version
  if (info->pCode[1] > kNewest[std::min(minor_version(), 3u)]) refuse("SPIR-V is newer than the device");
  return next.CreateShaderModule(device, info, allocator, module);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device(VkDevice device, const char* name) {
  if (is_too_new(name)) return nullptr;
  if (chain::is_named(name, "vkGetDeviceProcAddr")) return reinterpret_cast<PFN_vkVoidFunction>(&get_device);
#define OWN(call) \
  if (chain::is_named(name, "vk" #call) && next.call) return reinterpret_cast<PFN_vkVoidFunction>(&call);
  DEVICE_CALLS(OWN)
  return next.device(device, name);
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                               VkInstance* instance) {
  if (!chain::take_link(*info, next.instance)) return VK_ERROR_INITIALIZATION_FAILED;
  const auto create = chain::function_of<PFN_vkCreateInstance>(next.instance, VkInstance{}, "vkCreateInstance");
  const VkResult result = create(info, allocator, instance);
  if (result != VK_SUCCESS) return result;
  the_instance = *instance;
#define LOAD(call) next.call = reinterpret_cast<PFN_vk##call>(next.instance(*instance, "vk" #call));
  INSTANCE_CALLS(LOAD)
#undef LOAD
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkDevice* device) {
  PFN_vkGetInstanceProcAddr below = nullptr;
  if (!chain::take_link(*info, below, next.device)) return VK_ERROR_INITIALIZATION_FAILED;
  check_age(*info);
  const auto create = chain::function_of<PFN_vkCreateDevice>(below, the_instance, "vkCreateDevice");
  const VkResult result = create(physical, info, allocator, device);
  if (result != VK_SUCCESS) return result;
#define LOAD(call) next.call = reinterpret_cast<PFN_vk##call>(next.device(*device, "vk" #call));
  DEVICE_CALLS(LOAD)
#undef LOAD
  return result;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance(VkInstance instance, const char* name) {
  const chain::Entries entries{&create_instance, &create_device, &get_instance, &get_device};
  if (const auto own = chain::entry_named(name, entries)) return own;
  INSTANCE_CALLS(OWN)
#undef OWN
#define OWN(call) \
  if (chain::is_named(name, "vk" #call)) return reinterpret_cast<PFN_vkVoidFunction>(&call);
  DEVICE_CALLS(OWN)
#undef OWN
  return next.instance(instance, name);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* negotiate) {
  return chain::negotiate(negotiate, &get_instance, &get_device);
}
