// SPDX-License-Identifier: MIT
// Which memory type is taken: as data, for kinds of machine that a test does not run on.
#include <gtest/gtest.h>

#include "gpu/memory.h"

namespace afterglow {
namespace {

constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
constexpr VkMemoryPropertyFlags kVisible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
constexpr VkMemoryPropertyFlags kCoherent = VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
constexpr std::uint32_t kAll = ~0u;

VkPhysicalDeviceMemoryProperties machine(std::initializer_list<VkMemoryPropertyFlags> types) {
  VkPhysicalDeviceMemoryProperties out{};
  for (const auto flags : types) out.memoryTypes[out.memoryTypeCount++].propertyFlags = flags;
  return out;
}

TEST(MemoryType, OnAGraphicsCard) {
  const auto card =
      machine({0, kLocal, kVisible | kCoherent, kVisible | kCoherent | kCached, kLocal | kVisible | kCoherent});
  EXPECT_EQ(find_memory_type(card, kAll, HostAccess::none), 1u);
  EXPECT_EQ(find_memory_type(card, kAll, HostAccess::write), 2u);
  EXPECT_EQ(find_memory_type(card, kAll, HostAccess::read), 3u);
}

TEST(MemoryType, OnlyAllowedTypesAreTaken) {
  const auto card = machine({kLocal, kVisible | kCoherent, kVisible | kCoherent | kCached});
  EXPECT_EQ(find_memory_type(card, 0b110, HostAccess::none), 1u);  // better than nothing
  EXPECT_EQ(find_memory_type(card, 0b010, HostAccess::read), 1u);  // not cached, but visible
  EXPECT_EQ(find_memory_type(card, 0b001, HostAccess::read), std::nullopt);
  EXPECT_EQ(find_memory_type(card, 0, HostAccess::none), std::nullopt);
}

TEST(MemoryType, CachedIsWorthMoreThanCoherentForReading) {
  const auto phone = machine({kLocal, kVisible | kCoherent, kVisible | kCached});
  EXPECT_EQ(find_memory_type(phone, kAll, HostAccess::read), 2u);
  EXPECT_EQ(find_memory_type(phone, kAll, HostAccess::write), 1u);
  EXPECT_EQ(find_memory_type(machine({kLocal, kVisible | kCached}), kAll, HostAccess::write), 1u);
}

TEST(MemoryType, WhatNeedsMoreThanAskingIsNeverTaken) {
  const auto odd =
      machine({kLocal | VK_MEMORY_PROPERTY_PROTECTED_BIT, kLocal | VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT, kLocal});
  EXPECT_EQ(find_memory_type(odd, kAll, HostAccess::none), 2u);
  EXPECT_EQ(find_memory_type(odd, 0b011, HostAccess::none), std::nullopt);
  constexpr VkMemoryPropertyFlags kAmd =
      VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD | VK_MEMORY_PROPERTY_DEVICE_UNCACHED_BIT_AMD;
  const auto amd = machine({kLocal, kVisible | kCoherent, kLocal | kAmd, kVisible | kCoherent | kAmd});
  EXPECT_EQ(find_memory_type(amd, 0b1100, HostAccess::none), std::nullopt) << "when all others are full";
  EXPECT_EQ(find_memory_type(amd, 0b1100, HostAccess::write), std::nullopt);
}

}  // namespace
}  // namespace afterglow
