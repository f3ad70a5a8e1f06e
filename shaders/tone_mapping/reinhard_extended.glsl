// SPDX-License-Identifier: MIT
// Reinhard et al. 2002 (eq. 4) on luminance Y: Y' = Y(1 + Y/w²)/(1 + Y), so that Y = w becomes 1. Colours keep their ratios.
#include "lib/color.glsl"

uniform float inverse_white;  // 1/w

vec4 apply(vec4 color) {
  vec3 c = clamp(color.rgb, 0.0, 65504.0);
  float y = luminance(c);
  return vec4(c * ((1.0 + (y * inverse_white) * inverse_white) / (1.0 + y)), color.a);
}
