// SPDX-License-Identifier: MIT
// From one picture to another (math.md §34).
#pragma once

#include <cstdint>

#include "reference/double_image.h"

namespace afterglow::reference {

enum class CutKind { dissolve, fade, wipe, iris, clock, blinds, scatter, push };
struct Cut {
  double progress = 0;
  CutKind kind = CutKind::dissolve;
  Rgb color{0};
  double angle = 0, softness = 0.05, center_x = 0.5, center_y = 0.5;
  int count = 12;
  double grain = 24;
  std::uint32_t seed = 0;
};
/// `other`: of the same size; null: the colour.
DoubleImage transition(const DoubleImage& source, const DoubleImage* other, const Cut& settings);

}  // namespace afterglow::reference
