// SPDX-License-Identifier: MIT
// Length of the gradient of perceived brightness, above a threshold, as the strength of a line.
#include "lib/color.glsl"

layout(constant_id = 0) const int operator = 0;  // Sobel, Scharr, Roberts
layout(constant_id = 1) const int apart = 1;     // pixels between those that are compared

uniform sampler2D source;
uniform sampler2D tones;  // the source; where pixels are compared that are `apart`, the mean over squares of that side
uniform float intensity;
uniform float threshold;
uniform vec3 ink;
uniform vec3 paper;
uniform float opacity;
uniform float finer;  // below 1 in a preview: how much a line of one pixel covers of its own

float at(ivec2 pixel) { return perceived(fetch(tones, pixel).rgb); }

vec2 gradient(ivec2 pixel) {
  float own = at(pixel), e = at(pixel + ivec2(apart, 0)), s = at(pixel + ivec2(0, apart)), se = at(pixel + ivec2(apart, apart));
  // Roberts' cross: the diagonals of the pixel and its neighbours to the right and below. A straight step shows in both.
  if (operator == 2) return vec2(own - se, e - s) * 0.70710678;
  float nw = at(pixel + ivec2(-apart, -apart)), n = at(pixel + ivec2(0, -apart)), ne = at(pixel + ivec2(apart, -apart));
  float w = at(pixel + ivec2(-apart, 0)), sw = at(pixel + ivec2(-apart, apart));
  const float side = operator == 1 ? 3.0 : 1.0, middle = operator == 1 ? 10.0 : 2.0;
  // Differences first: a mirrored picture then gives the same bits.
  return vec2(side * ((ne - nw) + (se - sw)) + middle * (e - w), side * ((sw - nw) + (se - ne)) + middle * (s - n)) * (1.0 / (2.0 * side + middle));
}

vec4 sample_at(ivec2 pixel) {
  vec4 color = fetch(source, pixel);
  float line = clamp((length(gradient(pixel)) - threshold) * intensity * finer, 0.0, finer);
  return vec4(lerp(lerp(color.rgb, paper * color.a, opacity), ink * color.a, line), color.a);
}
