// SPDX-License-Identifier: MIT
// Length of the gradient of perceived brightness, above a threshold, as the strength of a line.
#include "lib/color.glsl"

layout(constant_id = 0) const int operator = 0;  // Sobel, Scharr, Roberts

uniform sampler2D source;
uniform float intensity;
uniform float threshold;
uniform vec3 ink;
uniform vec3 paper;
uniform float opacity;
uniform float finer;  // below 1 in a preview: how much a line of one pixel covers of its own
uniform int apart;  // pixels between those that are compared

vec2 gradient(ivec2 pixel) {
  float y[9];
  for (int i = 0; i < 9; ++i) y[i] = perceived(fetch(source, pixel + apart * (ivec2(i % 3, i / 3) - 1)).rgb);
  // Roberts' cross: the diagonals of the pixel and its neighbours to the right and below. A straight step shows in both.
  if (operator == 2) return vec2(y[4] - y[8], y[5] - y[7]) * 0.70710678;
  float side = operator == 1 ? 3.0 : 1.0, middle = operator == 1 ? 10.0 : 2.0;
  // Differences first: a mirrored picture then gives the same bits.
  return vec2(side * ((y[2] - y[0]) + (y[8] - y[6])) + middle * (y[5] - y[3]), side * ((y[6] - y[0]) + (y[8] - y[2])) + middle * (y[7] - y[1])) /
         (2.0 * side + middle);
}

vec4 sample_at(ivec2 pixel) {
  vec4 color = fetch(source, pixel);
  float line = clamp((length(gradient(pixel)) - threshold) * intensity * finer, 0.0, finer);
  return vec4(lerp(lerp(color.rgb, paper, opacity), ink, line), color.a);
}
