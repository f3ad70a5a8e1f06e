// SPDX-License-Identifier: MIT
// Files of the caches: compiled kernels and pipelines. The first byte chooses whether the bytes are taken as they are,
// or get the header and the hash that let them through to what stands behind.
#include <cstring>

#include "fuzz.h"
#include "gpu/pipeline_cache.h"
#include "shader/kernel_file.h"

using namespace afterglow;

namespace {

/// The bytes as the content of a kernel file, with a header that fits them.
std::string sealed(const std::string& content) {
  const Hash hash = hash_text(content);
  const std::string model = encode({});
  std::string out = model.substr(0, 8);  // magic, version
  const std::uint64_t numbers[] = {content.size(), hash.high, hash.low};
  out.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
  return out + content;
}

void check_kernel(const std::string& bytes) {
  const auto kernel = decode(bytes);
  if (!kernel) return;
  FUZZ_CLAIM(kernel->spirv.size() * 4 <= bytes.size() && kernel->offsets.size() * 4 <= bytes.size(), "");
  const std::string again = encode(*kernel);
  const auto twice = decode(again);
  FUZZ_CLAIM(
      twice && twice->spirv == kernel->spirv && twice->offsets == kernel->offsets && again.size() == bytes.size(), "");
}

void check_pipelines(const std::string& bytes) {
  VkPhysicalDeviceProperties device{};
  device.vendorID = 0x10005;
  const auto file = fuzz::write("pipelines.bin", bytes);
  const std::string data = read_pipeline_cache(file.string(), device);
  if (data.empty()) return;
  VkPipelineCacheHeaderVersionOne header{};
  FUZZ_CLAIM(data.size() >= sizeof header, "");
  std::memcpy(&header, data.data(), sizeof header);
  FUZZ_CLAIM(header.vendorID == device.vendorID, "");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string bytes(fuzz::text_of(data + 1, size - 1));
  const bool seal = data[0] % 2 == 1;
  check_kernel(seal ? sealed(bytes) : bytes);
  check_pipelines(seal ? pipeline_cache_file_content(bytes) : bytes);
  return 0;
}
