// SPDX-License-Identifier: MIT
// Each pixel takes as much of its neighbours as lies beyond their common edge: of those above and below, or of those beside it, whichever is more.
#include "lib/color.glsl"

uniform sampler2D source;
uniform sampler2D weights;

vec4 sample_at(ivec2 pixel) {
  vec4 color = fetch(source, pixel);
  ivec2 last = image_size(source) - 1;
  vec4 own = fetch(weights, pixel);
  float below = pixel.y < last.y ? fetch(weights, pixel + ivec2(0, 1)).g : 0.0;
  float beside = pixel.x < last.x ? fetch(weights, pixel + ivec2(1, 0)).a : 0.0;
  float above = own.r, left = own.b;
  const float kNone = 1e-5;
  if (max(max(above, below), max(left, beside)) <= kNone) return color;  // what rounding leaves of nothing
  bool level = max(left, beside) > max(above, below) + kNone;  // where both are the same, rounding must not decide
  ivec2 by = level ? ivec2(1, 0) : ivec2(0, 1);
  float ahead = level ? beside : below, behind = level ? left : above;
  float sum = ahead + behind;
  vec3 to = lerp(color.rgb, fetch(source, pixel + by).rgb, ahead), from = lerp(color.rgb, fetch(source, pixel - by).rgb, behind);
  return vec4(to * (ahead / sum) + from * (behind / sum), color.a);
}
