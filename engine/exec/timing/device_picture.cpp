// SPDX-License-Identifier: MIT
#include "exec/timing/device_picture.h"

#include <vector>

#include "exec/convert.h"
#include "exec/host_input.h"
#include "exec/staging.h"

namespace afterglow {
namespace {

constexpr VkImageLayout kRest = VK_IMAGE_LAYOUT_GENERAL;

}  // namespace

Result<FrameImage> upload_image(const Device& device, const Image& image, VkFormat format, VkImageUsageFlags usage,
                                VkImageLayout layout) {
  AFTERGLOW_TRY(FrameImage out,
                FrameImage::create(device, {.name = "picture", .size = image.size(), .format = format, .usage = usage},
                                   device.maps_images() ? HostAccess::write : HostAccess::none));
  const auto pack = [&](int y, std::byte* to) {
    const auto row = static_cast<std::size_t>(y) * image.width * image.channels;
    return pack_row(image.pixels.data() + row, image.channels, image.width, format, to);
  };
  if (out.direct) {
    over_rows(image.height, out.image.row_pitch(), [&](int y) { return pack(y, out.image.row(y)); });
    AFTERGLOW_CHECK(out.image.memory().flush());
  } else {
    Staging staging(device);
    AFTERGLOW_CHECK(staging.upload({out.image.get(), format, image.size()}, pack));
    out.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  }
  AFTERGLOW_TRY(Submitter submitter, Submitter::create(device));
  AFTERGLOW_CHECK(submitter.submit([&](VkCommandBuffer commands) {
    const auto barrier =
        image_barrier(out.image.get(), VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
                      VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT, out.layout,
                      VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, layout);
    record_barriers(device, commands, &barrier, 1);
  }));
  AFTERGLOW_CHECK(submitter.wait());
  out.layout = layout;
  return out;
}

Result<DevicePicture> DevicePicture::create(const Device& device, const Picture& picture, const PictureKind& kind) {
  DevicePicture out;
  out.device_ = &device;
  constexpr VkImageUsageFlags kUsage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
  AFTERGLOW_TRY(out.inputs_["source"], upload_image(device, picture.color, kind.source, kUsage, kRest));
  for (const auto& [name, image] : picture.auxiliary) {
    AFTERGLOW_TRY(out.inputs_[name],
                  upload_image(device, image, input_format(name, image.channels, kind.source), kUsage, kRest));
  }
  const ImageDesc result{
      .name = "result",
      .size = picture.color.size(),
      .format = kind.result,
      .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | (kind.stored ? VkImageUsageFlags{VK_IMAGE_USAGE_STORAGE_BIT} : 0)};
  if (kind.stored) out.writing_ = kStored;
  AFTERGLOW_TRY(out.result_, FrameImage::create(device, result,
                                                device.maps_images() ? HostAccess::read : HostAccess::none, kind.rows));
  return out;
}

std::map<std::string, ImageBinding> DevicePicture::inputs() const {
  std::map<std::string, ImageBinding> out;
  for (const auto& [name, image] : inputs_)
    out[name] = {image.image.get(), image.image.view(), image.image.desc().format, image.image.desc().size};
  return out;
}

ImageBinding DevicePicture::source() const { return inputs().at("source"); }

ImageBinding DevicePicture::result() const {
  const GpuImage& image = result_.image;
  return {image.get(), image.view(), image.desc().format, image.desc().size, result_.rows.views()};
}

/// Every input from one layout into another.
std::vector<VkImageMemoryBarrier2> DevicePicture::turned(VkImageLayout from, VkImageLayout to) const {
  std::vector<VkImageMemoryBarrier2> barriers;
  if (from == to) return barriers;
  for (const auto& [name, image] : inputs_)
    barriers.push_back(image_barrier(image.image.get(), VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, 0, from,
                                     VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, reading_access(to), to));
  return barriers;
}

void DevicePicture::before(VkCommandBuffer commands, VkImageLayout input_layout) const {
  std::vector<VkImage> results{result_.image.get()};
  for (int k = 0; k < result_.rows.rows(); ++k) results.push_back(result_.rows.image(k));
  const VkImageLayout written = result_.rows.rows() > 1 ? VK_IMAGE_LAYOUT_GENERAL : writing_.layout;
  std::vector<VkImageMemoryBarrier2> barriers = turned(kRest, input_layout);
  for (const VkImage image : results)
    barriers.push_back(image_barrier(image, writing_.stage, writing_.access, VK_IMAGE_LAYOUT_UNDEFINED, writing_.stage,
                                     writing_.access, written));
  record_barriers(*device_, commands, barriers.data(), barriers.size());
}

void DevicePicture::after(VkCommandBuffer commands, VkImageLayout input_layout) const {
  const auto barriers = turned(input_layout, kRest);
  record_barriers(*device_, commands, barriers.data(), barriers.size());
}

}  // namespace afterglow
