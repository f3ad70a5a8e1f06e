// SPDX-License-Identifier: MIT
// c·(1 + strength·noise·response curve): grain scales with light, so black stays black and colours keep their hue where it is grey.
#include "lib/color.glsl"
#include "lib/noise.glsl"

layout(constant_id = 0) const bool fine = true;      // one grain a pixel
layout(constant_id = 1) const bool grey = true;      // the same grain in all channels

uniform float strength;
uniform float response;
uniform vec2 size_of_grain;  // pixels, ≥ 1: in 64ths, and the rest
uniform float colored;
uniform int frame, seed;

// Red, grey, blue; and, where there is colour, green.
vec4 grain(ivec2 cell) {
  uvec3 words = pcg3d(uvec3(cell, frame) + uvec3(0u, uint(seed) << 16u, uint(seed)));
  return vec4(normal_of(words), grey ? 0.0 : normal_of(pcg3d(words)).y);
}

// Between cells it is interpolated; divided by the root of the sum of squared weights the deviation stays 1.
vec4 coarse_grain(ivec2 pixel) {
  vec2 centre = vec2(pixel) + 0.5;
  ivec2 cell = ivec2(floor(centre / (size_of_grain.x + size_of_grain.y)));
  vec2 f = place_in_cell(centre, cell, size_of_grain), g = 1.0 - f;
  vec4 n = (grain(cell) * g.x + grain(cell + ivec2(1, 0)) * f.x) * g.y + (grain(cell + ivec2(0, 1)) * g.x + grain(cell + 1) * f.x) * f.y;
  return n * inversesqrt((f.x * f.x + g.x * g.x) * (f.y * f.y + g.y * g.y));
}

vec4 apply(vec4 color, ivec2 pixel) {
  vec4 each = fine ? grain(pixel) : coarse_grain(pixel);
  // Of a grey and a coloured grain that know nothing of each other, with the deviation of one.
  vec3 n = grey ? each.ggg : lerp(each.ggg, each.rab, colored) * inversesqrt(colored * colored + (1.0 - colored) * (1.0 - colored));
  float less = 1.0 - response * sqrt(clamp(luminance(color.rgb), 0.0, 1.0));
  return vec4(clamp(color.rgb * (1.0 + strength * less * n), 0.0, kMaxLight), color.a);
}
