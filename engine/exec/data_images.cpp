// SPDX-License-Identifier: MIT
#include "exec/data_images.h"

#include <cstring>
#include <utility>

#include "exec/submit.h"

namespace afterglow {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R32G32B32A32_SFLOAT;

Result<GpuImage> make(const Device& device, const GraphImage& image, bool storage) {
  VkImageUsageFlags usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  if (storage) usage |= VK_IMAGE_USAGE_STORAGE_BIT;
  const ImageDesc desc{.name = image.name, .size = image.size, .format = kFormat, .usage = usage};
  AFTERGLOW_CHECK(check_image(device, desc));
  return GpuImage::create(device, desc);
}

}  // namespace

Result<DataImages> DataImages::create(const Device& device, const Graph& graph, bool storage) {
  DataImages out;
  if (storage) out.layout_ = VK_IMAGE_LAYOUT_GENERAL;
  for (std::size_t i = 0; i < graph.images.size(); ++i) {
    if (!graph.images[i].data) continue;
    AFTERGLOW_TRY(GpuImage image, make(device, graph.images[i], storage));
    out.images_.emplace(static_cast<ImageId>(i), Held{std::move(image)});
  }
  return out;
}

Result<void> DataImages::fill(const Device& device, const Graph& graph) {
  std::vector<VkImageMemoryBarrier2> barriers;
  for (auto& [id, held] : images_) {
    const auto& data = graph.images[id].data;
    if (held.pixels == data->hash) continue;
    held.pixels.reset();
    const std::size_t row = static_cast<std::size_t>(data->size.width) * 4;
    const auto pack = [&](int y, std::byte* to) -> std::uint64_t {
      std::memcpy(to, data->pixels.data() + row * static_cast<std::size_t>(y), row * sizeof(float));
      return 0;
    };
    if (!staging_) staging_ = std::make_unique<Staging>(device);
    AFTERGLOW_CHECK(staging_->upload({held.image.get(), kFormat, data->size}, pack));
    if (layout_ != VK_IMAGE_LAYOUT_GENERAL) continue;
    barriers.push_back(image_barrier(held.image.get(), VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, 0,
                                     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                     VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                     VK_IMAGE_LAYOUT_GENERAL));
  }
  if (!barriers.empty()) {
    AFTERGLOW_TRY(Submitter submitter, Submitter::create(device));
    AFTERGLOW_CHECK(submitter.submit(
        [&](VkCommandBuffer commands) { record_barriers(device, commands, barriers.data(), barriers.size()); }));
    AFTERGLOW_CHECK(submitter.wait());
  }
  for (auto& [id, held] : images_) held.pixels = graph.images[id].data->hash;
  if (!std::exchange(filled_, true)) staging_.reset();  // most looks keep what they bring along
  return {};
}

}  // namespace afterglow
