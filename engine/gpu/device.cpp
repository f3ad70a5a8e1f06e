// SPDX-License-Identifier: MIT
#include "gpu/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <thread>

#include "core/exception.h"
#include "core/parallel.h"
#include "gpu/device_list.h"
#include "gpu/error.h"
#include "gpu/instance.h"
#include "gpu/surface.h"

namespace afterglow {

namespace {

VkPhysicalDeviceFeatures features_of(const VulkanFunctions& vk, VkPhysicalDevice device) {
  VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  vk.vkGetPhysicalDeviceFeatures2(device, &features);
  return features.features;
}

/// What all devices are asked for that have it: see stores_from_fragments and stores_few_channels.
bool can_store_from_fragments(const VulkanFunctions& vk, VkPhysicalDevice device) {
  return features_of(vk, device).fragmentStoresAndAtomics;
}
bool can_store_few_channels(const VulkanFunctions& vk, VkPhysicalDevice device) {
  return features_of(vk, device).shaderStorageImageExtendedFormats;
}

/// A driver that runs on the processors has a thread for each of them, and waits for ever for one that could not be
/// started.
Result<void> check_threads(const DeviceInfo& info) {
  if (info.type != "cpu") return {};
  constexpr long kMost = 32;  // that Mesa's driver starts
  const char* asked = std::getenv("LP_NUM_THREADS");
  char* end = nullptr;
  long wanted = asked ? std::strtol(asked, &end, 0) : 0;
  if (!asked || end == asked) wanted = static_cast<long>(std::thread::hardware_concurrency());
  const long threads = std::clamp(wanted, 0l, kMost) + 1;  // and one for what is submitted
  if (can_start_threads(static_cast<std::size_t>(threads))) return {};
  return Error{
      ErrorKind::device,
      fmt::format("cannot open device '{}', whose driver needs {} threads: {}", info.name, threads, kNoMoreThreads), "",
      0, "LP_NUM_THREADS=1 for fewer, with Mesa's driver"};
}

Result<VkDevice> open_device(const VulkanFunctions& vk, const PhysicalDevice& chosen, bool present) {
  AFTERGLOW_CHECK(check_threads(chosen.info));
  const auto extensions = extensions_to_enable(vk, chosen.handle, chosen.info.api_version, present);
  const float priority = 1;
  const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                      .queueFamilyIndex = chosen.queue_family,
                                      .queueCount = 1,
                                      .pQueuePriorities = &priority};
  VkPhysicalDeviceSynchronization2Features synchronization{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES, .synchronization2 = VK_TRUE};
  const VkPhysicalDeviceDynamicRenderingFeatures features{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES,
      .pNext = &synchronization,
      .dynamicRendering = VK_TRUE};
  VkPhysicalDeviceImageRobustnessFeatures robustness{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_ROBUSTNESS_FEATURES, .robustImageAccess = VK_TRUE};
  if (can_bound_image_reads(vk, chosen.handle, chosen.info.api_version)) synchronization.pNext = &robustness;
  const VkPhysicalDeviceFeatures wanted{.fragmentStoresAndAtomics = can_store_from_fragments(vk, chosen.handle),
                                        .shaderStorageImageExtendedFormats = can_store_few_channels(vk, chosen.handle)};
  const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                .pNext = &features,
                                .queueCreateInfoCount = 1,
                                .pQueueCreateInfos = &queue,
                                .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                                .ppEnabledExtensionNames = extensions.data(),
                                .pEnabledFeatures = &wanted};
  VkDevice handle = VK_NULL_HANDLE;
  AFTERGLOW_VK(vk.vkCreateDevice(chosen.handle, &info, nullptr, &handle),
               fmt::format("cannot open device '{}'", chosen.info.name));
  return handle;
}

struct Opened {
  std::size_t index = 0;
  VkDevice handle = VK_NULL_HANDLE;
};

