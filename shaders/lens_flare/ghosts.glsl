// SPDX-License-Identifier: MIT
// Ghosts: the light at p comes from c + (p − c)/m for magnifications m (below 0: upside down), each with the colour of a coating. Ring: from the point that lies one
// radius of the ring nearer to the middle, or beyond it.
#include "lib/color.glsl"

uniform sampler2D source;
uniform int count;
uniform float ghosts, halo, spacing, ring, dispersion;

const float kPlaces[8] = float[](-0.45, -1.0, 0.38, -1.7, 0.7, -0.22, -2.6, 1.6);
const float kLight[8] = float[](0.9, 0.35, 0.7, 0.14, 0.4, 1.0, 0.1, 0.15);
const vec3 kCoats[8] = vec3[](vec3(0.45, 1.0, 0.7), vec3(1.0, 0.62, 0.3), vec3(0.4, 0.6, 1.0), vec3(0.85, 0.4, 1.0), vec3(1.0, 0.8, 0.45), vec3(0.5, 0.85, 1.0),
                              vec3(0.55, 1.0, 0.55), vec3(1.0, 0.45, 0.4));

// Light at a point of the source, as shares from its middle; fading towards the edge, where lights leave the picture.
float light(vec2 point, vec2 size, int channel) {
  vec2 at = (point * size.y) + 0.5 * size;
  vec2 inside = clamp(min(at, size - at) / (0.08 * size.y), 0.0, 1.0);
  inside = inside * inside * (3.0 - 2.0 * inside);
  float shown = inside.x * inside.y;
  return shown > 0.0 ? shown * fetch_linear(source, at)[channel] : 0.0;
}

vec4 sample_at(ivec2 pixel) {
  vec2 size = vec2(target_size());
  vec2 p = (vec2(pixel) + 0.5 - 0.5 * size) / size.y;
  float away = length(p);
  vec3 sum = vec3(0.0);
  for (int c = 0; c < 3; ++c) {
    float wave = float(c) - 1.0;  // red is bent least
    if (ghosts > 0.0)
      for (int i = 0; i < count; ++i) {
        float m = kPlaces[i] * spacing * (1.0 - 0.05 * dispersion * wave);
        sum[c] += ghosts * kLight[i] * kCoats[i][c] * light(p / m, size, c);
      }
    if (halo > 0.0) {
      float r = ring * (1.0 - 0.12 * dispersion * wave);
      // Towards the middle all directions meet and light would be drawn out into wedges.
      float seen = smoothstep(0.4, 0.8, away / r);
      if (seen > 0.0) sum[c] += halo * seen * light(p - p * (r / away), size, c);
    }
  }
  return vec4(min(sum, vec3(kMaxLight)), 1.0);
}
