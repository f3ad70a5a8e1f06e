// SPDX-License-Identifier: MIT
// What a camera's autofocus sees: 8×8 points in a square of the picture, each as 1/distance (dioptres), in which what is blurred alike is as far apart.
#include "lib/depth.glsl"

layout(constant_id = 0) const bool device_input = false;
layout(constant_id = 1) const bool reversed_z = true;

uniform vec2 first, spacing;  // pixels: place of the first point, from one to the next
uniform vec2 inverse_clip;
uniform sampler2D depth;

vec4 sample_at(ivec2 point) {
  ivec2 last = image_size(depth) - 1;
  float d = fetch(depth, clamp(ivec2(floor(first + spacing * vec2(point))), ivec2(0), last)).r;
  return vec4(1.0 / max(device_input ? view_distance(d, inverse_clip, reversed_z) : d, 1e-4), 0.0, 0.0, 1.0);
}
