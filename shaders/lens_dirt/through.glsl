// SPDX-License-Identifier: MIT
// high + intensity · dirt · color, with the dirt of a picture that lies at `corner`, `extent` pixels large. Alpha of `high`.
#include "lib/color.glsl"

uniform sampler2D dirt;
uniform ivec2 corner;
uniform ivec2 extent;
uniform float intensity;

vec4 apply(vec4 color, vec4 high, ivec2 pixel) {
  vec2 place = (vec2(pixel - corner) + 0.5) * vec2(image_size(dirt)) / vec2(extent);
  return vec4(min(high.rgb + intensity * fetch_linear(dirt, place).rgb * color.rgb, kMaxLight), high.a);
}
