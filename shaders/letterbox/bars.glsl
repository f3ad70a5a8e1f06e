// SPDX-License-Identifier: MIT
// Shows the window, covers the rest. The window's first and last whole pixel on each axis, and the shares that the ones beside them show.
#include "lib/color.glsl"

uniform ivec2 columns, rows;
uniform vec2 sides, edges;
uniform vec3 bars;

float shown(int at, ivec2 whole, vec2 beside) {
  if (at >= whole.x && at <= whole.y) return 1.0;
  return at == whole.x - 1 ? beside.x : at == whole.y + 1 ? beside.y : 0.0;
}

vec4 apply(vec4 color, ivec2 pixel) {
  float share = shown(pixel.x, columns, sides) * shown(pixel.y, rows, edges);
  return vec4(lerp(clamp(bars * color.a, -kMaxLight, kMaxLight), color.rgb, share), color.a);
}
