// SPDX-License-Identifier: MIT
#include <array>
#include <cstdint>

#include "image/encode.h"

namespace afterglow {
namespace {

constexpr std::array<std::uint16_t, kBlueNoiseSize * kBlueNoiseSize> kRanks{
#include "image/blue_noise_table.inc"
};

}  // namespace

float blue_noise(int x, int y) {
  const auto at = static_cast<std::size_t>((y % kBlueNoiseSize) * kBlueNoiseSize + x % kBlueNoiseSize);
  return (static_cast<float>(kRanks[at]) + 0.5f) / static_cast<float>(kRanks.size());
}

std::shared_ptr<const ImageData> blue_noise_image() {
  static const std::shared_ptr<const ImageData> image = [] {
    auto made = std::make_shared<ImageData>();
    made->size = {kBlueNoiseSize, kBlueNoiseSize};
    for (int y = 0; y < kBlueNoiseSize; ++y)
      for (int x = 0; x < kBlueNoiseSize; ++x) {
        const float value = blue_noise(x, y);
        made->pixels.insert(made->pixels.end(), {value, value, value, 1.0f});
      }
    made->hash = hash_bytes(made->pixels.data(), made->pixels.size() * sizeof(float));
    return made;
  }();
  return image;
}

}  // namespace afterglow
