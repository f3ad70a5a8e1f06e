// SPDX-License-Identifier: MIT
// Blurs of the whole picture, in linear light; alpha kept.
#pragma once

#include "reference/double_image.h"
#include "reference/lens.h"

namespace afterglow::reference {

/// Dual Kawase (M. Bjørge, SIGGRAPH 2015): `iterations` halvings of five reads, then as many doublings of eight. The
/// offset counts in 1024ths of a pixel.
DoubleImage dual_kawase(const DoubleImage& source, int iterations, double offset_wanted);

/// Mean of at least `samples` reads from the pixel to `intensity` of its way to the centre (math.md §37).
DoubleImage radial_blur(const DoubleImage& source, double intensity, int samples, Point center);

/// `distance` pixels long; degrees, 0 across, 90 up and down.
DoubleImage directional_blur(const DoubleImage& source, double distance, double angle);

struct BokehBlur {
  double radius = 8;
  int blades = 0;
  double rotation = 0, highlights = 0;
};
DoubleImage bokeh_blur(const DoubleImage& source, const BokehBlur& settings);

}  // namespace afterglow::reference
