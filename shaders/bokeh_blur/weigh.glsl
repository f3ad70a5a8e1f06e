// SPDX-License-Identifier: MIT
// Colour times its weight, and the weight: 1 + highlights·luminance² over its largest value, so that nothing outgrows half floats.
#include "lib/color.glsl"

uniform float highlights;

vec4 apply(vec4 color) {
  float y = clamp(luminance(color.rgb), 0.0, 1.0);
  float weight = (1.0 + highlights * y * y) / (1.0 + highlights);
  return vec4(color.rgb * weight, weight);
}
