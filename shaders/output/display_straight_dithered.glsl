// SPDX-License-Identifier: MIT
// The same with blue noise between two codes.
#include "lib/dither.glsl"

uniform sampler2D noise;

vec4 apply(vec4 color, vec4 original, ivec2 pixel) {
  return vec4(dithered_color(straight(color.rgb, min(original.a, 1.0)), fetch(noise, pixel & 63).r), original.a);
}
