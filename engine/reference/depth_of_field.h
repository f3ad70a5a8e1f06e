// SPDX-License-Identifier: MIT
// Depth of field: near and far field apart, in a small picture, laid over the sharp one (math.md §35).
#pragma once

#include "reference/double_image.h"

namespace afterglow::reference {

struct DepthOfField {
  double focus_distance = 5, aperture = 1.4, focal_length = 50, sensor_height = 24;
  double max_radius = 16;
  int samples = 64;
  int blades = 0;
  double rotation = 0, squeeze = 1, cat_eye = 0;
};
/// What an autofocus looks at: the middle of a square and its side, in widths and heights of the picture.
struct FocusPoint {
  double x = 0.5, y = 0.5, area = 0.05;
};
/// The distance that it finds.
double autofocus(const DoubleImage& depth, const FocusPoint& point);
/// Where the focus is a while after it was at `before` and began to go to `wanted`.
double follow_focus(double before, double wanted, double speed, double seconds);
/// Radius of the circle of confusion of each pixel, held to ±max_radius; below 0 in front of the focus.
DoubleImage circles_of_confusion(const DoubleImage& depth, const DepthOfField& settings);
DoubleImage depth_of_field(const DoubleImage& source, const DoubleImage& depth, const DepthOfField& settings);

}  // namespace afterglow::reference
