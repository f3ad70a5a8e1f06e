// SPDX-License-Identifier: MIT
// c·(1 + strength·noise·response curve): grain scales with light, so black stays black and colours keep their hue where it is grey.
#include "lib/color.glsl"
#include "lib/noise.glsl"

layout(constant_id = 0) const bool fine = true;  // one grain a pixel

uniform float strength;
uniform float response;
uniform vec2 size_of_grain;  // pixels, ≥ 1: in 64ths, and the rest
uniform float colored;
uniform int frame, seed;

vec3 grain(ivec2 cell) { return normal_of(pcg3d(uvec3(cell, frame) + uvec3(0u, uint(seed) << 16u, uint(seed)))); }

// Between cells it is interpolated; divided by the root of the sum of squared weights the deviation stays 1.
vec3 coarse_grain(ivec2 pixel) {
  vec2 centre = vec2(pixel) + 0.5;
  ivec2 cell = ivec2(floor(centre / (size_of_grain.x + size_of_grain.y)));
  vec2 f = place_in_cell(centre, cell, size_of_grain), g = 1.0 - f;
  vec3 n = (grain(cell) * g.x + grain(cell + ivec2(1, 0)) * f.x) * g.y + (grain(cell + ivec2(0, 1)) * g.x + grain(cell + 1) * f.x) * f.y;
  return n * inversesqrt((f.x * f.x + g.x * g.x) * (f.y * f.y + g.y * g.y));
}

vec4 apply(vec4 color, ivec2 pixel) {
  vec3 n = fine ? grain(pixel) : coarse_grain(pixel);
  n = lerp(n.ggg, n, colored);
  float less = 1.0 - response * sqrt(clamp(luminance(color.rgb), 0.0, 1.0));
  return vec4(clamp(color.rgb * (1.0 + strength * less * n), 0.0, kMaxLight), color.a);
}
