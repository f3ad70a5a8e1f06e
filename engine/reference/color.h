// SPDX-License-Identifier: MIT
// Scalar colour functions (math.md §2): luminance, transfer curves, LogC, HSV.
#pragma once

#include "reference/double_image.h"

namespace afterglow::reference {

inline constexpr double kMostLight = 1e30;  ///< that effects let out: kMaxLight of shaders/lib/color.glsl

/// Pivot of the contrast step inside LogC: ACEScc's middle grey. Its linear value there is 0.2247698.
inline constexpr double kAcesccMidGray = 0.4135884;

/// Held to 0…1.
inline double saturate(double x) { return glm::clamp(x, 0.0, 1.0); }

/// Rec.709/D65 luminance; the weights add up to 1.0000001 and are used so.
double luminance(const Rgb& c);

/// IEC 61966-2-1 curves; nothing is clamped above 1.
double srgb_to_linear(double c);
double linear_to_srgb(double c);

/// Three-piece curve of a gamma *value* such as a bloom threshold: sRGB below 1, v^2.2 from 1 on. v ≥ 0.
double gamma_to_linear(double v);

/// Alexa LogC (El 1000), log branch alone. Below −b/a (−0.0086393) the logarithm is −∞.
double linear_to_logc(double x);
double logc_to_linear(double y);

/// The ε in both divisions of `rgb_to_hsv`, as Unity has it.
inline constexpr double kUnityHsvEpsilon = 1e-4;
/// HSV itself; only greys and black need it, against 0/0.
inline constexpr double kNoHsvEpsilon = 1e-300;

/// Hue and saturation in 0…1, value as is.
Rgb rgb_to_hsv(const Rgb& c, double epsilon);
Rgb hsv_to_rgb(const Rgb& hsv);
/// Wraps h into 0…1 by at most one turn.
double rotate_hue(double h);

}  // namespace afterglow::reference
