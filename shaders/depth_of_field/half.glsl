// SPDX-License-Identifier: MIT
// Half the size again, as `small` does it: of four the widest circle counts, and the light of those whose circles are like it.
#include "lib/circle_of_confusion.glsl"

uniform sampler2D source;

vec4 sample_at(ivec2 pixel) {
  vec4 a = fetch(source, 2 * pixel), b = fetch(source, 2 * pixel + ivec2(1, 0)), c = fetch(source, 2 * pixel + ivec2(0, 1)), d = fetch(source, 2 * pixel + 1);
  vec4 circles = vec4(a.a, b.a, c.a, d.a);
  float widest = widest_of(circles);
  vec4 weights = like_widest(circles, widest, 0.5);
  return vec4((a.rgb * weights.x + b.rgb * weights.y + c.rgb * weights.z + d.rgb * weights.w) / (weights.x + weights.y + weights.z + weights.w), widest);
}
