// SPDX-License-Identifier: MIT
// From 0 at one point to 1 at the other, the same along lines across; points in pictures.
#include "lib/mask.glsl"

uniform vec2 from;
uniform vec2 along;  // what a pixel of either axis adds

vec4 apply(vec4 color, ivec2 pixel) {
  vec2 at = vec2(pixel) + 0.5 - from * vec2(target_size());
  return vec4(smooth_share(dot(at, along)));
}
