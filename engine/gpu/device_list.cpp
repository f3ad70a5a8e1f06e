// SPDX-License-Identifier: MIT
#include "gpu/device_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "core/parse_number.h"
#include "core/text.h"
#include "gpu/error.h"
#include "gpu/image.h"
#include "gpu/instance.h"

namespace afterglow {

std::vector<VkQueueFamilyProperties> queue_families(const VulkanFunctions& vk, VkPhysicalDevice device) {
  std::uint32_t count = 0;
  vk.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vk.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  return families;
}

namespace {

constexpr const char* kPortabilitySubset = "VK_KHR_portability_subset";  // its header is one of beta extensions

const char* type_name(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "cpu";
    default:
      return "other";
  }
}

int preference(const DeviceInfo& info) {
  static constexpr const char* kOrder[] = {"discrete", "integrated", "virtual", "cpu"};
  const auto at = std::ranges::find(kOrder, info.type);
  return static_cast<int>(at - std::begin(kOrder));
}

bool can_present(const VulkanFunctions& vk, VkPhysicalDevice device, std::uint32_t family, VkSurfaceKHR surface) {
  if (surface == VK_NULL_HANDLE) return true;
  VkBool32 supported = VK_FALSE;
  return vk.vkGetPhysicalDeviceSurfaceSupportKHR(device, family, surface, &supported) == VK_SUCCESS && supported;
}

std::set<std::string> extensions_of(const VulkanFunctions& vk, VkPhysicalDevice device) {
  std::uint32_t count = 0;
  if (vk.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr) != VK_SUCCESS) return {};
  std::vector<VkExtensionProperties> extensions(count);
  vk.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
  std::set<std::string> names;
  for (const auto& extension : extensions) names.insert(extension.extensionName);
  return names;
}

/// Extensions that stand for what later versions of Vulkan have, with those that they are built on.
std::vector<const char*> stand_ins(std::uint32_t api_version) {
  std::vector<const char*> names;
  if (api_version < VK_API_VERSION_1_2)
    names = {VK_KHR_CREATE_RENDERPASS_2_EXTENSION_NAME, VK_KHR_DEPTH_STENCIL_RESOLVE_EXTENSION_NAME};
  if (api_version < VK_API_VERSION_1_3) {
    names.push_back(VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME);
    names.push_back(VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME);
  }
  return names;
}

bool has_image_robustness_extension(const VulkanFunctions& vk, VkPhysicalDevice device, std::uint32_t api_version) {
  return api_version < VK_API_VERSION_1_3 && extensions_of(vk, device).contains(VK_EXT_IMAGE_ROBUSTNESS_EXTENSION_NAME);
}

bool can_compute_alone(const VulkanFunctions& vk, VkPhysicalDevice device) {
  const auto families = queue_families(vk, device);
  return std::ranges::any_of(families, [](const auto& f) { return (f.queueFlags & VK_QUEUE_COMPUTE_BIT) != 0; });
}

/// The first family with graphics and compute that can present to `surface`, when there is one: one queue does
/// everything. (A device that draws has a family with both.)
std::optional<std::uint32_t> graphics_family(const VulkanFunctions& vk, VkPhysicalDevice device, VkSurfaceKHR surface) {
  const auto families = queue_families(vk, device);
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if (can_draw_and_compute(families[i]) && can_present(vk, device, i, surface)) return i;
  }
  return std::nullopt;
}

bool can_draw_and_sample(const VulkanFunctions& vk, VkPhysicalDevice device, VkFormat format) {
  return supports(vk, device, format, kDrawnAndSampled);
}

