// SPDX-License-Identifier: MIT
// The smeared picture, which is smaller, where its streaks are longer than its pixels; the sharp one around the centre. Alpha of the picture.
#include "lib/color.glsl"

uniform vec2 center;   // in pixels
uniform float amount;  // length of a streak, as a share of the distance
uniform float factor;  // side of a small picture's pixel

vec4 apply(vec4 color, vec4 picture, ivec2 pixel) {
  float streak = amount * length(vec2(pixel) + 0.5 - center) / factor;
  return vec4(lerp(picture.rgb, color.rgb, clamp((streak - 0.5) / 1.5, 0.0, 1.0)), picture.a);
}
