// SPDX-License-Identifier: MIT
// What a lens does to a picture: vignette, chromatic aberration, lens distortion (Unity URP, UberPost.shader).
#pragma once

#include <glm/vec2.hpp>

#include "reference/double_image.h"

namespace afterglow::reference {

using Point = glm::dvec2;  ///< {0, 0} upper left, {1, 1} lower right

struct Vignette {
  double intensity = 0.4, smoothness = 0.4;
  Rgb color{0};
  Point center{0.5};
  bool rounded = false;
};
DoubleImage vignette(const DoubleImage& source, const Vignette& settings);

/// `samples` reads along the fringe, weighted as a spectrum; 3 are Unity's three.
DoubleImage chromatic_aberration(const DoubleImage& source, double intensity, int samples);

enum class LensEdges { stretch, mirror, black };
struct LensDistortion {
  double intensity = 0.2, x_multiplier = 1, y_multiplier = 1;
  Point center{0.5};
  double scale = 1;
  LensEdges edges = LensEdges::stretch;
};
DoubleImage lens_distortion(const DoubleImage& source, const LensDistortion& settings);

}  // namespace afterglow::reference
