// Opacity of the dirt, 0…1: two layers of cells, large spots and specks, in each cell at most one disc with an edge of its own softness.
#include "lib/noise.glsl"

uniform float cell;  // side of the larger cells, pixels
uniform float density;
uniform int seed;

float layer(vec2 p, uint number) {
  ivec2 home = ivec2(floor(p));
  float sum = 0.0;
  for (int i = 0; i < 9; ++i) {
    ivec2 at = home + ivec2(i % 3, i / 3) - 1;
    uvec3 words = pcg3d(uvec3(at, uint(seed) * 2u + number));
    vec3 place = unit_of(words), kind = unit_of(pcg3d(words));
    if (place.z >= density) continue;
    float radius = 0.1 + 0.4 * kind.x;  // of the cell's side
    float inside = (radius - length(p - (vec2(at) + place.xy))) / (radius * (0.1 + 0.9 * kind.y));
    sum += (0.1 + 0.9 * kind.z * kind.z) * clamp(inside, 0.0, 1.0);
  }
  return sum;
}

vec4 sample_at(ivec2 pixel) {
  vec2 p = (vec2(pixel) + 0.5) / cell;
  return vec4(min(0.6 * layer(p, 0u) + 0.4 * layer(p * 4.0, 1u), 1.0));
}
