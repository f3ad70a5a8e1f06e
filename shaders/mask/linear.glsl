// SPDX-License-Identifier: MIT
// From 0 at one point to 1 at the other, the same along lines across; points in pictures.
uniform vec2 from;
uniform vec2 to;

vec4 apply(vec4 color, ivec2 pixel) {
  vec2 size = vec2(target_size());
  vec2 way = (to - from) * size, at = vec2(pixel) + 0.5 - from * size;
  return vec4(smoothstep(0.0, 1.0, dot(at, way) / dot(way, way)));
}
