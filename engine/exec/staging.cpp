// SPDX-License-Identifier: MIT
#include "exec/staging.h"

#include <algorithm>
#include <utility>

#include "core/exception.h"
#include "exec/convert.h"

namespace afterglow {

namespace {

/// Large enough that a submission costs little beside its copy, small beside a 4K picture (127 MiB).
constexpr VkDeviceSize kBandBytes = 8u << 20;
/// Of whole pictures: one band for nearly all of them, which all threads convert at once; what a device gives in one
/// piece has a limit.
constexpr VkDeviceSize kWholeBandBytes = 512u << 20;

VkDeviceSize row_bytes(const StagedImage& image) {
  return static_cast<VkDeviceSize>(image.size.width) * bytes_per_pixel(image.format);
}

VkBufferImageCopy copy_of(const StagedImage& image, int first_row, int rows) {
  return {.bufferOffset = 0,
          .bufferRowLength = 0,
          .bufferImageHeight = 0,
          .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
          .imageOffset = {0, first_row, 0},
          .imageExtent = {static_cast<std::uint32_t>(image.size.width), static_cast<std::uint32_t>(rows), 1}};
}

constexpr auto kTransfer = VK_PIPELINE_STAGE_2_COPY_BIT;
constexpr auto kShader = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;

}  // namespace

int Staging::rows_per_band(const StagedImage& image) const {
  const auto fit = static_cast<int>(std::clamp<VkDeviceSize>((whole_ ? kWholeBandBytes : kBandBytes) / row_bytes(image),
                                                             1, static_cast<VkDeviceSize>(image.size.height)));
  if (!whole_) return fit;
  const int bands = (image.size.height + fit - 1) / fit;
  return (image.size.height + bands - 1) / bands;  // as many in each
}

int Staging::bands_for(const StagedImage& image) const {
  constexpr int kTurns = 2;
  const int rows = rows_per_band(image);
  return whole_ ? (image.size.height + rows - 1) / rows : kTurns;
}

VkDeviceSize Staging::bytes(const StagedImage& image) const {
  return static_cast<VkDeviceSize>(bands_for(image)) * row_bytes(image) *
         static_cast<VkDeviceSize>(rows_per_band(image));
}

Result<void> Staging::prepare(Bands& bands, std::size_t first, const StagedImage& image, HostAccess access) {
  const VkDeviceSize size = row_bytes(image) * static_cast<VkDeviceSize>(rows_per_band(image));
  const std::size_t end = first + static_cast<std::size_t>(bands_for(image));
  if (bands.size() < end) bands.resize(end);
  for (std::size_t i = first; i < end; ++i) {
    Band& band = bands[i];
    if (band.buffer.size() >= size) continue;
    if (band.buffer.size() == 0) {
      AFTERGLOW_TRY(band.submitter, Submitter::create(*device_));
    }
    AFTERGLOW_CHECK(band.submitter.wait());
    const VkBufferUsageFlags usage =
        access == HostAccess::write ? VK_BUFFER_USAGE_TRANSFER_SRC_BIT : VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    AFTERGLOW_TRY(band.buffer, Buffer::create(*device_, size, usage, access, "staging"));
    ++buffers_;
  }
  return {};
}

Result<void> Staging::wait() {
  Result<void> done;
  for (auto* bands : {&uploads_, &downloads_})
    for (auto& band : *bands) {
      auto waited = band.submitter.wait();
      if (done && !waited) done = std::move(waited);
      band.rows = 0;
    }
  begun_ = false;
  return done;
}

Result<std::uint64_t> Staging::upload(const StagedImage& image, const PackRow& pack) {
  const std::size_t first_band = whole_ ? next_ : 0;
  AFTERGLOW_CHECK(prepare(uploads_, first_band, image, HostAccess::write));
  const auto count = static_cast<std::size_t>(bands_for(image));
  next_ = first_band + count;
  std::size_t turn = 0;
  const int step = rows_per_band(image);
  std::uint64_t held = 0;
  for (int first = 0; first < image.size.height; first += step, turn = (turn + 1) % count) {
    Band& band = uploads_[first_band + turn];
    const int rows = std::min(step, image.size.height - first);
    AFTERGLOW_CHECK(band.submitter.wait());
    held += over_rows(rows, row_bytes(image),
                      [&](int y) { return pack(first + y, band.buffer.data() + y * row_bytes(image)); });
    AFTERGLOW_CHECK(band.buffer.memory().flush());
    const bool is_first = first == 0, is_last = first + rows == image.size.height;
    AFTERGLOW_CHECK(band.submitter.submit([&](VkCommandBuffer commands) {
      if (is_first) {
        const auto begin = image_barrier(image.image, kShader, 0, VK_IMAGE_LAYOUT_UNDEFINED, kTransfer,
                                         VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        record_barriers(*device_, commands, &begin, 1);
      }
      const VkBufferImageCopy region = copy_of(image, first, rows);
      device_->vk().vkCmdCopyBufferToImage(commands, band.buffer.get(), image.image,
                                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
      if (is_last) {
        const auto end =
            image_barrier(image.image, kTransfer, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                          kShader, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        record_barriers(*device_, commands, &end, 1);
      }
    }));
  }
  if (whole_) return held;
  for (auto& band : uploads_) AFTERGLOW_CHECK(band.submitter.wait());
  return held;
}

Result<void> Staging::submit_download(Band& band, const StagedImage& image, VkImageLayout layout, int first, int from,
                                      int to) {
  const int rows = std::min(rows_per_band(image), to - first);
  const bool is_first = first == from, is_last = first + rows == to;
  AFTERGLOW_CHECK(band.submitter.submit([&](VkCommandBuffer commands) {
    if (is_first) {
      const auto begin = image_barrier(image.image, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT | kShader,
                                       VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, layout, kTransfer,
                                       VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
      record_barriers(*device_, commands, &begin, 1);
    }
    const VkBufferImageCopy region = copy_of(image, first, rows);
    device_->vk().vkCmdCopyImageToBuffer(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, band.buffer.get(),
                                         1, &region);
    record_to_host(*device_, commands, kTransfer, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    if (!is_last) return;
    const auto end = image_barrier(image.image, kTransfer, 0, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                   VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT | kShader, 0, layout);
    record_barriers(*device_, commands, &end, 1);
  }));
  band.first_row = first;
  band.rows = rows;
  return {};
}

Result<void> Staging::begin_download(const StagedImage& image, VkImageLayout layout, int from, int to) {
  AFTERGLOW_CHECK(prepare(downloads_, 0, image, HostAccess::read));
  std::size_t turn = 0;
  for (int first = from; first < to; first += rows_per_band(image))
    AFTERGLOW_CHECK(submit_download(downloads_[turn++], image, layout, first, from, to));
  begun_ = true;
  return {};
}

Result<std::uint64_t> Staging::download(const StagedImage& image, VkImageLayout layout, const UnpackRow& unpack,
                                        int from, int to) {
  auto held = without_exceptions([&] { return move_back(image, layout, unpack, from, to); });
  if (!held) (void)wait();
  return held;
}

Result<std::uint64_t> Staging::move_back(const StagedImage& image, VkImageLayout layout, const UnpackRow& unpack,
                                         int from, int to) {
  std::uint64_t held = 0;
  const auto take = [&](Band& band) -> Result<void> {
    if (band.rows == 0) return {};
    AFTERGLOW_CHECK(band.submitter.wait());
    AFTERGLOW_CHECK(band.buffer.memory().invalidate());
    held += over_rows(band.rows, row_bytes(image),
                      [&](int y) { return unpack(band.first_row + y, band.buffer.data() + y * row_bytes(image)); });
    band.rows = 0;
    return {};
  };
  std::size_t turn = 0;
  if (!std::exchange(begun_, false)) {
    AFTERGLOW_CHECK(prepare(downloads_, 0, image, HostAccess::read));
    const auto count = static_cast<std::size_t>(bands_for(image));
    for (int first = from; first < to; first += rows_per_band(image), turn = (turn + 1) % count) {
      AFTERGLOW_CHECK(take(downloads_[turn]));
      AFTERGLOW_CHECK(submit_download(downloads_[turn], image, layout, first, from, to));
    }
    if (turn >= downloads_.size()) turn = 0;
  }
  for (std::size_t i = 0; i < downloads_.size(); ++i) AFTERGLOW_CHECK(take(downloads_[(turn + i) % downloads_.size()]));
  return held;
}

}  // namespace afterglow