/// Opens the device that `choice` means. A GPU that is listed but cannot be opened (its driver is broken, its users are
/// too many) does not keep "auto" from the ones behind it.
Result<Opened> open_chosen(const VulkanFunctions& vk, std::vector<DeviceInfo> infos,
                           const std::vector<PhysicalDevice>& devices, const DeviceOptions& options,
                           Diagnostics& diagnostics) {
  const std::string& choice = options.device;
  std::optional<Error> failed;  // why the one before could not be opened
  for (;;) {
    const auto index = choose_device(infos, choice);
    if (!index) return failed ? *std::move(failed) : index.error();
    if (failed) diagnostics.warn(failed->message + "; trying the next one");
    auto opened = open_device(vk, devices[*index], options.presentation != nullptr);
    if (opened) return Opened{*index, *opened};
    const bool automatic = choice.empty() || choice == "auto";
    if (!automatic) return std::move(opened).error();
    infos[*index].usable = false;
    failed = std::move(opened).error();
  }
}

/// With a window: judged by whether they can present to it. Its surface serves for that alone.
Result<std::vector<PhysicalDevice>> devices_for(const VulkanFunctions& vk, VkInstance instance,
                                                const Presentation* presentation) {
  if (!presentation) return enumerate_devices(vk, instance);
  AFTERGLOW_TRY(const Surface surface, Surface::create(vk, instance, *presentation));
  return enumerate_devices(vk, instance, surface.get());
}

}  // namespace

Result<std::unique_ptr<Device>> Device::create(const DeviceOptions& options, Diagnostics& diagnostics) {
  auto log = std::make_shared<ValidationLog>();
  const auto extensions = options.presentation ? options.presentation->instance_extensions : std::vector<std::string>{};
  AFTERGLOW_TRY(Instance instance, Instance::create(options.validate ? log : nullptr, extensions));
  AFTERGLOW_TRY(const auto devices, devices_for(instance.functions(), instance.get(), options.presentation.get()));
  std::vector<DeviceInfo> infos;
  for (const auto& device : devices) infos.push_back(device.info);
  AFTERGLOW_TRY(const Opened opened,
                open_chosen(instance.functions(), std::move(infos), devices, options, diagnostics));
  const PhysicalDevice& chosen = devices[opened.index];

  // From here on the Device can let go of all of it, whatever fails.
  std::unique_ptr<Device> device(new Device);
  device->owned_ = true;
  device->device_ = opened.handle;
  device->functions_ = instance.functions();
  device->instance_ = instance.release(device->messenger_);
  AFTERGLOW_CHECK(device->functions_.load_device(opened.handle, chosen.info.api_version));

  device->log_ = std::move(log);
  device->presentation_ = options.presentation;
  device->forced_ = options.forced;
  device->physical_ = chosen.handle;
  device->stores_from_fragments_ = can_store_from_fragments(device->functions_, chosen.handle);
  device->stores_few_channels_ = can_store_few_channels(device->functions_, chosen.handle);
  device->queue_family_ = chosen.queue_family;
  device->info_ = chosen.info;
  AFTERGLOW_CHECK(device->finish());
  diagnostics.note(fmt::format("device: {} ({}, {})", chosen.info.name, chosen.info.type, chosen.info.driver));
  return device;
}

