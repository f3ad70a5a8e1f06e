// SPDX-License-Identifier: MIT
#include "exec/formats.h"

#include <algorithm>
#include <array>

#include "gpu/image.h"

namespace afterglow {
namespace {

constexpr VkFormatFeatureFlags kDrawn = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT;

/// Every format in every use.
bool holds_all(const Device& device) {
  constexpr VkFormatFeatureFlags kAll =
      kDrawn | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT | VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
  return device.stores_few_channels() &&
         std::ranges::all_of(
             std::array{VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R16_SFLOAT, VK_FORMAT_R16G16_SFLOAT},
             [&](VkFormat format) { return supports(device, format, kAll); });
}

}  // namespace

bool supports(const Device& device, VkFormat format, VkFormatFeatureFlags wanted) {
  VkFormatProperties properties{};
  device.vk().vkGetPhysicalDeviceFormatProperties(device.physical(), format, &properties);
  return (properties.optimalTilingFeatures & wanted) == wanted;
}

bool holds_few_channels(const Device& device, const Graph& graph, const ExecutionConfig& config) {
  const bool kept = std::ranges::any_of(
      graph.histories, [&](const History& history) { return graph.images[history.previous].channels < 4; });
  if (kept) return holds_all(device);
  VkFormatFeatureFlags wanted = kDrawn;
  if (config.hardware_filter) wanted |= VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
  const bool computed = std::ranges::any_of(
      graph.passes, [](const Pass& pass) { return pass.kind == PassKind::compute || !pass.by_workgroups.empty(); });
  const bool stored = config.storage_reads || computed;
  if (stored) wanted |= VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
  return std::ranges::all_of(graph.images, [&](const GraphImage& image) {
    if (image.channels == 4) return true;
    const VkFormat wish = float_format(image.channels, config.storage == Storage::fp16);
    return supports(device, wish, wanted) && (!stored || wish == VK_FORMAT_R32_SFLOAT || device.stores_few_channels());
  });
}

}  // namespace afterglow
