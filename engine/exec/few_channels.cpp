// SPDX-License-Identifier: MIT
#include "exec/few_channels.h"

#include <algorithm>

#include "gpu/image.h"

namespace afterglow {
namespace {

/// Every format in every use.
bool holds_all(const Device& device) {
  constexpr VkFormatFeatureFlags kAll =
      kDrawnAndSampled | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT | VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
  return device.stores_few_channels() &&
         std::ranges::all_of(kFewChannels, [&](VkFormat format) { return supports(device, format, kAll); });
}

}  // namespace

bool holds_few_channels(const Device& device, const Graph& graph, const ExecutionConfig& config) {
  const bool kept = std::ranges::any_of(
      graph.histories, [&](const History& history) { return graph.images[history.previous].channels < 4; });
  if (kept) return holds_all(device);
  VkFormatFeatureFlags wanted = kDrawnAndSampled;
  if (config.hardware_filter) wanted |= VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
  const bool computed = std::ranges::any_of(
      graph.passes, [](const Pass& pass) { return pass.kind == PassKind::compute || !pass.by_workgroups.empty(); });
  const bool stored = config.storage_reads || config.dispatched || computed;
  if (stored) wanted |= VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
  return std::ranges::all_of(graph.images, [&](const GraphImage& image) {
    if (image.channels == 4) return true;
    const VkFormat wish = float_format(image.channels, config.storage == Storage::fp16 && !image.precise);
    return supports(device, wish, wanted) && (!stored || wish == VK_FORMAT_R32_SFLOAT || device.stores_few_channels());
  });
}

}  // namespace afterglow
