// SPDX-License-Identifier: MIT
// Pictures for the tests of the oracle.
#pragma once

#include <algorithm>
#include <random>

#include "reference/double_image.h"

namespace afterglow::reference {

/// Deterministic light: most samples below 1, some to 43.
inline DoubleImage random_light(Size size, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  DoubleImage image(size);
  for (auto& p : image.pixels) {
    const double gain = uniform(generator) < 0.1 ? 43 : 1;
    p = Rgba(uniform(generator) * gain, uniform(generator) * gain, uniform(generator) * gain, uniform(generator));
  }
  return image;
}

inline double largest_difference(const DoubleImage& a, const DoubleImage& b) {
  double worst = a.size() == b.size() ? 0 : 1e300;
  for (std::size_t i = 0; worst < 1e300 && i < a.pixels.size(); ++i)
    for (int c = 0; c < 4; ++c) worst = glm::max(worst, glm::abs(a.pixels[i][c] - b.pixels[i][c]));
  return worst;
}

/// Turned by 180 degrees.
inline DoubleImage turned(const DoubleImage& image) {
  DoubleImage out = image;
  std::reverse(out.pixels.begin(), out.pixels.end());
  return out;
}

}  // namespace afterglow::reference
