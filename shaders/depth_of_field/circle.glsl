// SPDX-License-Identifier: MIT
// The picture with the radius of its circle of confusion as alpha, in pixels: below 0 in front of the focus, above 0 behind it.
#include "lib/depth.glsl"

layout(constant_id = 0) const bool device_input = false;
layout(constant_id = 1) const bool reversed_z = true;

uniform float focus_distance;
uniform float infinity;  // radius for what is infinitely far
uniform float max_radius;
uniform vec2 inverse_clip;

vec4 apply(vec4 color, vec4 depth) {
  float z = device_input ? view_distance(depth.r, inverse_clip, reversed_z) : depth.r;
  float radius = infinity * (z - focus_distance) / max(z, 1e-6);
  return vec4(color.rgb, clamp(radius, -max_radius, max_radius));
}
