// SPDX-License-Identifier: MIT
// VK_LAYER_AFTERGLOW_forgetful: what Vulkan need not keep is gone. Images that come from the layout UNDEFINED, and
// attachments that are loaded with DONT_CARE, hold NaN, as on GPUs that compress images or draw by tiles; drivers for
// CPUs keep every pixel. Linear images are left alone: they may be mapped.
#include <vulkan/vulkan.h>

#include <cmath>
#include <mutex>
#include <set>
#include <string_view>
#include <vector>

#include "../vulkan_chain.h"

namespace {

#define CALLS(call) call(CreateImage) call(DestroyImage) call(CmdPipelineBarrier2) call(CmdBeginRendering)

/// The functions below this layer.
struct Next {
  PFN_vkGetInstanceProcAddr instance = nullptr;
  PFN_vkGetDeviceProcAddr device = nullptr;
  PFN_vkCmdClearColorImage CmdClearColorImage = nullptr;
#define MEMBER(name) PFN_vk##name name = nullptr;
  CALLS(MEMBER)
#undef MEMBER
};
Next next;
VkInstance the_instance = VK_NULL_HANDLE;

constexpr VkClearColorValue kNothing{{NAN, NAN, NAN, NAN}};

std::mutex images_mutex;
std::set<VkImage> forgetful;

VKAPI_ATTR VkResult VKAPI_CALL CreateImage(VkDevice device, const VkImageCreateInfo* info,
                                           const VkAllocationCallbacks* allocator, VkImage* image) {
  VkImageCreateInfo below = *info;
  const bool takes = info->tiling == VK_IMAGE_TILING_OPTIMAL && info->format != VK_FORMAT_D16_UNORM;
  if (takes) below.usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  const VkResult result = next.CreateImage(device, &below, allocator, image);
  const std::lock_guard lock(images_mutex);
  if (result == VK_SUCCESS && takes) forgetful.insert(*image);
  return result;
}

VKAPI_ATTR void VKAPI_CALL DestroyImage(VkDevice device, VkImage image, const VkAllocationCallbacks* allocator) {
  {
    const std::lock_guard lock(images_mutex);
    forgetful.erase(image);
  }
  next.DestroyImage(device, image, allocator);
}

/// Images go by way of a layout in which they are cleared.
VKAPI_ATTR void VKAPI_CALL CmdPipelineBarrier2(VkCommandBuffer commands, const VkDependencyInfo* info) {
  std::vector<VkImageMemoryBarrier2> before(info->pImageMemoryBarriers,
                                            info->pImageMemoryBarriers + info->imageMemoryBarrierCount);
  std::vector<VkImageMemoryBarrier2> after;
  {
    const std::lock_guard lock(images_mutex);
    for (auto& barrier : before) {
      if (barrier.oldLayout != VK_IMAGE_LAYOUT_UNDEFINED || !forgetful.contains(barrier.image)) continue;
      VkImageMemoryBarrier2& then = after.emplace_back(barrier);
      then.oldLayout = barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
      then.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
      then.srcAccessMask = barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    }
  }
  VkDependencyInfo below = *info;
  below.pImageMemoryBarriers = before.data();
  next.CmdPipelineBarrier2(commands, &below);
  if (after.empty()) return;
  for (const auto& barrier : after)
    next.CmdClearColorImage(commands, barrier.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &kNothing, 1,
                            &barrier.subresourceRange);
  const VkDependencyInfo rest{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                              .imageMemoryBarrierCount = static_cast<std::uint32_t>(after.size()),
                              .pImageMemoryBarriers = after.data()};
  next.CmdPipelineBarrier2(commands, &rest);
}

VKAPI_ATTR void VKAPI_CALL CmdBeginRendering(VkCommandBuffer commands, const VkRenderingInfo* info) {
  std::vector<VkRenderingAttachmentInfo> colors(info->pColorAttachments,
                                                info->pColorAttachments + info->colorAttachmentCount);
  for (auto& color : colors) {
    if (color.loadOp != VK_ATTACHMENT_LOAD_OP_DONT_CARE) continue;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    color.clearValue.color = kNothing;
  }
  VkRenderingInfo below = *info;
  below.pColorAttachments = colors.data();
  next.CmdBeginRendering(commands, &below);
}

// The chain.

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device(VkDevice device, const char* name) {
  if (chain::is_named(name, "vkGetDeviceProcAddr")) return reinterpret_cast<PFN_vkVoidFunction>(&get_device);
#define OWN(call) \
  if (chain::is_named(name, "vk" #call) && next.call) return reinterpret_cast<PFN_vkVoidFunction>(&call);
  CALLS(OWN)
#undef OWN
  return next.device(device, name);
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                               VkInstance* instance) {
  if (!chain::take_link(*info, next.instance)) return VK_ERROR_INITIALIZATION_FAILED;
  const auto create = chain::function_of<PFN_vkCreateInstance>(next.instance, VkInstance{}, "vkCreateInstance");
  const VkResult result = create(info, allocator, instance);
  the_instance = *instance;
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkDevice* device) {
  PFN_vkGetInstanceProcAddr below = nullptr;
  if (!chain::take_link(*info, below, next.device)) return VK_ERROR_INITIALIZATION_FAILED;
  const auto create = chain::function_of<PFN_vkCreateDevice>(below, the_instance, "vkCreateDevice");
  if (const VkResult result = create(physical, info, allocator, device); result != VK_SUCCESS) return result;
#define LOAD(call) next.call = reinterpret_cast<PFN_vk##call>(next.device(*device, "vk" #call));
  CALLS(LOAD)
  LOAD(CmdClearColorImage)
#undef LOAD
  return VK_SUCCESS;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance(VkInstance instance, const char* name) {
  const chain::Entries entries{&create_instance, &create_device, &get_instance, &get_device};
  if (const auto own = chain::entry_named(name, entries)) return own;
  return next.instance(instance, name);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* wanted) {
  return chain::negotiate(wanted, &get_instance, &get_device);
}
