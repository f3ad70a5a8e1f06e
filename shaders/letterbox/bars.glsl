// SPDX-License-Identifier: MIT
// Shows the window, covers the rest. The window's first and last whole pixel on each axis; of the ones beside them the shares that show, then
// those that are covered.
#include "lib/color.glsl"

uniform ivec2 columns, rows;
uniform vec4 sides, edges;
uniform vec3 bars;

/// How much of the picture shows along one axis, and how much is covered.
vec2 shown(int at, ivec2 whole, vec4 beside) {
  if (at >= whole.x && at <= whole.y) return vec2(1.0, 0.0);
  return at == whole.x - 1 ? beside.xz : at == whole.y + 1 ? beside.yw : vec2(0.0, 1.0);
}

vec4 apply(vec4 color, ivec2 pixel) {
  vec2 x = shown(pixel.x, columns, sides), y = shown(pixel.y, rows, edges);
  return vec4(clamp(bars * color.a, -kMaxLight, kMaxLight) * (x.y + x.x * y.y) + color.rgb * (x.x * y.x), color.a);
}
