// SPDX-License-Identifier: MIT
// VK_LAYER_AFTERGLOW_fault: between the program and the driver, lets one Vulkan call fail that may.
//
//   AFTERGLOW_FAULT_CALL=N     the Nth such call fails (from 1; 0: none)
//   AFTERGLOW_FAULT_CODE=C     host (VK_ERROR_OUT_OF_HOST_MEMORY), device (VK_ERROR_OUT_OF_DEVICE_MEMORY), lost
//                              (VK_ERROR_DEVICE_LOST), surface (VK_ERROR_SURFACE_LOST_KHR) or date
//                              (VK_ERROR_OUT_OF_DATE_KHR). Counts, and fails, only calls that may return it. A lost
//                              device stays lost.
//   AFTERGLOW_FAULT_LOG=FILE   written at each such call: its number and its name
//
// One device at a time, as the program has it; a further one without a window (the watch for NaN) lacks some functions,
// and those of the first stay.
#include <vulkan/vulkan.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "../vulkan_chain.h"

namespace {

enum Codes : unsigned { kHost = 1, kDevice = 2, kLost = 4, kSurface = 8, kDate = 16 };

struct Wanted {
  long call = 0;
  Codes code = kHost;
  VkResult result = VK_ERROR_OUT_OF_HOST_MEMORY;
  std::FILE* log = nullptr;

