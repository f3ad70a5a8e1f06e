// SPDX-License-Identifier: MIT
// Effects on fine detail: contrast-adaptive sharpening (AMD FidelityFX CAS), squares, edges, FXAA.
#pragma once

#include "reference/double_image.h"

namespace afterglow::reference {

/// √luminance of the colour held to 0…1.
double perceived(const Rgb& c);

DoubleImage sharpen(const DoubleImage& source, double intensity, double contrast);

/// Squares of `size` pixels from the upper left corner, each its mean.
DoubleImage pixelate(const DoubleImage& source, double size);

enum class EdgeOperator { sobel, scharr, roberts };
struct EdgeDetection {
  EdgeOperator kind = EdgeOperator::sobel;
  double intensity = 2, threshold = 0.05;
  Rgb color{0}, background{1};
  double background_opacity = 0;
  int apart = 1;  ///< an odd number of pixels between those that are compared, each the mean of a square of that side
};
DoubleImage edge_detection(const DoubleImage& source, const EdgeDetection& settings);

enum class FxaaQuality { low, medium, high };
struct Fxaa {
  double fixed_threshold = 0.0833, relative_threshold = 0.166, subpixel_blending = 0.75;
  FxaaQuality quality = FxaaQuality::high;
};
/// Catlike Coding, "Custom SRP 17: FXAA".
DoubleImage fxaa(const DoubleImage& source, const Fxaa& settings);

}  // namespace afterglow::reference
