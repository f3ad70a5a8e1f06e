// SPDX-License-Identifier: MIT
// FidelityFX CAS: a cross of negative weights −peak·√(room/brightest), where room is what lies between the darkest of the 3×3 pixels and
// black, or the brightest and white, whichever is less.
#include "lib/color.glsl"

uniform sampler2D source;
uniform float amount;
uniform int apart;    // pixels between those that are compared
uniform float peak;  // 1/8 … 1/5

vec4 sample_at(ivec2 pixel) {
  vec3 c[9];
  for (int i = 0; i < 9; ++i) c[i] = fetch(source, pixel + apart * (ivec2(i % 3, i / 3) - 1)).rgb;
  // The cross counts twice, so that single corners do not decide.
  vec3 low = min(min(min(c[1], c[3]), min(c[5], c[7])), c[4]), high = max(max(max(c[1], c[3]), max(c[5], c[7])), c[4]);
  low = 0.5 * (low + min(low, min(min(c[0], c[2]), min(c[6], c[8]))));
  high = 0.5 * (high + max(high, max(max(c[0], c[2]), max(c[6], c[8]))));
  vec3 weight = -peak * sqrt(clamp(min(low, 1.0 - high) / max(high, 1e-10), 0.0, 1.0));
  vec3 sharp = ((c[1] + c[3] + c[5] + c[7]) * weight + c[4]) / (1.0 + 4.0 * weight);
  return vec4(lerp(c[4], max(sharp, 0.0), amount), fetch(source, pixel).a);
}
