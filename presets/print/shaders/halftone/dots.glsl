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

const float kLeast = 1.0;  // pixels

vec2 turn(vec2 p, vec2 by) { return vec2(p.x * by.x - p.y * by.y, p.x * by.y + p.y * by.x); }

// Radius of a dot that covers such a share of its cell, in cells. Up to π/4 it lies within the cell; then it is cut at the
// sides, and reaches the corners where all is ink (a fit, within 5e-4).
float radius_of(float share) {
  if (share < 0.7853982) return 0.5641896 * sqrt(share);
  float left = sqrt((1.0 - share) / 0.2146018);
  return 0.7071068 - left * (0.2279126 + left * (0.0048721 - 0.0256779 * left));
}

vec4 sample_at(ivec2 pixel) {
  vec4 here = fetch(source, pixel);
  vec2 position = vec2(pixel) + 0.5;
  vec2 centre = (floor(turn(position, rotation) / cell) + 0.5) * cell;
  vec2 offset = turn(position, rotation) - centre;
  vec3 seen = fetch_linear(source, turn(centre, vec2(rotation.x, -rotation.y))).rgb;

  float radius = cell * radius_of(1.0 - clamp(luminance(seen), 0.0, 1.0));
  // A soft edge of a pixel; it adds 1/12 to radius², which is taken off before. Dots that pixels would meet or miss, which beats with their
  // grid, are drawn at kLeast in ink that is as much paler.
  float drawn = max(radius, kLeast);
  float inked = clamp(sqrt(drawn * drawn - 1.0 / 12.0) - length(offset) + 0.5, 0.0, 1.0) * (radius * radius) / (drawn * drawn);
  // Cells of less than four pixels, as in a preview, turn into their mean: two pixels show no grid.
  inked = mix(1.0 - clamp(luminance(here.rgb), 0.0, 1.0), inked, clamp(0.5 * cell - 1.0, 0.0, 1.0));

  vec3 below = lerp(paper, paper * clamp(here.rgb / max(brightest(here.rgb), 1e-5), 0.0, 1.0), tint);
  return vec4(lerp(below, ink, inked) * here.a, here.a);
}
