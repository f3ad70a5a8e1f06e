// SPDX-License-Identifier: MIT
// Perceptual brightness of a pixel (red), its means with the pixel to the right (green) and below (blue), and of all four (alpha), so that what
// lies between two or four pixels is one read.
#include "lib/color.glsl"

uniform sampler2D source;

vec4 sample_at(ivec2 pixel) {
  float own = perceived(fetch(source, pixel).rgb), right = perceived(fetch(source, pixel + ivec2(1, 0)).rgb);
  float below = perceived(fetch(source, pixel + ivec2(0, 1)).rgb), both = perceived(fetch(source, pixel + ivec2(1, 1)).rgb);
  return vec4(own, 0.5 * (own + right), 0.5 * (own + below), 0.25 * ((own + right) + (below + both)));
}