std::string what_it_lacks(const VulkanFunctions& vk, VkPhysicalDevice device, std::uint32_t api_version,
                          VkSurfaceKHR surface) {
  const std::string version =
      fmt::format("{}.{}", VK_API_VERSION_MAJOR(api_version), VK_API_VERSION_MINOR(api_version));
  if (api_version < VK_API_VERSION_1_1) return "needs Vulkan 1.1, has " + version;
  const auto extensions = extensions_of(vk, device);
  std::vector<std::string> lacks;
  for (const char* name : stand_ins(api_version))
    if (!extensions.contains(name)) lacks.push_back(fmt::format("{} (or Vulkan 1.3, it has {})", name, version));
  if (!lacks.empty()) return "lacks " + join(lacks);
  VkPhysicalDeviceSynchronization2Features synchronization{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES};
  VkPhysicalDeviceDynamicRenderingFeatures rendering{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES, .pNext = &synchronization};
  VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &rendering};
  vk.vkGetPhysicalDeviceFeatures2(device, &features);
  if (!rendering.dynamicRendering) lacks.push_back("dynamicRendering");
  if (!synchronization.synchronization2) lacks.push_back("synchronization2");
  if (!graphics_family(vk, device, VK_NULL_HANDLE)) {
    lacks.push_back(can_compute_alone(vk, device)
                        ? "a graphics queue (those that it has only compute; passes are drawn)"
                        : "a graphics queue");
  } else if (!graphics_family(vk, device, surface)) {
    lacks.push_back("a graphics queue that can show pictures in this window");
  }
  if (surface != VK_NULL_HANDLE && !extensions.contains(VK_KHR_SWAPCHAIN_EXTENSION_NAME))
    lacks.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  if (!can_draw_and_sample(vk, device, VK_FORMAT_R32G32B32A32_SFLOAT)) lacks.push_back("drawing to RGBA32F");
  if (!can_draw_and_sample(vk, device, VK_FORMAT_R16G16B16A16_SFLOAT)) lacks.push_back("drawing to RGBA16F");
  return lacks.empty() ? "" : "lacks " + join(lacks);
}

std::string names_text(std::span<const DeviceInfo> devices) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < devices.size(); ++i) texts.push_back(fmt::format("{} ({})", i, devices[i].name));
  return join(texts);
}

/// Nearest device name; also by its first word, since nobody types "llvmpipe (LLVM 15.0.6, 256 bits)".
std::string nearest_device(std::span<const DeviceInfo> devices, const std::string& choice) {
  std::vector<std::string> names;
  for (const auto& device : devices) {
    names.push_back(lower(device.name));
    for (const auto& word : split(lower(device.name), ' ')) {
      if (word.size() > 2) names.push_back(word);
    }
  }
  return nearest_name(lower(choice), names);
}

Result<std::size_t> usable_or_error(std::span<const DeviceInfo> devices, std::size_t index) {
  if (devices[index].usable) return index;
  return Error{ErrorKind::device,
               fmt::format("device {} ({}) is not usable: {}", index, devices[index].name, devices[index].why_not)};
}

}  // namespace

std::vector<const char*> extensions_to_enable(const VulkanFunctions& vk, VkPhysicalDevice device,
                                              std::uint32_t api_version, bool present) {
  std::vector<const char*> names = stand_ins(api_version);
  if (present) names.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  if (has_image_robustness_extension(vk, device, api_version)) names.push_back(VK_EXT_IMAGE_ROBUSTNESS_EXTENSION_NAME);
  // Drivers that leave out parts of Vulkan want to be told that this is known.
  if (extensions_of(vk, device).contains(kPortabilitySubset)) names.push_back(kPortabilitySubset);
  return names;
}

bool can_bound_image_reads(const VulkanFunctions& vk, VkPhysicalDevice device, std::uint32_t api_version) {
  if (api_version < VK_API_VERSION_1_3 && !has_image_robustness_extension(vk, device, api_version)) return false;
  VkPhysicalDeviceImageRobustnessFeatures robustness{.sType =
                                                         VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_ROBUSTNESS_FEATURES};
  VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &robustness};
  vk.vkGetPhysicalDeviceFeatures2(device, &features);
  return robustness.robustImageAccess;
}

