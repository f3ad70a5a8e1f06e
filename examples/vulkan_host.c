// SPDX-License-Identifier: MIT
#include "vulkan_host.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HOST_DEFINE(name) PFN_##name name;
HOST_FUNCTIONS(HOST_DEFINE)
PFN_vkGetInstanceProcAddr vkGetInstanceProcAddr;

static void check(VkResult result, const char *what) {
  if (result == VK_SUCCESS) return;
  fprintf(stderr, "%s failed: %d\n", what, (int)result);
  exit(1);
}
#define CHECK(call) check(call, #call)

static void load_functions(VkInstance instance) {
#define HOST_LOAD(name) name = (PFN_##name)vkGetInstanceProcAddr(instance, #name);
  HOST_FUNCTIONS(HOST_LOAD)
}

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT types,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data, void *user) {
  (void)severity, (void)types;
  fprintf(stderr, "validation: %s\n", data->pMessage);
  ++*(int *)user;
  return VK_FALSE;
}

static bool has_layer(const char *name) {
  VkLayerProperties layers[64];
  uint32_t count = 64;
  vkEnumerateInstanceLayerProperties(&count, layers);
  for (uint32_t i = 0; i < count; ++i)
    if (!strcmp(layers[i].layerName, name)) return true;
  return false;
}

static void open_instance(Host *host) {
  const char *layer = "VK_LAYER_KHRONOS_validation", *extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  const bool validate = has_layer(layer);
  const VkValidationFeatureEnableEXT enabled = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  const VkValidationFeaturesEXT features = {.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                            .enabledValidationFeatureCount = 1,
                                            .pEnabledValidationFeatures = &enabled};
  const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
  const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                     .pNext = validate ? &features : NULL,
                                     .pApplicationInfo = &application,
                                     .enabledLayerCount = validate,
                                     .ppEnabledLayerNames = &layer,
                                     .enabledExtensionCount = validate,
                                     .ppEnabledExtensionNames = &extension};
  CHECK(vkCreateInstance(&info, NULL, &host->instance));
  load_functions(host->instance);
  if (!validate) return;
  const VkDebugUtilsMessengerCreateInfoEXT messenger = {
      .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
      .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
      .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
      .pfnUserCallback = on_message,
      .pUserData = &host->validation_errors};
  CHECK(vkCreateDebugUtilsMessengerEXT(host->instance, &messenger, NULL, &host->messenger));
}

void host_open(Host *host) {
  memset(host, 0, sizeof *host);
  void *library = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
  if (library) *(void **)&vkGetInstanceProcAddr = dlsym(library, "vkGetInstanceProcAddr");
  if (!vkGetInstanceProcAddr) check(VK_ERROR_INITIALIZATION_FAILED, "libvulkan.so.1");
  load_functions(VK_NULL_HANDLE);
  open_instance(host);

  uint32_t count = 1;
  vkEnumeratePhysicalDevices(host->instance, &count, &host->physical_device);
  if (count == 0) check(VK_ERROR_DEVICE_LOST, "a Vulkan device");
  VkQueueFamilyProperties families[16];
  uint32_t family_count = 16;
  vkGetPhysicalDeviceQueueFamilyProperties(host->physical_device, &family_count, families);
  while (host->queue_family < family_count && !(families[host->queue_family].queueFlags & VK_QUEUE_GRAPHICS_BIT))
    ++host->queue_family;

  const float priority = 1;
  const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                         .queueFamilyIndex = host->queue_family,
                                         .queueCount = 1,
                                         .pQueuePriorities = &priority};
  const VkPhysicalDeviceVulkan13Features features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                                     .synchronization2 = VK_TRUE,
                                                     .dynamicRendering = VK_TRUE};
  const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                   .pNext = &features,
                                   .queueCreateInfoCount = 1,
                                   .pQueueCreateInfos = &queue};
  CHECK(vkCreateDevice(host->physical_device, &info, NULL, &host->device));
  vkGetDeviceQueue(host->device, host->queue_family, 0, &host->queue);
  const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                        .queueFamilyIndex = host->queue_family};
  CHECK(vkCreateCommandPool(host->device, &pool, NULL, &host->pool));
}

