// SPDX-License-Identifier: MIT
/* The "engine" of the example vulkan.c: a Vulkan device of its own. Like many engines it fetches Vulkan's functions
 * into variables that have the functions' names. */
#ifndef VULKAN_HOST_H
#define VULKAN_HOST_H

#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <stdbool.h>
#include <vulkan/vulkan.h>

/* clang-format off */
#define HOST_FUNCTIONS(F) \
  F(vkCreateInstance) F(vkDestroyInstance) F(vkEnumerateInstanceLayerProperties) \
  F(vkEnumeratePhysicalDevices) F(vkGetPhysicalDeviceMemoryProperties) \
  F(vkGetPhysicalDeviceQueueFamilyProperties) F(vkCreateDevice) F(vkDestroyDevice) F(vkGetDeviceQueue) \
  F(vkCreateCommandPool) F(vkDestroyCommandPool) F(vkAllocateCommandBuffers) F(vkBeginCommandBuffer) \
  F(vkEndCommandBuffer) F(vkQueueSubmit2) F(vkQueueWaitIdle) F(vkCreateImage) F(vkDestroyImage) \
  F(vkGetImageMemoryRequirements) F(vkBindImageMemory) F(vkCreateImageView) F(vkDestroyImageView) \
  F(vkCreateBuffer) F(vkDestroyBuffer) F(vkGetBufferMemoryRequirements) F(vkBindBufferMemory) \
  F(vkAllocateMemory) F(vkFreeMemory) F(vkMapMemory) F(vkCmdCopyBufferToImage) F(vkCmdCopyImageToBuffer) \
  F(vkCmdPipelineBarrier2) F(vkCreateDebugUtilsMessengerEXT) F(vkDestroyDebugUtilsMessengerEXT)
/* clang-format on */
#define HOST_DECLARE(name) extern PFN_##name name;
HOST_FUNCTIONS(HOST_DECLARE)
extern PFN_vkGetInstanceProcAddr vkGetInstanceProcAddr;

typedef struct Host {
  VkInstance instance;
  VkPhysicalDevice physical_device;
  VkDevice device;
  VkQueue queue;
  uint32_t queue_family;
  VkCommandPool pool;
  VkDebugUtilsMessengerEXT messenger;
  int validation_errors;
} Host;

typedef struct HostImage {
  VkImage image;
  VkImageView view;
  VkDeviceMemory memory;
} HostImage;

typedef struct HostBuffer {
  VkBuffer buffer;
  VkDeviceMemory memory;
  void *mapped;
} HostBuffer;

/* All of these end the program when Vulkan fails; an example may. */
void host_open(Host *host); /* with the validation layer, where it is installed */
void host_close(Host *host);
HostImage host_make_image(Host *host, uint32_t width, uint32_t height, VkFormat format, VkImageUsageFlags usage);
void host_destroy_image(Host *host, HostImage *image);
HostBuffer host_make_buffer(Host *host, VkDeviceSize size);
void host_destroy_buffer(Host *host, HostBuffer *buffer);
VkCommandBuffer host_begin(Host *host);
void host_submit_and_wait(Host *host, VkCommandBuffer commands);

/* What has been written before becomes readable by whatever comes behind; the image changes its layout. */
void host_change_layout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to);
/* What copies have written becomes readable by the CPU, once the commands are done: waiting alone does not do that. */
void host_make_readable(VkCommandBuffer commands);

#endif
