// SPDX-License-Identifier: MIT
// c · lerp(corner, 1, max(1 − d², 0)^power), d the distance from the centre in pictures, times `extent`.
#include "lib/color.glsl"

uniform vec2 center;  // 0…1
uniform vec2 extent;
uniform float power;
uniform vec3 corner;

vec4 apply(vec4 color, ivec2 pixel) {
  vec2 size = vec2(target_size());
  vec2 d = (vec2(pixel) + 0.5 - center * size) / size * extent;  // the difference of whole and half pixels first: it is exact
  float kept = pow(clamp(1.0 - dot(d, d), 0.0, 1.0), power);
  return vec4(min(color.rgb * lerp(corner, vec3(1.0), kept), kMaxLight), color.a);
}
