// SPDX-License-Identifier: MIT
// Half-size prefilter that fades fireflies: five samples on a diagonal cross, each thresholded first, then averaged with weights
// 1/(luminance + 1), so that one very bright sample no longer outweighs the four others (Catlike Coding, Custom SRP 12: "HDR").
// Each bilinear sample already covers 2×2 texels: together they see 6×6 without its four sides' middles.
#include "lib/soft_knee.glsl"

uniform sampler2D source;
uniform vec4 knee;

vec4 sample_at(ivec2 pixel) {
  const ivec2 offsets[5] = ivec2[](ivec2(0, 0), ivec2(-2, -2), ivec2(-2, 2), ivec2(2, -2), ivec2(2, 2));
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (int i = 0; i < 5; ++i) {
    vec3 c = soft_knee_threshold(sample_scaled(source, pixel, offsets[i]).rgb, knee);
    float w = 1.0 / (luminance(c) + 1.0);
    sum += w * c;
    weights += w;
  }
  return vec4(sum / weights, 1.0);
}
