// SPDX-License-Identifier: MIT
// Scene-linear light to what 8-bit display files hold.
#include "lib/alpha.glsl"

/// The sRGB curve (IEC 61966-2-1) of 0 ≤ x ≤ 1: 12.92·x up to 0.0031308, then 1.055·x^(1/2.4) − 0.055, that is
/// 1.055·s^(5/3) − 0.055 of the fourth root s, by a minimax polynomial: off by 1.5e-6 at most, 0.0004 of a step of 1/255.
vec3 srgb_encode(vec3 x) {
  vec3 s = sqrt(sqrt(x));
  vec3 curve = -0.05954303438 + s * (0.1395632646 + s * (1.366106658 + s * (-0.8533873698 + s * (0.657726096 + s * (-0.3187618962 + s * 0.06829768953)))));
  return mix(curve, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

/// What the nearest 8-bit codes are made of, 0…1.
vec3 display_color(vec3 light) { return srgb_encode(clamp(light, 0.0, 1.0)); }
