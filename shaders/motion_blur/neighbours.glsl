// SPDX-License-Identifier: MIT
// The longest way of a tile and its eight neighbours (xy), and the one that leads farthest aside of it (zw); of equal ones the first, from the upper
// left. Here they are held to max_radius.
#include "lib/ways.glsl"

uniform sampler2D source;
uniform float max_radius;

vec2 held(vec2 way) { return way / max(length(way) / max_radius, 1.0); }

vec4 sample_at(ivec2 pixel) {
  vec2 most = vec2(0.0), aside = vec2(0.0);
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) most = longer_of(most, fetch(source, pixel + ivec2(x, y)).xy);
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      vec4 read = fetch(source, pixel + ivec2(x, y));
      aside = farther_aside(most, farther_aside(most, aside, read.xy), read.zw);
    }
  return vec4(held(most), held(aside));
}
