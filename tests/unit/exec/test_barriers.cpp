// SPDX-License-Identifier: MIT
// Hazards between kernels, checked as data: synchronization validation does not see those between images that share
// memory.
#include <gtest/gtest.h>

#include <map>

#include "exec/barriers.h"

namespace afterglow {
namespace {

constexpr auto kShader = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
constexpr auto kOutput = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;

VkImage handle(ImageId id) { return reinterpret_cast<VkImage>(static_cast<std::uintptr_t>(id + 100)); }

/// Image 0 is the source, image `result` the caller's; kernel k makes image k + 1 and reads `read[k]`.
struct Example {
  Plan plan;
  std::vector<std::vector<ImageId>> read;
  ImageId result;
  VkImage image_of(ImageId id) const { return id == 0 || id == result ? VK_NULL_HANDLE : handle(id); }
  std::vector<KernelBarriers> barriers() const {
    return kernel_barriers(
        plan, read, [this](ImageId id) { return image_of(id); }, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  }
};

Example example() {
  Example e;
  e.read = {{0}, {1, 0}, {2, 1}, {3, 2}, {1, 4, 0}};
  for (int k = 0; k < 5; ++k) e.plan.kernels.push_back({{k}, "k" + std::to_string(k), k + 1});
  e.result = 5;
  return e;
}

TEST(KernelBarriers, EveryReadOfATargetComesBehindABarrierThatShowsItsWrites) {
  const Example e = example();
  const auto barriers = e.barriers();
  std::map<VkImage, VkImageLayout> layout;
  for (std::size_t k = 0; k < e.read.size(); ++k) {
    for (const auto& barrier : barriers[k].images) {
      if (barrier.newLayout == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL) {
        EXPECT_EQ(barrier.oldLayout, layout.at(barrier.image)) << "a target must be drawn before it is read";
        EXPECT_TRUE(barrier.srcStageMask & kOutput);
        EXPECT_TRUE(barrier.srcAccessMask & VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
        EXPECT_TRUE(barrier.dstStageMask & kShader);
        EXPECT_TRUE(barrier.dstAccessMask & VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
      }
      layout[barrier.image] = barrier.newLayout;
    }
    for (const ImageId id : e.read[k]) {
      if (!e.image_of(id)) continue;
      EXPECT_EQ(layout.at(e.image_of(id)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL) << k;
    }
    const VkImage target = e.image_of(e.plan.kernels[k].output);
    if (!target) continue;
    EXPECT_EQ(layout.at(target), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL) << k;
  }
}

TEST(KernelBarriers, DrawingWaitsForAllReadersBefore) {
  // Whatever memory a target shares, and with whom: its barrier waits for every read and every write of kernels before.
  const Example e = example();
  const auto barriers = e.barriers();
  for (std::size_t k = 0; k + 1 < e.read.size(); ++k) {
    int found = 0;
    for (const auto& barrier : barriers[k].images) {
      if (barrier.image != handle(e.plan.kernels[k].output)) continue;
      ++found;
      EXPECT_EQ(barrier.oldLayout, VK_IMAGE_LAYOUT_UNDEFINED);
      EXPECT_EQ(barrier.srcStageMask & (kShader | kOutput), kShader | kOutput);
      EXPECT_TRUE(barrier.srcAccessMask & VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
      EXPECT_TRUE(barrier.dstStageMask & kOutput);
      EXPECT_TRUE(barrier.dstAccessMask & VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
    }
    EXPECT_EQ(found, 1) << k;
  }
}

TEST(KernelBarriers, NoneForTheCallersImagesAndNoneTwice) {
  const Example e = example();
  const auto barriers = e.barriers();
  std::map<VkImage, int> to_read;
  for (const auto& before : barriers) {
    for (const auto& barrier : before.images) {
      EXPECT_NE(barrier.image, handle(0));
      EXPECT_NE(barrier.image, handle(e.result));
      if (barrier.newLayout == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL) ++to_read[barrier.image];
    }
  }
  EXPECT_EQ(to_read.size(), 4u);
  for (const auto& [image, count] : to_read) EXPECT_EQ(count, 1);
}

}  // namespace
}  // namespace afterglow
