// SPDX-License-Identifier: MIT
// How much the fog hides of each pixel, and how much it leaves: both, since halves of either say little about the other. z is the distance along the viewing axis; the ray through a pixel is (x, y, 1) · z.
// Colours have soft edges, depths have none: along a thin wire each pixel would be fogged as wire or as sky, by chance. At edges it is therefore a mean
// over a pixel's own depth and those around it, by how alike their colours are: pixels that are half covered share their fog.
#include "lib/depth.glsl"

layout(constant_id = 0) const bool device_input = false;
layout(constant_id = 1) const bool reversed_z = true;
layout(constant_id = 2) const bool layered = false;  // thins with height

uniform sampler2D source, depth;
uniform vec2 inverse_clip;
uniform float density;  // at the camera's height
uniform float start, most, sky, falloff;
uniform vec2 view;  // tangents of the picture's half angles
uniform vec2 up;    // what (y, 1) climb

const float kFar = 1e9;
const float kEdge = 1.05;  // depths that lie closer together than this are one surface

// (1 − e^−u)/u: the mean of e^(−t) for t from 0 to u.
float mean_of_fall(float u) {
  u = clamp(u, -60.0, 1e30);
  return abs(u) < 0.05 ? 1.0 + u * (-0.5 + u * (1.0 / 6.0 + u * (-1.0 / 24.0 + u * (1.0 / 120.0)))) : (1.0 - exp(-u)) / u;
}

float distance_at(ivec2 pixel) {
  float d = fetch(depth, pixel).r;
  return clamp(device_input ? view_distance(d, inverse_clip, reversed_z) : d, 0.0, 1e15);
}

// What is hidden of light from a distance z along a ray.
float hidden_at(float z, vec3 ray) {
  float along = length(ray), climb = (ray.y * up.x + up.y) / along;  // metres up for each metre of the ray
  float through = max(z * along - start, 0.0);
  float thick = density * through;
  if (layered) {
    float before = clamp(-falloff * climb * min(start, z * along), -80.0, 60.0);
    thick *= exp(before) * mean_of_fall(falloff * climb * through);
  }
  thick = min(thick, 100.0);
  return thick * mean_of_fall(thick) * most * (z >= kFar ? sky : 1.0);
}

vec3 ray_of(ivec2 pixel) { return vec3((vec2(pixel * 2 + 1) / vec2(target_size()) - 1.0) * vec2(view.x, -view.y), 1.0); }

vec4 shares(float hidden) { return vec4(hidden, 1.0 - hidden, 0.0, 0.0); }

bool done_at(ivec2 pixel, out vec4 color) {
  float here = distance_at(pixel), nearest = here, farthest = here;
  for (int i = -1; i <= 1; i += 2) {
    float beside = distance_at(pixel + ivec2(i, 0)), above = distance_at(pixel + ivec2(0, i));
    nearest = min(nearest, min(beside, above));
    farthest = max(farthest, max(beside, above));
  }
  color = shares(hidden_at(here, ray_of(pixel)));
  return farthest <= kEdge * nearest || nearest >= kFar;
}

float largest(vec3 c) { return max(max(abs(c.r), abs(c.g)), abs(c.b)); }

vec4 sample_at(ivec2 pixel) {
  vec3 here = fetch(source, pixel).rgb, ray = ray_of(pixel);
  float sum = 0.0, weights = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      vec3 other = fetch(source, pixel + ivec2(x, y)).rgb;
      vec3 apart = (other - here) / max(max(largest(other), largest(here)), 1e-6);
      float weight = exp2(-6.0 * max(dot(apart, apart), 1e-30));  // squares below the smallest float may be 0 or not: no matter
      sum += weight * hidden_at(distance_at(pixel + ivec2(x, y)), ray);
      weights += weight;
    }
  return shares(sum / weights);
}
