// SPDX-License-Identifier: MIT
#include "gpu/functions.h"

#include <dlfcn.h>
#include <fmt/format.h>

namespace afterglow {
namespace {

Error missing(const char* name) { return {ErrorKind::device, fmt::format("the Vulkan driver has no {}", name)}; }

constexpr const char* kLoader = "libvulkan.so.1";

/// Null when it is not installed; `why` then.
PFN_vkGetInstanceProcAddr system_loader(std::string& why) {
  void* library = dlopen(kLoader, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  void* address = library ? dlsym(library, "vkGetInstanceProcAddr") : nullptr;
  if (!address)
    if (const char* text = dlerror()) why = text;
  return reinterpret_cast<PFN_vkGetInstanceProcAddr>(address);
}

}  // namespace

#define AFTERGLOW_LOAD(name) name = reinterpret_cast<PFN_##name>(find(#name));
#define AFTERGLOW_NEED(name) \
  AFTERGLOW_LOAD(name)       \
  if (!name) return missing(#name);

Result<VulkanFunctions> VulkanFunctions::load(PFN_vkGetInstanceProcAddr get) {
  std::string why = "not found";
  if (!get) get = system_loader(why);
  if (!get) return Error{ErrorKind::device, fmt::format("no Vulkan loader {} (Debian: libvulkan1): {}", kLoader, why)};
  VulkanFunctions out;
  out.vkGetInstanceProcAddr = get;
  const auto find = [&](const char* name) { return get(VK_NULL_HANDLE, name); };
  out.vkEnumerateInstanceVersion = reinterpret_cast<PFN_vkEnumerateInstanceVersion>(find("vkEnumerateInstanceVersion"));
#define AFTERGLOW_NEED_OUT(name)                        \
  out.name = reinterpret_cast<PFN_##name>(find(#name)); \
  if (!out.name) return missing(#name);
  AFTERGLOW_GLOBAL_FUNCTIONS(AFTERGLOW_NEED_OUT)
#undef AFTERGLOW_NEED_OUT
  return out;
}

Result<void> VulkanFunctions::load_instance(VkInstance instance) {
  const auto find = [&](const char* name) { return vkGetInstanceProcAddr(instance, name); };
  AFTERGLOW_INSTANCE_FUNCTIONS(AFTERGLOW_NEED)
  AFTERGLOW_INSTANCE_EXTENSION_FUNCTIONS(AFTERGLOW_LOAD)
  return {};
}

Result<void> VulkanFunctions::load_device(VkDevice device, std::uint32_t api_version) {
  const auto find = [&](const char* name) { return vkGetDeviceProcAddr(device, name); };
  AFTERGLOW_DEVICE_FUNCTIONS(AFTERGLOW_NEED)
  const bool is_core = api_version >= VK_API_VERSION_1_3;
#define AFTERGLOW_NEED_PROMOTED(name)                                       \
  name = reinterpret_cast<PFN_##name>(find(is_core ? #name : #name "KHR")); \
  if (!name) name = reinterpret_cast<PFN_##name>(find(#name "KHR"));        \
  if (!name) return missing(is_core ? #name : #name "KHR");
  AFTERGLOW_DEVICE_PROMOTED_FUNCTIONS(AFTERGLOW_NEED_PROMOTED)
#undef AFTERGLOW_NEED_PROMOTED
  AFTERGLOW_DEVICE_EXTENSION_FUNCTIONS(AFTERGLOW_LOAD)
  return {};
}

}  // namespace afterglow
