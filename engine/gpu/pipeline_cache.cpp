// SPDX-License-Identifier: MIT
#include "gpu/pipeline_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <vector>

#include "core/cache_folder.h"
#include "core/file.h"
#include "core/hash.h"
#include "gpu/device.h"

namespace afterglow {

namespace {

constexpr std::size_t kHashDigits = 32;
constexpr std::size_t kMaxCacheBytes = 64u << 20;

/// VkPipelineCacheHeaderVersionOne as a file may hold it: any version, where Vulkan's enumeration knows one.
struct StoredHeader {
  std::uint32_t size, version, vendor, device;
  std::array<std::uint8_t, VK_UUID_SIZE> uuid;
};
static_assert(sizeof(StoredHeader) == sizeof(VkPipelineCacheHeaderVersionOne));

}  // namespace

std::string pipeline_cache_file_content(const std::string& data) { return hash_text(data).hex() + data; }

std::string read_pipeline_cache(const std::string& file, const VkPhysicalDeviceProperties& device) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return {};
  auto content = read_file(file, kMaxCacheBytes);
  if (!content || content->size() < kHashDigits + sizeof(StoredHeader)) return {};
  std::string data = content->substr(kHashDigits);
  if (hash_text(data).hex() != content->substr(0, kHashDigits)) return {};
  StoredHeader header{};
  std::memcpy(&header, data.data(), sizeof header);
  const bool ours = header.version == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.vendor == device.vendorID &&
                    header.device == device.deviceID && std::ranges::equal(header.uuid, device.pipelineCacheUUID);
  return ours ? data : std::string{};
}

void Device::use_pipeline_cache(const std::string& folder) {
  std::string uuid;
  for (const auto byte : properties_.pipelineCacheUUID) uuid += fmt::format("{:02x}", byte);
  std::string file = (std::filesystem::path(folder) / fmt::format("pipelines-{}.bin", uuid)).string();
  const std::lock_guard lock(cache_mutex_);
  if (file == cache_file_) return;  // loaded; others may be making pipelines with it
  cache_file_ = std::move(file);
  const std::string data = read_pipeline_cache(cache_file_, properties_);
  if (data.empty()) return;
  note_cache_use(cache_file_);
  const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                       .initialDataSize = data.size(),
                                       .pInitialData = data.data()};
  VkPipelineCache loaded = VK_NULL_HANDLE;
  if (functions_.vkCreatePipelineCache(device_, &info, nullptr, &loaded) != VK_SUCCESS) return;
  if (functions_.vkMergePipelineCaches(device_, pipeline_cache_, 1, &loaded) == VK_SUCCESS) cached_bytes_ = data.size();
  functions_.vkDestroyPipelineCache(device_, loaded, nullptr);
}

void Device::save_pipeline_cache() const {
  const std::lock_guard lock(cache_mutex_);
  if (cache_file_.empty()) return;
  std::size_t size = 0;
  if (functions_.vkGetPipelineCacheData(device_, pipeline_cache_, &size, nullptr) != VK_SUCCESS) return;
  // Caches only grow: the same size means that nothing was added. A bare header (lavapipe's) is not worth a file.
  if (size == cached_bytes_ || size <= sizeof(StoredHeader)) return;
  std::string data(size, '\0');
  if (functions_.vkGetPipelineCacheData(device_, pipeline_cache_, &size, data.data()) != VK_SUCCESS) return;
  data.resize(size);
  std::error_code ignored;
  // Vulkan takes nothing out of a cache: one that has grown too large goes, and the next process begins it with what it
  // uses.
  if (data.size() + kHashDigits > kMaxCacheBytes) {
    std::filesystem::remove(cache_file_, ignored);
    return;
  }
  std::filesystem::create_directories(std::filesystem::path(cache_file_).parent_path(), ignored);
  // A cache that cannot be written costs time only.
  (void)write_file_atomically(cache_file_, pipeline_cache_file_content(data));
  cached_bytes_ = data.size();
  trim_cache(std::filesystem::path(cache_file_).parent_path(), ".bin");  // of drivers that are gone
}

}  // namespace afterglow
