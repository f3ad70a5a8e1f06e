// SPDX-License-Identifier: MIT
// Text over a picture (math.md §55).
#pragma once

#include <string>

#include "reference/double_image.h"

namespace afterglow::reference {

struct BurnIn {
  std::u32string text;
  double x = 0.5, y = 1, size = 0.05, margin = 0.03;
  Rgb color{1}, background{0};
  double box = 0.7, outline = 0;
};
/// With the letters of the installation, assets/fonts/mono.exr.
DoubleImage burn_in(const DoubleImage& source, const BurnIn& settings);

}  // namespace afterglow::reference
