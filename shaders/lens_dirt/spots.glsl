// SPDX-License-Identifier: MIT
// Opacity of the dirt, 0…1: smudges, large grains of dust out of focus with brighter rims, and specks.
#include "lib/noise.glsl"

uniform vec2 cell;  // side of the larger cells, in pixels of this image: in 64ths, and the rest
uniform float density;
uniform int seed;

uvec3 words_of(ivec2 at, uint number) { return pcg3d(uvec3(at, uint(seed) * 8u + number)); }

// In each cell at most one grain, with an edge of its own softness; the rim of what is out of focus is brighter than its middle.
float grains(vec2 centre, vec2 side, uint number) {
  ivec2 home = ivec2(floor(centre / (side.x + side.y)));
  float sum = 0.0;
  for (int i = 0; i < 9; ++i) {
    ivec2 at = home + ivec2(i % 3, i / 3) - 1;
    uvec3 words = words_of(at, number);
    vec3 place = unit_of(words), kind = unit_of(pcg3d(words));
    float radius = 0.08 + 0.42 * kind.x * kind.x;  // of the cell's side
    float inside = 1.0 - length(place_in_cell(centre, at, side) - place.xy) / radius;  // 0 at the rim, 1 in the middle
    float opacity = (0.05 + 0.95 * kind.z * kind.z * kind.z) * clamp((density - place.z) * 20.0, 0.0, 1.0);  // it comes bit by bit
    sum += opacity * clamp(inside / (0.2 + 0.6 * kind.y), 0.0, 1.0) * (1.0 - 0.5 * clamp(inside * 2.5, 0.0, 1.0));
  }
  return sum;
}

// Noise between the corners of cells, smooth.
float smooth_noise(vec2 centre, vec2 side, uint number) {
  ivec2 home = ivec2(floor(centre / (side.x + side.y)));
  vec2 f = place_in_cell(centre, home, side);
  f = f * f * (3.0 - 2.0 * f);
  vec2 left = vec2(unit_of(words_of(home, number)).x, unit_of(words_of(home + ivec2(0, 1), number)).x);
  vec2 right = vec2(unit_of(words_of(home + ivec2(1, 0), number)).x, unit_of(words_of(home + 1, number)).x);
  vec2 across = left * (1.0 - f.x) + right * f.x;
  return across.x * (1.0 - f.y) + across.y * f.y;
}

vec4 sample_at(ivec2 pixel) {
  vec2 centre = vec2(pixel) + 0.5;
  float cloud = 0.5 * smooth_noise(centre, 4.0 * cell, 2u) + 0.3 * smooth_noise(centre, 1.5 * cell, 3u) + 0.2 * smooth_noise(centre, 0.5 * cell, 4u);
  float smudges = density * clamp(2.5 * cloud - 1.0, 0.0, 1.0);
  return vec4(min(0.5 * smudges + 1.5 * grains(centre, cell, 0u) + 0.8 * grains(centre, 0.25 * cell, 1u), 1.0));
}
