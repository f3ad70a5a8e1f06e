// SPDX-License-Identifier: MIT
// c·(1 + strength·noise·response curve): grain scales with light, so black stays black and colours keep their hue where it is grey.
#include "lib/color.glsl"
#include "lib/noise.glsl"

layout(constant_id = 0) const bool fine = true;      // one grain a pixel
layout(constant_id = 1) const bool grey = true;      // the same grain in all channels

uniform float strength;
uniform float response;
uniform vec2 size_of_grain;  // side of a cell, pixels: in 64ths, and the rest
uniform float colored;
uniform int frame, seed;

// Red, grey, blue; and, where there is colour, green.
vec4 grain(ivec2 cell) {
  uvec3 words = pcg3d(uvec3(cell, frame) + uvec3(0u, uint(seed) << 16u, uint(seed)));
  return vec4(normal_of(words), grey ? 0.0 : normal_of(pcg3d(words)).y);
}

// Between cells by quadratic B-splines, which are nearly as sharp everywhere; divided by the root of the sum of squared weights the deviation
// stays 1. Each frame has its cells elsewhere: a lattice would stand still over all of them.
vec4 coarse_grain(ivec2 pixel) {
  uvec3 frame_words = pcg3d(uvec3(uint(frame), uint(seed), 0x5eedu));
  vec2 centre = vec2(pixel) + 0.5 + vec2(frame_words.xy >> 24u) / 16.0;
  ivec2 cell = ivec2(floor(centre / (size_of_grain.x + size_of_grain.y)));
  vec2 f = place_in_cell(centre, cell, size_of_grain), g = 1.0 - f;
  vec2 before = 0.5 * g * g, after = 0.5 * f * f, own = 1.0 - before - after;
  vec4 n = vec4(0.0);
  for (int j = -1; j <= 1; ++j) {
    float down = j < 0 ? before.y : j > 0 ? after.y : own.y;
    n += down * (before.x * grain(cell + ivec2(-1, j)) + own.x * grain(cell + ivec2(0, j)) + after.x * grain(cell + ivec2(1, j)));
  }
  vec2 squares = before * before + own * own + after * after;
  return n * inversesqrt(squares.x * squares.y);
}

vec4 apply(vec4 color, ivec2 pixel) {
  vec4 each = fine ? grain(pixel) : coarse_grain(pixel);
  // Of a grey and a coloured grain that know nothing of each other, with the deviation of one.
  vec3 n = grey ? each.ggg : lerp(each.ggg, each.rab, colored) * inversesqrt(colored * colored + (1.0 - colored) * (1.0 - colored));
  float less = 1.0 - response * sqrt(clamp(luminance(color.rgb), 0.0, 1.0));
  return vec4(clamp(color.rgb * (1.0 + strength * less * n), 0.0, kMaxLight), color.a);
}
