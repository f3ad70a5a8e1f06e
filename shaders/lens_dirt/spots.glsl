// SPDX-License-Identifier: MIT
// Opacity of the dirt, 0…1: two layers of cells, large spots and specks, in each cell at most one disc with an edge of its own softness.
#include "lib/noise.glsl"

uniform vec2 cell;  // side of the larger cells, pixels: in 64ths, and the rest
uniform float density;
uniform int seed;

float layer(vec2 centre, vec2 side, uint number) {
  ivec2 home = ivec2(floor(centre / (side.x + side.y)));
  float sum = 0.0;
  for (int i = 0; i < 9; ++i) {
    ivec2 at = home + ivec2(i % 3, i / 3) - 1;
    uvec3 words = pcg3d(uvec3(at, uint(seed) * 2u + number));
    vec3 place = unit_of(words), kind = unit_of(pcg3d(words));
    if (place.z >= density) continue;
    float radius = 0.1 + 0.4 * kind.x;  // of the cell's side
    float inside = (radius - length(place_in_cell(centre, at, side) - place.xy)) / (radius * (0.1 + 0.9 * kind.y));
    sum += (0.1 + 0.9 * kind.z * kind.z) * clamp(inside, 0.0, 1.0);
  }
  return sum;
}

vec4 sample_at(ivec2 pixel) {
  vec2 centre = vec2(pixel) + 0.5;
  return vec4(min(0.6 * layer(centre, cell, 0u) + 0.4 * layer(centre, 0.25 * cell, 1u), 1.0));
}
