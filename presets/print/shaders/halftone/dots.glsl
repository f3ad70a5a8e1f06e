// SPDX-License-Identifier: MIT
// One dot for each cell of a rotated grid. Its area is the share of light that is missing at its centre, so that the mean brightness of
// the print is that of the picture: light adds up linearly, and the colours here are linear.
#include "lib/color.glsl"

uniform sampler2D source;
uniform float cell;     // pixels
uniform vec2 rotation;  // cosine and sine of the grid's angle
uniform vec3 ink;
uniform vec3 paper;
uniform float tint;

vec2 turn(vec2 p, vec2 by) { return vec2(p.x * by.x - p.y * by.y, p.x * by.y + p.y * by.x); }

vec4 sample_at(ivec2 pixel) {
  vec4 here = fetch(source, pixel);
  vec2 position = vec2(pixel) + 0.5;
  vec2 centre = (floor(turn(position, rotation) / cell) + 0.5) * cell;
  vec2 offset = turn(position, rotation) - centre;
  vec3 seen = fetch_linear(source, turn(centre, vec2(rotation.x, -rotation.y))).rgb;

  float darkness = 1.0 - clamp(luminance(seen), 0.0, 1.0);
  // √(darkness/π) is the radius of that area; beyond half the cell dots overlap, so they grow a little more until black is solid.
  float radius = cell * 0.5641896 * sqrt(darkness) * (1.0 + 0.26 * darkness * darkness);
  float inked = clamp(radius - length(offset) + 0.5, 0.0, 1.0);

  vec3 below = lerp(paper, paper * clamp(here.rgb / max(brightest(here.rgb), 1e-5), 0.0, 1.0), tint);
  return vec4(lerp(below, ink, inked) * here.a, here.a);
}
