// SPDX-License-Identifier: MIT
#include "image/rgbe.h"

#include <algorithm>
#include <cmath>

namespace afterglow {

void round_to_rgbe(std::span<float> rgb) {
  constexpr int kBits = 8, kLeast = -128;
  constexpr float kMost = 256, kLargest = 255 * 0x1p119f;
  for (std::size_t i = 0; i + 3 <= rgb.size(); i += 3) {
    float brightest = 0;
    for (std::size_t c = i; c < i + 3; ++c) {
      rgb[c] = std::clamp(rgb[c] > 0 ? rgb[c] : 0, 0.0f, kLargest);
      brightest = std::max(brightest, rgb[c]);
    }
    int exponent = 0;
    std::frexp(brightest, &exponent);
    if (exponent <= kLeast + kBits) continue;  // what writers take for black
    float step = std::ldexp(1.0f, exponent - kBits);
    if (std::round(brightest / step) >= kMost) step *= 2;
    for (std::size_t c = i; c < i + 3; ++c) rgb[c] = std::round(rgb[c] / step) * step;
  }
}

}  // namespace afterglow