void host_close(Host *host) {
  vkDestroyCommandPool(host->device, host->pool, NULL);
  vkDestroyDevice(host->device, NULL);
  if (host->messenger) vkDestroyDebugUtilsMessengerEXT(host->instance, host->messenger, NULL);
  vkDestroyInstance(host->instance, NULL);
}

static VkDeviceMemory allocate(Host *host, const VkMemoryRequirements *needs, VkMemoryPropertyFlags wanted) {
  VkPhysicalDeviceMemoryProperties types;
  vkGetPhysicalDeviceMemoryProperties(host->physical_device, &types);
  uint32_t type = 0;
  while (type < types.memoryTypeCount &&
         (!(needs->memoryTypeBits >> type & 1) || (types.memoryTypes[type].propertyFlags & wanted) != wanted))
    ++type;
  const VkMemoryAllocateInfo info = {
      .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs->size, .memoryTypeIndex = type};
  VkDeviceMemory memory;
  CHECK(vkAllocateMemory(host->device, &info, NULL, &memory));
  return memory;
}

HostImage host_make_image(Host *host, uint32_t width, uint32_t height, VkFormat format, VkImageUsageFlags usage) {
  HostImage out;
  const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                  .imageType = VK_IMAGE_TYPE_2D,
                                  .format = format,
                                  .extent = {width, height, 1},
                                  .mipLevels = 1,
                                  .arrayLayers = 1,
                                  .samples = VK_SAMPLE_COUNT_1_BIT,
                                  .usage = usage};
  CHECK(vkCreateImage(host->device, &info, NULL, &out.image));
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(host->device, out.image, &needs);
  out.memory = allocate(host, &needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  CHECK(vkBindImageMemory(host->device, out.image, out.memory, 0));
  const VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                      .image = out.image,
                                      .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                      .format = format,
                                      .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
  CHECK(vkCreateImageView(host->device, &view, NULL, &out.view));
  return out;
}

void host_destroy_image(Host *host, HostImage *image) {
  vkDestroyImageView(host->device, image->view, NULL);
  vkDestroyImage(host->device, image->image, NULL);
  vkFreeMemory(host->device, image->memory, NULL);
}

HostBuffer host_make_buffer(Host *host, VkDeviceSize size) {
  HostBuffer out;
  const VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                   .size = size,
                                   .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT};
  CHECK(vkCreateBuffer(host->device, &info, NULL, &out.buffer));
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(host->device, out.buffer, &needs);
  out.memory = allocate(host, &needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  CHECK(vkBindBufferMemory(host->device, out.buffer, out.memory, 0));
  CHECK(vkMapMemory(host->device, out.memory, 0, VK_WHOLE_SIZE, 0, &out.mapped));
  return out;
}

void host_destroy_buffer(Host *host, HostBuffer *buffer) {
  vkDestroyBuffer(host->device, buffer->buffer, NULL);
  vkFreeMemory(host->device, buffer->memory, NULL);
}

VkCommandBuffer host_begin(Host *host) {
  VkCommandBuffer commands;
  const VkCommandBufferAllocateInfo allocate_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                     .commandPool = host->pool,
                                                     .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                     .commandBufferCount = 1};
  CHECK(vkAllocateCommandBuffers(host->device, &allocate_info, &commands));
  const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  CHECK(vkBeginCommandBuffer(commands, &begin));
  return commands;
}

void host_submit_and_wait(Host *host, VkCommandBuffer commands) {
  CHECK(vkEndCommandBuffer(commands));
  const VkCommandBufferSubmitInfo buffer = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                            .commandBuffer = commands};
  const VkSubmitInfo2 submit = {
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &buffer};
  CHECK(vkQueueSubmit2(host->queue, 1, &submit, VK_NULL_HANDLE));
  CHECK(vkQueueWaitIdle(host->queue));
}

void host_change_layout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) {
  const VkImageMemoryBarrier2 change = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
                                        .oldLayout = from,
                                        .newLayout = to,
                                        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                        .image = image,
                                        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
  const VkDependencyInfo info = {
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &change};
  vkCmdPipelineBarrier2(commands, &info);
}

void host_make_readable(VkCommandBuffer commands) {
  const VkMemoryBarrier2 written = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                    .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                    .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                    .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                    .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
  const VkDependencyInfo info = {
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &written};
  vkCmdPipelineBarrier2(commands, &info);
}
