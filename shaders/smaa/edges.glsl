// SPDX-License-Identifier: MIT
// Edges at the left (r) and upper (g) side of each pixel, 0 or 1. An edge beside one that is twice as strong is none.
uniform sampler2D source;  // luma
uniform float threshold;

float at(ivec2 pixel) { return fetch(source, pixel).r; }

vec4 sample_at(ivec2 pixel) {
  float here = at(pixel);
  float left = at(pixel + ivec2(-1, 0)), top = at(pixel + ivec2(0, -1));
  vec2 change = abs(here - vec2(left, top));
  vec2 edges = step(vec2(threshold), change);
  if (edges.x + edges.y == 0.0) return vec4(0.0);
  vec2 around = abs(here - vec2(at(pixel + ivec2(1, 0)), at(pixel + ivec2(0, 1))));
  vec2 beyond = abs(vec2(left, top) - vec2(at(pixel + ivec2(-2, 0)), at(pixel + ivec2(0, -2))));
  vec2 most = max(max(change, around), beyond);
  edges *= step(max(most.x, most.y), 2.0 * change);
  return vec4(edges, 0.0, 0.0);
}
