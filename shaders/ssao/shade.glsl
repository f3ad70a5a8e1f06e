// SPDX-License-Identifier: MIT
// The picture by its light that is left: the four nearest pixels of the half-sized image, of those at the same distance.
#include "lib/color.glsl"
#include "lib/depth.glsl"

layout(constant_id = 0) const bool device_input = false;
layout(constant_id = 1) const bool reversed_z = true;

uniform sampler2D source;
uniform sampler2D occlusion;
uniform sampler2D depth;
uniform vec2 inverse_clip;
uniform vec3 shadow;
uniform float spare;

vec4 sample_at(ivec2 pixel) {
  vec4 color = fetch(source, pixel);
  float d = fetch(depth, pixel).r;
  float z = clamp(device_input ? view_distance(d, inverse_clip, reversed_z) : d, 0.0, 65504.0);
  ivec2 base = pixel / 2;
  vec2 f = vec2(pixel - 2 * base) * 0.5;
  float sum = 0.0, weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 by = ivec2(i & 1, i >> 1);
    vec4 there = fetch(occlusion, base + by);
    vec2 share = mix(1.0 - f, f, vec2(by));
    float w = share.x * share.y / (1e-3 + abs(there.g - z) / max(0.02 * z, 1e-6));
    sum += w * there.r;
    weights += w;
  }
  float left = sum / max(weights, 1e-20);
  float b = brightest(color.rgb);
  left = mix(left, 1.0, smoothstep(spare, 4.0 * spare + 1e-6, b));
  return vec4(min(color.rgb * lerp(shadow, vec3(1.0), left), vec3(kMaxLight)), color.a);
}
