// SPDX-License-Identifier: MIT
#include "gpu/instance.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstring>

#if defined(__SANITIZE_ADDRESS__)
#include <dlfcn.h>
#endif

#include "core/text.h"
#include "gpu/error.h"

#if defined(__SANITIZE_ADDRESS__)
// The validation layer leaks a few KiB of its own, and OpenImageIO's reader of videos a frame of FFmpeg's.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libVkLayer_khronos_validation.so\nleak:libavutil.so\n";
}
#endif

namespace afterglow {

namespace {

/// What lavapipe allocates once is reachable only while it is loaded, and a leak of the layer is matched with its
/// suppression by name. Under AddressSanitizer both stay loaded when the last instance goes.
void keep_libraries_loaded() {
#if defined(__SANITIZE_ADDRESS__)
  for (const char* library : {"libVkLayer_khronos_validation.so", "libvulkan_lvp.so"}) {
    dlopen(library, RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE);
  }
#endif
}

constexpr const char* kLayer = "VK_LAYER_KHRONOS_validation";
constexpr std::size_t kMaxMessages = 1000;

bool has_layer(const VulkanFunctions& vk) {
  std::uint32_t count = 0;
  if (vk.vkEnumerateInstanceLayerProperties(&count, nullptr) != VK_SUCCESS) return false;
  std::vector<VkLayerProperties> layers(count);
  vk.vkEnumerateInstanceLayerProperties(&count, layers.data());
  return std::ranges::any_of(layers, [](const auto& l) { return std::strcmp(l.layerName, kLayer) == 0; });
}

bool has_extension(const VulkanFunctions& vk, std::string_view name) {
  std::uint32_t count = 0;
  if (vk.vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr) != VK_SUCCESS) return false;
  std::vector<VkExtensionProperties> extensions(count);
  vk.vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data());
  return std::ranges::any_of(extensions, [&](const auto& e) { return name == e.extensionName; });
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                          VkDebugUtilsMessageTypeFlagsEXT types,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  const bool error = (severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT) != 0 &&
                     (types & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT) != 0;
  static_cast<ValidationLog*>(user)->add(error, data->pMessage ? data->pMessage : "");
  return VK_FALSE;
}

}  // namespace

void ValidationLog::add(bool error, const std::string& message) {
  const std::lock_guard lock(mutex_);
  if (error) ++errors_;
  std::string text = (error ? "error: " : "warning: ") + message;
  if (messages_.size() < kMaxMessages && std::ranges::find(messages_, text) == messages_.end()) {
    messages_.push_back(std::move(text));
  }
}

int ValidationLog::errors() const {
  const std::lock_guard lock(mutex_);
  return errors_;
}

std::vector<std::string> ValidationLog::messages() const {
  const std::lock_guard lock(mutex_);
  return messages_;
}

Result<Instance> Instance::create(std::shared_ptr<ValidationLog> log, const std::vector<std::string>& extensions) {
  Instance out;
  AFTERGLOW_TRY(out.functions_, VulkanFunctions::load());
  std::uint32_t version = VK_API_VERSION_1_0;
  if (out.functions_.vkEnumerateInstanceVersion) out.functions_.vkEnumerateInstanceVersion(&version);
  if (version < VK_API_VERSION_1_1) return Error{ErrorKind::device, "the Vulkan loader is older than 1.1"};
  if (log && !has_layer(out.functions_)) {
    return Error{ErrorKind::device, std::string("validation was asked for, but the layer ") + kLayer +
                                        " is not installed (Debian: vulkan-validationlayers)"};
  }

  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                      .pApplicationName = "afterglow",
                                      .pEngineName = "afterglow",
                                      .apiVersion = VK_API_VERSION_1_3};
  VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};

  // The messenger is chained to the creation too, so that messages about the instance itself are seen.
  const VkDebugUtilsMessengerCreateInfoEXT messenger{
      .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
      .messageSeverity =
          VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
      .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
      .pfnUserCallback = on_message,
      .pUserData = log.get()};
  const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  const VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                         .pNext = &messenger,
                                         .enabledValidationFeatureCount = 1,
                                         .pEnabledValidationFeatures = &synchronization};
  std::vector<const char*> names;
  for (const auto& extension : extensions) names.push_back(extension.c_str());
  // Without it the loader hides drivers that leave out parts of Vulkan, as those over Metal do.
  if (has_extension(out.functions_, VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME)) {
    names.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
    info.flags |= VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR;
  }
  if (log) {
    names.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    names.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    info.pNext = &features;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kLayer;
  }
  info.enabledExtensionCount = static_cast<std::uint32_t>(names.size());
  info.ppEnabledExtensionNames = names.data();

  out.log_ = log;
  const VkResult created = out.functions_.vkCreateInstance(&info, nullptr, &out.instance_);
  if (created == VK_ERROR_INCOMPATIBLE_DRIVER) {
    return Error{ErrorKind::device,
                 "no Vulkan driver found (Debian: mesa-vulkan-drivers brings one that runs on the CPU)"};
  }
  if (created == VK_ERROR_EXTENSION_NOT_PRESENT && !extensions.empty()) {
    return Error{ErrorKind::device, fmt::format("the Vulkan loader cannot show pictures in windows of this system "
                                                "(it needs {})",
                                                join(extensions))};
  }
  AFTERGLOW_VK(created, "cannot create a Vulkan instance");
  AFTERGLOW_CHECK(out.functions_.load_instance(out.instance_));
  keep_libraries_loaded();
  if (log) {
    const auto create_messenger = out.functions_.vkCreateDebugUtilsMessengerEXT;
    if (!create_messenger) return Error{ErrorKind::device, "the validation layer offers no VK_EXT_debug_utils"};
    AFTERGLOW_VK(create_messenger(out.instance_, &messenger, nullptr, &out.messenger_),
                 "cannot listen to the validation layer");
  }
  return out;
}

Instance& Instance::operator=(Instance&& other) noexcept {
  std::swap(functions_, other.functions_);
  std::swap(instance_, other.instance_);
  std::swap(messenger_, other.messenger_);
  std::swap(log_, other.log_);
  return *this;
}

Instance::~Instance() { destroy_instance(functions_, instance_, messenger_); }

VkInstance Instance::release(VkDebugUtilsMessengerEXT& messenger) {
  messenger = std::exchange(messenger_, VK_NULL_HANDLE);
  return std::exchange(instance_, VK_NULL_HANDLE);
}

void destroy_instance(const VulkanFunctions& vk, VkInstance instance, VkDebugUtilsMessengerEXT messenger) {
  if (instance == VK_NULL_HANDLE) return;
  if (messenger != VK_NULL_HANDLE) vk.vkDestroyDebugUtilsMessengerEXT(instance, messenger, nullptr);
  static std::atomic<VkInstance> stays = VK_NULL_HANDLE;
  VkInstance none = VK_NULL_HANDLE;
  if (stays.compare_exchange_strong(none, instance)) return;
  vk.vkDestroyInstance(instance, nullptr);
}

}  // namespace afterglow
