// SPDX-License-Identifier: MIT
// Runs one compiled kernel on a device and reads the target back: enough to compare kernels with formulas.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <tuple>
#include <vector>

#include "core/geometry.h"
#include "gpu/device.h"
#include "shader/kernel.h"

namespace afterglow {

struct TestImage {
  Size size;
  std::vector<float> rgba;
  const float* at(int x, int y) const { return &rgba[(static_cast<std::size_t>(y) * size.width + x) * 4]; }
  float* at(int x, int y) { return &rgba[(static_cast<std::size_t>(y) * size.width + x) * 4]; }
};

/// Values of 0…3, always the same of a seed.
inline TestImage random_texels(Size size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(0.0f, 3.0f);
  TestImage image{size, std::vector<float>(static_cast<std::size_t>(size.area()) * 4)};
  for (float& v : image.rgba) v = value(random);
  return image;
}

class KernelRunner {
 public:
  /// With validation; a failure is a failure of the test.
  KernelRunner();
  ~KernelRunner();

  /// `images` in the order of the kernel's slots; `block` is the uniform block. The target is RGBA32F, or RGBA16F for
  /// half storage.
  TestImage run(const CompiledKernel& kernel, const std::vector<TestImage>& images, Size target,
                const std::vector<std::byte>& block = {}, bool half_target = false);
  int validation_errors() const { return device_->validation_errors(); }

 private:
  struct Pipeline;
  const Pipeline& pipeline(const CompiledKernel& kernel, VkFormat format);

  std::unique_ptr<Device> device_;
  std::map<std::tuple<Hash, VkFormat, bool>, std::unique_ptr<Pipeline>> pipelines_;  // after the device: destroyed before it
  VkCommandPool pool_ = VK_NULL_HANDLE;
};

/// One for all tests of a program.
inline KernelRunner& runner() {
  static KernelRunner kRunner;
  return kRunner;
}

}  // namespace afterglow
