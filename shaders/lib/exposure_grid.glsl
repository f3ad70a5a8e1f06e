// SPDX-License-Identifier: MIT
// A cell of the grid over the picture.
#include "lib/alpha.glsl"
#include "lib/color.glsl"

const float kMiddleGrey = 0.18;
const float kDarkest = 2.7465820e-06;  // 0.18 · 2^-16: darker light is not told apart

float exposure_value(vec3 light) { return log2(clamp(luminance(light), kDarkest, kMaxLight) / kMiddleGrey); }

// What a pixel says: its exposure value times how much it covers, and that. Where nothing is drawn (alpha 0) nothing is metered.
vec2 metered(vec4 color) {
  float covers = color.a >= kLeastAlpha ? min(color.a, 1.0) : 0.0;
  return covers > 0.0 ? vec2(covers * exposure_value(color.rgb / covers), covers) : vec2(0.0);
}

// Its first pixel, and the one behind its last.
ivec2 first_of(ivec2 cell, ivec2 cells, ivec2 size) { return cell * size / cells; }

// What it says about the picture, from the sum of what its pixels say: their mean, and how much the cell counts.
vec4 mean_of(vec2 sum, ivec2 cell, ivec2 cells, bool center) {
  vec2 from_center = (vec2(cell) + 0.5) / vec2(cells) * 2.0 - 1.0;
  float weight = center ? exp(-2.0 * dot(from_center, from_center)) : 1.0;
  return vec4(sum.y > 0.0 ? sum.x / sum.y : 0.0, weight * sum.y, 0.0, 1.0);
}
