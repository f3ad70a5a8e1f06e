// SPDX-License-Identifier: MIT
// Draws the view on lavapipe and holds it to the same mathematics in double precision.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "exec/submit.h"
#include "gpu/image.h"
#include "image/encode.h"
#include "view_oracle.h"
#include "window/view_pass.h"

namespace afterglow {

inline constexpr VkFormat kTarget = VK_FORMAT_R32G32B32A32_SFLOAT;

/// Smooth, with noise, a few values out of range and a few that are not finite.
inline Image picture(Size size, unsigned seed) {
  Image out(size.width, size.height, 4);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> noise(0, 1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      float* c = out.at(x, y);
      c[0] = 0.9f * static_cast<float>(x) / static_cast<float>(size.width);
      c[1] = 0.9f * static_cast<float>(y) / static_cast<float>(size.height);
      c[2] = 0.7f * noise(random);
      c[3] = noise(random);
    }
  }
  out.at(3, 2)[0] = 5;
  out.at(7, 5)[1] = -0.25f;
  out.at(9, 9)[2] = std::numeric_limits<float>::quiet_NaN();
  out.at(12, 4)[0] = std::numeric_limits<float>::infinity();
  out.at(1, 11)[3] = -1;
  return out;
}

class ViewPassTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    Diagnostics diagnostics;
    auto made = Device::create({.validate = true}, diagnostics);
    ASSERT_TRUE(made) << made.error().text();
    device_ = std::move(*made).release();
  }
  static void TearDownTestSuite() {
    const auto log = device_->validation_log();
    delete device_;
    EXPECT_EQ(log->errors(), 0) << (log->messages().empty() ? "" : log->messages().front());
  }

  static GpuImage upload(const Image& image, bool half = false) {
    auto made = GpuImage::create(*device_,
                                 {.name = "picture",
                                  .size = image.size(),
                                  .format = float_format(4, half),
                                  .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                  .tiling = VK_IMAGE_TILING_LINEAR},
                                 HostAccess::write);
    EXPECT_TRUE(made) << made.error().text();
    for (int y = 0; y < image.height; ++y) {
      const auto values = static_cast<std::size_t>(image.width) * 4;
      if (half) {
        to_half(image.at(0, y), reinterpret_cast<std::uint16_t*>(made->row(y)), values);
      } else {
        std::memcpy(made->row(y), image.at(0, y), values * sizeof(float));
      }
    }
    EXPECT_TRUE(made->memory().flush());
    return std::move(*made);
  }

  static Image draw(const ViewFrame& frame, Size target_size, const std::vector<VkImage>& sources,
                    VkFormat format = kTarget) {
    auto target =
        GpuImage::create(*device_, {.name = "target",
                                    .size = target_size,
                                    .format = format,
                                    .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    EXPECT_TRUE(target) << target.error().text();
    const auto bytes = static_cast<VkDeviceSize>(target_size.area()) * 16;
    auto buffer = Buffer::create(*device_, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HostAccess::read, "pixels");
    auto pass = ViewPass::create(*device_, format, 1);
    EXPECT_TRUE(pass) << pass.error().text();
    if (display_) {
      EXPECT_TRUE((*pass)->take_table(*display_));
    }
    auto submitter = Submitter::create(*device_);
    EXPECT_TRUE(submitter->submit(
        [&](VkCommandBuffer commands) { record(commands, **pass, frame, target_size, *target, *buffer, sources); }));
    EXPECT_TRUE(submitter->wait());
    EXPECT_TRUE(buffer->memory().invalidate());
    Image out(target_size.width, target_size.height, 4);
    std::memcpy(out.pixels.data(), buffer->data(), out.bytes());
    return out;
  }

  static void record(VkCommandBuffer commands, ViewPass& pass, const ViewFrame& frame, Size size,
                     const GpuImage& target, const Buffer& buffer, const std::vector<VkImage>& sources) {
    std::vector<VkImageMemoryBarrier2> before;
    for (VkImage source : sources) {
      before.push_back(image_barrier(source, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_WRITE_BIT,
                                     VK_IMAGE_LAYOUT_PREINITIALIZED, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                     VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL));
    }
    before.push_back(image_barrier(target.get(), VK_PIPELINE_STAGE_2_NONE, 0, VK_IMAGE_LAYOUT_UNDEFINED,
                                   VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL));
    record_barriers(*device_, commands, before.data(), before.size());
    // In two parts, which meet where no tile ends.
    const std::array<Rect, 2> all{
        {{0, 0, size.width / 3, size.height}, {size.width / 3, 0, size.width - size.width / 3, size.height}}};
    const auto copied = pass.prepare(commands, 0, copies_ ? target.get() : VK_NULL_HANDLE, {&frame, 1}, all);
    ASSERT_TRUE(copied) << copied.error().text();
    copied_ = *copied;
    const VkRenderingAttachmentInfo color{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                          .imageView = target.view(),
                                          .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                          .loadOp = copied_ ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR,
                                          .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                          .clearValue = {.color = {.float32 = {-1, -1, -1, -1}}}};
    const VkExtent2D extent{static_cast<std::uint32_t>(size.width), static_cast<std::uint32_t>(size.height)};
    const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                    .renderArea = {{0, 0}, extent},
                                    .layerCount = 1,
                                    .colorAttachmentCount = 1,
                                    .pColorAttachments = &color};
    device_->vk().vkCmdBeginRendering(commands, &rendering);
    EXPECT_TRUE(pass.record(commands, 0, {&frame, 1}, all, {-1, -1, -1}));
    device_->vk().vkCmdEndRendering(commands);
    const auto into = image_barrier(target.get(), VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                    VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                    VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                                    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    record_barriers(*device_, commands, &into, 1);
    const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                 .imageExtent = {extent.width, extent.height, 1}};
    device_->vk().vkCmdCopyImageToBuffer(commands, target.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer.get(), 1,
                                         &copy);
    const VkMemoryBarrier2 to_host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                   .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                   .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                   .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                   .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &to_host};
    device_->vk().vkCmdPipelineBarrier2(commands, &dependency);
  }

  /// Draws and compares each pixel of the area. How many pixels were neither the surroundings nor equal to all others.
  static void expect_same(ViewFrame frame, const Image& shown, const Image* compared, Size target, const char* what) {
    const GpuImage gpu_shown = upload(shown);
    const GpuImage gpu_compared = compared ? upload(*compared) : GpuImage();
    std::vector<VkImage> sources{gpu_shown.get()};
    frame.shown = {gpu_shown.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, shown.size()};
    if (compared) {
      frame.compared = ViewImage{gpu_compared.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, compared->size()};
      sources.push_back(gpu_compared.get());
    }
    const Image drawn = draw(frame, target, sources);
    const ViewOracle oracle(frame, shown, compared, display_);
    int wrong = 0, inside = 0;
    for (int y = 0; y < target.height; ++y) {
      for (int x = 0; x < target.width; ++x) {
        const float* got = drawn.at(x, y);
        const Rect& a = frame.area;
        if (x < a.x || y < a.y || x >= a.x + a.width || y >= a.y + a.height) {
          ASSERT_EQ(got[0], -1) << what << ": drawn outside of the area at " << x << ", " << y;
          continue;
        }
        const Rgb want = oracle.at(x, y);
        ++inside;
        for (int i = 0; i < 3; ++i) {
          if (std::abs(got[i] - want[i]) <= 2e-4) continue;
          if (++wrong <= 5) {
            ADD_FAILURE() << what << ": pixel " << x << ", " << y << " channel " << i << " is " << got[i] << ", not "
                          << want[i];
          }
        }
        ASSERT_EQ(got[3], 1);
      }
    }
    EXPECT_EQ(wrong, 0) << what;
    EXPECT_EQ(inside, frame.area.width * frame.area.height);
  }

  /// Pictures that the processor may read, on targets that it can copy to. `compared` may be null.
  static void expect_codes(ViewFrame frame, const Image& shown, const Image* compared, Size target, VkFormat format,
                           bool half, bool by_processor) {
    const GpuImage gpu_shown = upload(shown, half);
    const GpuImage gpu_compared = compared ? upload(*compared, half) : GpuImage();
    const auto view_of = [&](const GpuImage& image) {
      return ViewImage{.view = image.view(),
                       .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       .size = image.desc().size,
                       .pixels = image.row(0),
                       .row_pitch = image.row_pitch(),
                       .half = half};
    };
    std::vector<VkImage> sources{gpu_shown.get()};
    frame.shown = view_of(gpu_shown);
    if (compared) {
      frame.compared = view_of(gpu_compared);
      sources.push_back(gpu_compared.get());
    }
    copies_ = true;
    const Image drawn = draw(frame, target, sources, format);
    copies_ = false;
    EXPECT_EQ(copied_, by_processor);
    copied_ = false;
    const ViewOracle oracle(frame, shown, compared, display_);
    const auto* codes = reinterpret_cast<const std::uint8_t*>(drawn.pixels.data());
    const bool blue_first = format == VK_FORMAT_B8G8R8A8_UNORM;
    int wrong = 0;
    for (int y = 0; y < target.height; ++y)
      for (int x = 0; x < target.width; ++x, codes += 4) {
        const Rgb want = oracle.at(x, y);
        for (std::size_t i = 0; i < 3; ++i) {
          const int got = codes[blue_first ? 2 - i : i];
          if (std::abs(got - 255 * want[i]) <= 0.5 + (half ? 0.07 : 0.01)) continue;
          if (++wrong <= 5) ADD_FAILURE() << x << ", " << y << " channel " << i << ": " << got << ", " << 255 * want[i];
        }
        ASSERT_EQ(codes[3], 255);
      }
    EXPECT_EQ(wrong, 0);
  }

  static inline Device* device_ = nullptr;
  static inline const DisplayTable* display_ = nullptr;  ///< that the pass is given
  static inline bool copies_ = false;                    ///< the pass may copy into the target
  static inline bool copied_ = false;                    ///< and did
};

}  // namespace afterglow