  Wanted() {
    if (const char* number = std::getenv("AFTERGLOW_FAULT_CALL")) call = std::atol(number);
    const char* name = std::getenv("AFTERGLOW_FAULT_CODE");
    const std::string_view wanted = name ? name : "";
    if (wanted == "device") code = kDevice, result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    if (wanted == "lost") code = kLost, result = VK_ERROR_DEVICE_LOST;
    if (wanted == "surface") code = kSurface, result = VK_ERROR_SURFACE_LOST_KHR;
    if (wanted == "date") code = kDate, result = VK_ERROR_OUT_OF_DATE_KHR;
    if (const char* file = std::getenv("AFTERGLOW_FAULT_LOG")) log = std::fopen(file, "we");
  }
};

const Wanted& wanted() {
  static const Wanted wanted;
  return wanted;
}

PFN_vkDeviceWaitIdle wait_idle = nullptr;
VkDevice the_device = VK_NULL_HANDLE;

/// Whether this call fails.
bool strikes(const char* name, unsigned codes) {
  static std::atomic<long> calls{0};
  static std::atomic<bool> lost{false};
  if (!(codes & wanted().code)) return false;
  if (lost) return true;
  const long number = ++calls;
  if (wanted().log) {
    std::fprintf(wanted().log, "%ld %s\n", number, name);
    std::fflush(wanted().log);
  }
  if (number != wanted().call) return false;
  lost = wanted().code == kLost;
  if (lost && wait_idle) wait_idle(the_device);  // work of a lost device has come to an end
  return true;
}

// Calls that may fail, with what they may return by the Vulkan specification.
#define INSTANCE_CALLS(call)                                                                                \
  call(EnumeratePhysicalDevices, kHost | kDevice) call(EnumerateDeviceExtensionProperties, kHost | kDevice) \
      call(GetPhysicalDeviceSurfaceCapabilitiesKHR, kHost | kDevice | kSurface)                             \
          call(GetPhysicalDeviceImageFormatProperties, kHost | kDevice)

#define DEVICE_CALLS(call)                                                                                             \
  call(AllocateMemory, kHost | kDevice) call(MapMemory, kHost | kDevice)                                               \
      call(FlushMappedMemoryRanges, kHost | kDevice) call(InvalidateMappedMemoryRanges, kHost | kDevice)               \
          call(BindBufferMemory, kHost | kDevice) call(BindImageMemory, kHost | kDevice) call(                         \
              CreateBuffer, kHost | kDevice) call(CreateImage, kHost | kDevice) call(CreateImageView, kHost | kDevice) \
              call(CreateSampler, kHost | kDevice) call(CreateShaderModule, kHost | kDevice) call(                     \
                  CreatePipelineCache, kHost | kDevice) call(GetPipelineCacheData, kHost | kDevice)                    \
                  call(MergePipelineCaches, kHost | kDevice) call(CreatePipelineLayout, kHost | kDevice) call(         \
                      CreateGraphicsPipelines, kHost | kDevice) call(CreateComputePipelines, kHost | kDevice)          \
                      call(CreateDescriptorSetLayout, kHost | kDevice) call(CreateDescriptorPool, kHost | kDevice)     \
                          call(AllocateDescriptorSets, kHost | kDevice) call(CreateCommandPool, kHost | kDevice)       \
                              call(ResetCommandPool, kHost | kDevice) call(AllocateCommandBuffers, kHost | kDevice)    \
                                  call(BeginCommandBuffer, kHost | kDevice) call(EndCommandBuffer, kHost | kDevice)    \
                                      call(CreateFence, kHost | kDevice) call(ResetFences, kDevice) call(              \
                                          CreateSemaphore, kHost | kDevice) call(CreateQueryPool, kHost | kDevice)     \
                                          call(QueueSubmit2, kHost | kDevice | kLost)                                  \
                                              call(WaitForFences, kHost | kDevice | kLost)                             \
                                                  call(GetFenceStatus, kHost | kDevice | kLost)                        \
                                                      call(QueueWaitIdle, kHost | kDevice | kLost) call(               \
                                                          DeviceWaitIdle, kHost | kDevice | kLost)                     \
                                                          call(GetQueryPoolResults, kHost | kDevice | kLost) call(     \
                                                              CreateSwapchainKHR, kHost | kDevice | kLost | kSurface)  \
                                                              call(AcquireNextImageKHR,                                \
                                                                   kHost | kDevice | kLost | kSurface | kDate)         \
                                                                  call(QueuePresentKHR,                                \
                                                                       kHost | kDevice | kLost | kSurface | kDate)

/// The function that the program gets instead of the next one below.
template <int kNumber, typename Function>
struct Call;
template <int kNumber, typename... Arguments>
struct Call<kNumber, VkResult(VKAPI_PTR*)(Arguments...)> {
  static inline VkResult(VKAPI_PTR* next)(Arguments...) = nullptr;
  static inline const char* name = nullptr;
  static inline unsigned codes = 0;
  static VKAPI_ATTR VkResult VKAPI_CALL run(Arguments... arguments) {
    return strikes(name, codes) ? wanted().result : next(arguments...);
  }
};

enum CallNumber {
#define NUMBER(name, codes) k##name,
  INSTANCE_CALLS(NUMBER) DEVICE_CALLS(NUMBER)
#undef NUMBER
};

/// Null when the function is none of those above or does not exist below.
template <typename Load>
PFN_vkVoidFunction instance_call(const char* function, Load load) {
#define WRAP(call, may)                                                                             \
  if (std::strcmp(function, "vk" #call) == 0) {                                                     \
    using Wrapped = Call<k##call, PFN_vk##call>;                                                    \
    if (const auto found = reinterpret_cast<PFN_vk##call>(load("vk" #call))) Wrapped::next = found; \
    Wrapped::name = #call;                                                                          \
    Wrapped::codes = may;                                                                           \
    return Wrapped::next ? reinterpret_cast<PFN_vkVoidFunction>(&Wrapped::run) : nullptr;           \
  }
  INSTANCE_CALLS(WRAP)
  return nullptr;
}
template <typename Load>
PFN_vkVoidFunction device_call(const char* function, Load load) {
  DEVICE_CALLS(WRAP)
#undef WRAP
  return nullptr;
}

PFN_vkGetInstanceProcAddr next_instance = nullptr;
PFN_vkGetDeviceProcAddr next_device = nullptr;
VkInstance the_instance = VK_NULL_HANDLE;

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                               VkInstance* instance) {
  if (!chain::take_link(*info, next_instance)) return VK_ERROR_INITIALIZATION_FAILED;
  if (strikes("CreateInstance", kHost | kDevice)) return wanted().result;
  const auto create = chain::function_of<PFN_vkCreateInstance>(next_instance, VkInstance{}, "vkCreateInstance");
  const VkResult result = create(info, allocator, instance);
  if (result == VK_SUCCESS) the_instance = *instance;
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkDevice* device) {
  PFN_vkGetInstanceProcAddr next = nullptr;
  if (!chain::take_link(*info, next, next_device)) return VK_ERROR_INITIALIZATION_FAILED;
  if (strikes("CreateDevice", kHost | kDevice | kLost)) return wanted().result;
  const auto create = chain::function_of<PFN_vkCreateDevice>(next, the_instance, "vkCreateDevice");
  const VkResult result = create(physical, info, allocator, device);
  if (result != VK_SUCCESS) return result;
  the_device = *device;
  wait_idle = reinterpret_cast<PFN_vkDeviceWaitIdle>(next_device(*device, "vkDeviceWaitIdle"));
  return result;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device(VkDevice device, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(&get_device);
  const auto load = [device](const char* function) { return next_device(device, function); };
  const auto own = device_call(name, load);
  return own ? own : load(name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance(VkInstance instance, const char* name) {
  const chain::Entries entries{&create_instance, &create_device, &get_instance, &get_device};
  if (const auto entry = chain::entry_named(name, entries)) return entry;
  const auto load = [instance](const char* function) { return next_instance(instance, function); };
  const auto own = instance_call(name, load);
  return own ? own : load(name);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* negotiate) {
  return chain::negotiate(negotiate, &get_instance, &get_device);
}
