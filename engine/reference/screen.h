// SPDX-License-Identifier: MIT
// How pictures are shown: bars around them, picture tubes, few tones (math.md §30).
#pragma once

#include "reference/double_image.h"

namespace afterglow::reference {

struct Letterbox {
  double aspect = 2.39;
  Rgb color{0};
  double offset = 0;
};
DoubleImage letterbox(const DoubleImage& source, const Letterbox& settings);

struct Crt {
  int lines = 270;
  double softness = 0.45, scan_lines = 0.85, phosphor = 0.35, phosphor_size = 3, curvature = 0.3, corner = 0.04;
  double vignette = 0.3, glow = 0.12, convergence = 0.25, brightness = 1.1, intensity = 1;
};
DoubleImage crt(const DoubleImage& source, const Crt& settings);

struct Posterize {
  int levels = 5;
  double softness = 0.3, intensity = 1, shadows = 0;
};
/// Of straight colour.
DoubleImage posterize(const DoubleImage& source, const Posterize& settings);

}  // namespace afterglow::reference
