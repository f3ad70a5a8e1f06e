// SPDX-License-Identifier: MIT
// Motion blur by motion vectors along each pixel's own way and two of those around it, see math.md §16.
#pragma once

#include "reference/double_image.h"

namespace afterglow::reference {

struct MotionBlur {
  double shutter_angle = 180;
  int samples = 64;
  double max_radius = 32;
  double scale_x = 1, scale_y = 1;
  double depth_softness = 0.1;
};
/// `motion` in .xy, pixels a frame, y down; `depth` may be null.
DoubleImage motion_blur(const DoubleImage& source, const DoubleImage& motion, const DoubleImage* depth,
                        const MotionBlur& settings);

}  // namespace afterglow::reference
