// SPDX-License-Identifier: MIT
// A picture in host memory: interleaved 32-bit floats, row by row from the top, without padding.
#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry.h"

namespace afterglow {

struct Image {
  int width = 0, height = 0, channels = 0;
  std::vector<float> pixels;  ///< width · height · channels values

  Image() = default;
  Image(int w, int h, int c) : width(w), height(h), channels(c), pixels(static_cast<std::size_t>(w) * h * c) {}

  Size size() const { return {width, height}; }
  bool empty() const { return pixels.empty(); }
  std::size_t bytes() const { return pixels.size() * sizeof(float); }
  float* at(int x, int y) { return &pixels[(static_cast<std::size_t>(y) * width + x) * channels]; }
  const float* at(int x, int y) const { return &pixels[(static_cast<std::size_t>(y) * width + x) * channels]; }
};

}  // namespace afterglow