PhysicalDevice describe_device(const VulkanFunctions& vk, VkPhysicalDevice device, VkSurfaceKHR surface) {
  VkPhysicalDeviceDriverProperties driver{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceIDProperties id{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES, .pNext = &driver};
  VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &id};
  VkPhysicalDeviceProperties plain{};
  vk.vkGetPhysicalDeviceProperties(device, &plain);
  // The driver's properties are of Vulkan 1.2; an older device may not be asked for them.
  if (plain.apiVersion < VK_API_VERSION_1_2) id.pNext = nullptr;
  if (plain.apiVersion >= VK_API_VERSION_1_1) vk.vkGetPhysicalDeviceProperties2(device, &properties);

  PhysicalDevice out{.handle = device, .queue_family = graphics_family(vk, device, surface).value_or(0), .info = {}};
  out.info.name = plain.deviceName;
  out.info.type = type_name(plain.deviceType);
  out.info.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
  for (const auto byte : id.deviceUUID) out.info.uuid += fmt::format("{:02x}", byte);
  out.info.api_version = plain.apiVersion;
  out.info.why_not = what_it_lacks(vk, device, plain.apiVersion, surface);
  out.info.usable = out.info.why_not.empty();
  out.info.few_channels =
      std::ranges::all_of(kFewChannels, [&](VkFormat format) { return can_draw_and_sample(vk, device, format); });
  return out;
}

Result<std::vector<PhysicalDevice>> enumerate_devices(const VulkanFunctions& vk, VkInstance instance,
                                                      VkSurfaceKHR surface) {
  std::uint32_t count = 0;
  AFTERGLOW_VK(vk.vkEnumeratePhysicalDevices(instance, &count, nullptr), "cannot list Vulkan devices");
  std::vector<VkPhysicalDevice> handles(count);
  AFTERGLOW_VK(vk.vkEnumeratePhysicalDevices(instance, &count, handles.data()), "cannot list Vulkan devices");
  if (handles.empty()) return Error{ErrorKind::device, "no Vulkan device found"};
  std::vector<PhysicalDevice> devices;
  for (auto* handle : handles) devices.push_back(describe_device(vk, handle, surface));
  std::ranges::stable_sort(devices, {}, [](const PhysicalDevice& d) { return preference(d.info); });
  return devices;
}

Result<std::size_t> choose_device(std::span<const DeviceInfo> devices, const std::string& choice) {
  if (devices.empty()) return Error{ErrorKind::device, "no Vulkan device found"};
  if (choice.empty() || choice == "auto") {
    for (std::size_t i = 0; i < devices.size(); ++i) {
      if (devices[i].usable) return i;
    }
    return usable_or_error(devices, 0);
  }

  const auto number = parse_number<std::size_t>(choice);
  if (number && *number < devices.size()) return usable_or_error(devices, *number);
  // "7" must not mean a GeForce 7900 or any uuid with a 7 in it: short numbers are indices alone, parts of a uuid are
  // not short.
  constexpr std::size_t kLongestIndex = 2, kShortestUuidPart = 4;
  const bool part_of_name = !number || choice.size() > kLongestIndex;
  const bool part_of_uuid = choice.size() >= kShortestUuidPart;
  const std::string wanted = lower(choice);
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const bool matches = (part_of_name && lower(devices[i].name).find(wanted) != std::string::npos) ||
                         (part_of_uuid && lower(devices[i].uuid).find(wanted) != std::string::npos);
    if (matches && devices[i].usable) return i;  // preferred to an earlier one that cannot be used
    if (matches && !found) found = i;
  }
  if (found) return usable_or_error(devices, *found);
  Error error{ErrorKind::device, fmt::format("no device '{}'", choice)};
  error.allowed = "auto, an index or a part of a name or uuid of " + names_text(devices);
  error.nearest = nearest_device(devices, choice);
  return error;
}

Result<std::vector<DeviceInfo>> list_devices() {
  AFTERGLOW_TRY(const Instance instance, Instance::create(nullptr));
  AFTERGLOW_TRY(const auto devices, enumerate_devices(instance.functions(), instance.get()));
  std::vector<DeviceInfo> out;
  for (const auto& device : devices) out.push_back(device.info);
  return out;
}

}  // namespace afterglow