Result<std::unique_ptr<Device>> Device::adopt(const AdoptedDevice& adopted, Diagnostics& diagnostics) {
  if (adopted.instance == VK_NULL_HANDLE || adopted.physical_device == VK_NULL_HANDLE ||
      adopted.device == VK_NULL_HANDLE || adopted.queue == VK_NULL_HANDLE) {
    return Error{ErrorKind::device, "an adopted device needs an instance, a physical device, a device and a queue"};
  }
  AFTERGLOW_TRY(VulkanFunctions functions, VulkanFunctions::load(adopted.get_instance_proc_addr));
  AFTERGLOW_CHECK(functions.load_instance(adopted.instance));
  const PhysicalDevice described = describe_device(functions, adopted.physical_device);
  if (!described.info.usable) {
    return Error{ErrorKind::device,
                 fmt::format("adopted device '{}' is not usable: {}", described.info.name, described.info.why_not)};
  }
  const auto families = queue_families(functions, adopted.physical_device);
  if (adopted.queue_family >= families.size() || !can_draw_and_compute(families[adopted.queue_family])) {
    return Error{ErrorKind::device,
                 fmt::format("adopted queue family {} cannot draw and compute", adopted.queue_family)};
  }

  std::unique_ptr<Device> device(new Device);
  device->log_ = std::make_shared<ValidationLog>();
  device->functions_ = functions;
  device->instance_ = adopted.instance;
  device->physical_ = adopted.physical_device;
  device->device_ = adopted.device;
  device->queue_ = adopted.queue;
  device->queue_family_ = adopted.queue_family;
  device->info_ = described.info;
  AFTERGLOW_CHECK(device->functions_.load_device(adopted.device, described.info.api_version));
  AFTERGLOW_CHECK(device->finish());
  diagnostics.note(fmt::format("device: {} ({}, adopted)", described.info.name, described.info.type));
  return device;
}

/// What created and adopted devices have in common.
Result<void> Device::finish() {
  if (owned_) functions_.vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
  // VK_EXT_debug_utils is enabled with validation, or by the caller whose instance it is.
  if (owned_ && messenger_ == VK_NULL_HANDLE) {
    functions_.vkSetDebugUtilsObjectNameEXT = nullptr;
    functions_.vkCmdBeginDebugUtilsLabelEXT = nullptr;
    functions_.vkCmdEndDebugUtilsLabelEXT = nullptr;
  }
  VkPhysicalDeviceMaintenance3Properties limits{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &limits};
  functions_.vkGetPhysicalDeviceProperties2(physical_, &properties);
  properties_ = properties.properties;
  max_allocation_ = limits.maxMemoryAllocationSize;
  functions_.vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);

  const std::uint32_t bits = queue_families(functions_, physical_)[queue_family_].timestampValidBits;
  if (properties_.limits.timestampPeriod > 0 && bits > 0) timestamp_mask_ = ~std::uint64_t{0} >> (64 - bits);

  const VkPipelineCacheCreateInfo cache{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  AFTERGLOW_VK(functions_.vkCreatePipelineCache(device_, &cache, nullptr, &pipeline_cache_),
               "cannot create a pipeline cache");
  return {};
}

void Device::free_destroyed() const {
  if (!owned_ || !is_cpu()) return;
  const VkSubmitInfo2 nothing{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  const auto lock = lock_queue();
  (void)functions_.vkQueueSubmit2(queue_, 1, &nothing, VK_NULL_HANDLE);  // a lost device is found elsewhere
}

Device::~Device() {
  if (pipeline_cache_ != VK_NULL_HANDLE) functions_.vkDestroyPipelineCache(device_, pipeline_cache_, nullptr);
  if (!owned_) return;
  if (functions_.vkDestroyDevice) functions_.vkDestroyDevice(device_, nullptr);
  destroy_instance(functions_, instance_, messenger_);
}

void Device::set_name(VkObjectType type, std::uint64_t handle, const std::string& name) const {
  if (!functions_.vkSetDebugUtilsObjectNameEXT) return;
  const VkDebugUtilsObjectNameInfoEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                           .objectType = type,
                                           .objectHandle = handle,
                                           .pObjectName = name.c_str()};
  functions_.vkSetDebugUtilsObjectNameEXT(device_, &info);
}

void Device::begin_label(VkCommandBuffer commands, const std::string& name) const {
  if (!functions_.vkCmdBeginDebugUtilsLabelEXT) return;
  const VkDebugUtilsLabelEXT label{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = name.c_str()};
  functions_.vkCmdBeginDebugUtilsLabelEXT(commands, &label);
}

void Device::end_label(VkCommandBuffer commands) const {
  if (functions_.vkCmdEndDebugUtilsLabelEXT) functions_.vkCmdEndDebugUtilsLabelEXT(commands);
}

int Device::validation_errors() const { return log_->errors(); }
std::vector<std::string> Device::validation_messages() const { return log_->messages(); }

}  // namespace afterglow
