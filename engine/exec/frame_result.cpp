// SPDX-License-Identifier: MIT
#include "exec/frame_result.h"

#include <algorithm>
#include <atomic>
#include <cstring>

#include "core/large_pages.h"
#include "exec/convert.h"

namespace afterglow {

ImageDesc FrameResult::wanted_by(const Program& program) {
  const VkImageUsageFlags stored = program.stores_result() ? VK_IMAGE_USAGE_STORAGE_BIT : 0;
  return {.name = "result",
          .size = program.graph().images[program.graph().result].size,
          .format = program.result_format(),
          .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | stored};
}

Result<void> FrameResult::take(const ImageDesc& desc, int rows) {
  writing_ = desc.usage & VK_IMAGE_USAGE_STORAGE_BIT ? kStored : Writing{};
  std::erase_if(others_, [&](const auto& other) { return !other.second.fits(desc, other.first); });
  if (image_.fits(desc, rows)) return {};
  const int has = std::max(image_.rows.rows(), 1);
  if (has != rows && image_.fits(desc, has)) {
    others_[has] = std::move(image_);
    image_ = std::move(others_[rows]);
    others_.erase(rows);
    if (image_.fits(desc, rows)) return {};
  }
  image_ = {};  // before the new one is made: the two need not exist at once
  AFTERGLOW_TRY(image_, FrameImage::create(*device_, desc, direct_ ? HostAccess::read : HostAccess::none, rows));
  ++made_;
  return {};
}

std::vector<VkImage> FrameResult::images() const {
  std::vector<VkImage> all{image_.image.get()};
  for (int k = 0; k < image_.rows.rows(); ++k) all.push_back(image_.rows.image(k));
  return all;
}

VkImageLayout FrameResult::writing_layout() const {
  return image_.rows.rows() > 1 ? VK_IMAGE_LAYOUT_GENERAL : writing_.layout;
}

void FrameResult::before(VkCommandBuffer commands) {
  std::vector<VkImageMemoryBarrier2> barriers;
  for (const VkImage image : images())
    barriers.push_back(image_barrier(image, writing_.stage | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, 0,
                                     VK_IMAGE_LAYOUT_UNDEFINED, writing_.stage, writing_.access, writing_layout()));
  record_barriers(*device_, commands, barriers.data(), barriers.size());
}

void FrameResult::after(VkCommandBuffer commands) {
  const bool general = image_.direct || image_.rows.rows() > 1;
  image_.layout = general ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  std::vector<VkImageMemoryBarrier2> barriers;
  for (const VkImage image : images())
    barriers.push_back(image_barrier(image, writing_.stage, writing_.access, writing_layout(), shown_stage(image_),
                                     shown_access(image_, VK_ACCESS_2_HOST_READ_BIT), image_.layout));
  record_barriers(*device_, commands, barriers.data(), barriers.size());
}

/// Calls `row` for every row of that part, with its first pixel there, and sums up what it returns.
Result<std::uint64_t> FrameResult::over_rows_of(Staging& staging, const Rect& part,
                                                const std::function<std::uint64_t(int y, const std::byte* from)>& row) {
  const std::size_t left = static_cast<std::size_t>(part.x) * bytes_per_pixel(image_.image.desc().format);
  const auto inside = [&](int y, const std::byte* from) -> std::uint64_t {
    return y < part.y || y >= part.y + part.height ? 0 : row(y, from + left);
  };
  if (!image_.direct) return staging.download(staged(image_), image_.layout, inside, part.y, part.y + part.height);
  AFTERGLOW_CHECK(image_.image.memory().invalidate());
  return over_rows(part.height, image_.image.row_pitch(),
                   [&](int y) { return row(part.y + y, image_.image.row(part.y + y) + left); });
}

Result<void> FrameResult::begin_download(Staging& staging, const Rect& part) {
  if (image_.direct) return {};
  return staging.begin_download(staged(image_), image_.layout, part.y, part.y + part.height);
}

Result<std::uint64_t> FrameResult::download(Staging& staging, const Rect& part, HostResult& out, bool flags) {
  std::atomic<bool> flagged = false;
  const auto look = [&](const std::byte* from, VkFormat of) {
    if (flags && any_alpha_zero(from, of, part.width)) flagged.store(true, std::memory_order_relaxed);
  };
  AFTERGLOW_TRY(const std::uint64_t held, download_looking(staging, part, out, look));
  out.flagged = flagged.load();
  return held;
}

Result<std::uint64_t> FrameResult::download_looking(Staging& staging, const Rect& part, HostResult& out,
                                                    const LookAtRow& look) {
  const auto [width, height] = image_.image.desc().size;
  const VkFormat format = image_.image.desc().format;
  const auto row_values = static_cast<std::size_t>(width) * 4;
  const auto first = [&](int y) {
    return row_values * static_cast<std::size_t>(y) + static_cast<std::size_t>(part.x) * 4;
  };
  if (out.write_row || format != VK_FORMAT_R8G8B8A8_UNORM) out.unorm8.clear();  // its memory stays
  if (out.write_row)
    return over_rows_of(staging, part, [&](int y, const std::byte* from) {
      look(from, format);
      return out.write_row(part.x, y, part.width, format, from);
    });
  if (format == VK_FORMAT_R8G8B8A8_UNORM) {
    resize_for_picture(out.unorm8, row_values * static_cast<std::size_t>(height));
    return over_rows_of(staging, part, [&](int y, const std::byte* from) {
      look(from, format);
      std::memcpy(out.unorm8.data() + first(y), from, static_cast<std::size_t>(part.width) * 4);
      return std::uint64_t{0};
    });
  }
  const auto values = row_values * static_cast<std::size_t>(height);
  const bool keep_alpha = out.keep_alpha && out.pixels.size() == values;
  if (out.pixels.size() != values) resize_for_picture(out.pixels, values);
  return over_rows_of(staging, part, [&](int y, const std::byte* from) {
    look(from, format);
    float* to = out.pixels.data() + first(y);
    return keep_alpha ? unpack_row_rgb(from, format, part.width, to) : unpack_row(from, format, part.width, to);
  });
}

}  // namespace afterglow
