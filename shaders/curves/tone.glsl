// SPDX-License-Identifier: MIT
// A gain in stops by brightness: a cubic through five points, three stops apart around middle grey, for each channel.
#include "lib/color.glsl"

layout(constant_id = 0) const bool together = false;  // one gain for all channels, by the colour's luminance

uniform vec3 y1, y2, y3, y4, y5;  // gains in stops at −6, −3, 0, 3 and 6 stops
uniform vec3 m2, m3, m4;          // slopes there, in stops a piece; 0 at the ends

vec3 curve(vec3 stops) {
  vec3 t = clamp(stops * (1.0 / 3.0) + 2.0, 0.0, 4.0);
  vec3 piece = min(floor(t), 3.0), f = t - piece;
  bvec3 second = greaterThanEqual(piece, vec3(1.0)), third = greaterThanEqual(piece, vec3(2.0)), fourth = greaterThanEqual(piece, vec3(3.0));
  vec3 from = mix(mix(mix(y1, y2, second), y3, third), y4, fourth), to = mix(mix(mix(y2, y3, second), y4, third), y5, fourth);
  vec3 begin = mix(mix(mix(vec3(0.0), m2, second), m3, third), m4, fourth), end = mix(mix(mix(m2, m3, second), m4, third), vec3(0.0), fourth);
  // Hermite's cubic, around its beginning.
  vec3 step = to - from;
  return from + f * (begin + f * ((3.0 * step - 2.0 * begin - end) + f * (begin + end - 2.0 * step)));
}

vec4 apply(vec4 color) {
  vec3 seen = together ? vec3(luminance(color.rgb)) : color.rgb;
  vec3 gain = exp2(curve(log2(max(seen, 1e-30) * (1.0 / 0.18))));
  return vec4(min(color.rgb * gain, kMaxLight), color.a);
}
