// SPDX-License-Identifier: MIT
// What a swapchain is to be like, as data.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "gpu/swapchain_choice.h"

namespace afterglow {
namespace {

constexpr auto kSrgb = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;

TEST(SwapchainChoice, PrefersCodesThatShadersEncode) {
  const std::vector<VkSurfaceFormatKHR> formats{
      {VK_FORMAT_B8G8R8A8_SRGB, kSrgb},
      {VK_FORMAT_R8G8B8A8_UNORM, VK_COLOR_SPACE_HDR10_ST2084_EXT},
      {VK_FORMAT_R8G8B8A8_UNORM, kSrgb},
  };
  const auto chosen = choose_surface_format(formats);
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->format, VK_FORMAT_R8G8B8A8_UNORM);
  EXPECT_EQ(chosen->colorSpace, kSrgb);
  EXPECT_FALSE(encodes_srgb(chosen->format));
}

TEST(SwapchainChoice, TakesOneWhoseStoresEncodeWhenThereIsNoOther) {
  const std::vector<VkSurfaceFormatKHR> formats{{VK_FORMAT_B8G8R8A8_SRGB, kSrgb}};
  ASSERT_TRUE(choose_surface_format(formats));
  EXPECT_TRUE(encodes_srgb(choose_surface_format(formats)->format));
  EXPECT_FALSE(choose_surface_format(std::vector<VkSurfaceFormatKHR>{{VK_FORMAT_R16_SFLOAT, kSrgb}}));
}

TEST(SwapchainChoice, ExtentIsTheSurfacesOrTheWindowsWithinLimits) {
  VkSurfaceCapabilitiesKHR surface{.currentExtent = {640, 480}};
  EXPECT_EQ(choose_extent(surface, {100, 100}), (Size{640, 480}));
  surface.currentExtent = {0, 0};  // minimised, as Windows has it
  EXPECT_EQ(choose_extent(surface, {100, 100}).area(), 0);
  constexpr auto kOpen = std::numeric_limits<std::uint32_t>::max();
  surface.currentExtent = {kOpen, kOpen};
  surface.minImageExtent = {10, 10};
  surface.maxImageExtent = {1000, 800};
  EXPECT_EQ(choose_extent(surface, {1200, 5}), (Size{1000, 10}));
  EXPECT_EQ(choose_extent(surface, {0, 5}).area(), 0);
}

TEST(SwapchainChoice, OneImageMoreThanNeededWithinLimits) {
  EXPECT_EQ(choose_image_count({.minImageCount = 2, .maxImageCount = 0}), 3u);
  EXPECT_EQ(choose_image_count({.minImageCount = 2, .maxImageCount = 2}), 2u);
}

TEST(SwapchainChoice, WaitsForTheDisplayUnlessToldOtherwise) {
  const std::vector<VkPresentModeKHR> all{VK_PRESENT_MODE_FIFO_KHR, VK_PRESENT_MODE_MAILBOX_KHR,
                                          VK_PRESENT_MODE_IMMEDIATE_KHR};
  EXPECT_EQ(choose_present_mode(all, false), VK_PRESENT_MODE_FIFO_KHR);
  EXPECT_EQ(choose_present_mode(all, true), VK_PRESENT_MODE_IMMEDIATE_KHR);
  const std::vector<VkPresentModeKHR> fifo{VK_PRESENT_MODE_FIFO_KHR};
  EXPECT_EQ(choose_present_mode(fifo, true), VK_PRESENT_MODE_FIFO_KHR);
}

}  // namespace
}  // namespace afterglow
