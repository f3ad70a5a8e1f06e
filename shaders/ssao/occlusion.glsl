// SPDX-License-Identifier: MIT
// Share of the light that is left (r), and the distance along the viewing axis (g).
#include "lib/angle.glsl"
#include "lib/noise.glsl"

uniform sampler2D source;  // direction of the surface, distance
uniform int samples;
uniform float radius;  // metres
uniform float bias, strength;
uniform float most;  // pixels
uniform vec2 view;

const float kFar = 1e9;
const float kNear = 1e-12;  // metres: nearer there is no surface, for squares of ways keep no digits there
const float kFarthest = 65504.0;  // whatever is farther is that far in the image: half floats hold no more
const float kTurns = 7.0;  // of the spiral

vec3 place(vec2 at, vec2 size, float z) { return vec3((2.0 * at / size - 1.0) * vec2(view.x, -view.y) * z, -z); }

vec4 sample_at(ivec2 pixel) {
  vec4 surface = fetch(source, pixel);
  float z = surface.a, told = min(z, kFarthest);
  if (z >= kFar || z < kNear) return vec4(1.0, told, 0.0, 1.0);
  vec2 size = vec2(image_size(source));
  vec3 here = place(vec2(pixel) + 0.5, size, z);
  float far = min(0.5 * size.y * radius / (view.y * z), most);
  if (far < 0.5) return vec4(1.0, told, 0.0, 1.0);
  float within = min(radius, 2.0 * far * view.y * z / size.y);  // metres that the reads cover
  vec3 chance = unit_of(pcg3d(uvec3(pixel & 3, 17u)));
  float sum = 0.0;
  for (int i = 0; i < samples; ++i) {
    float share = (float(i) + 0.25 + 0.5 * chance.y) / float(samples);
    ivec2 at = pixel + ivec2(floor(far * share * direction_of(share * kTurns + chance.x) + 0.5));
    at = clamp(at, ivec2(0), ivec2(size) - 1);
    float there = fetch(source, at).a;
    vec3 way = place(vec2(at) + 0.5, size, there) - here;
    float apart = dot(way, way) / (within * within);
    float rise = (dot(way, surface.xyz) - 3e-4 * z) / within - bias;
    float near = max(1.0 - apart, 0.0);
    sum += near * near * near * max(rise, 0.0) / (apart + 0.01);
  }
  return vec4(max(0.0, 1.0 - strength * 4.0 * sum / float(samples)), told, 0.0, 1.0);
}
