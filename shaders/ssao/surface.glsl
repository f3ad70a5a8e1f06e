// SPDX-License-Identifier: MIT
// Direction of the surface (rgb, in the camera's space: x right, y up, z towards it) and distance along the viewing axis (a) of every second pixel.
#include "lib/depth.glsl"

layout(constant_id = 0) const int source_normals = 0;  // 0: from depth, 1: in the camera's space, 2: in the world's
layout(constant_id = 1) const bool device_input = false;
layout(constant_id = 2) const bool reversed_z = true;

uniform sampler2D depth;
uniform sampler2D normal;
uniform vec2 inverse_clip;
uniform vec2 view;  // tangents of the picture's half angles
uniform vec3 right, up, forward;

float distance_at(ivec2 at) {
  float d = fetch(depth, at).r;
  return clamp(device_input ? view_distance(d, inverse_clip, reversed_z) : d, 0.0, 1e10);
}

vec3 place(ivec2 at, float z) {
  vec2 p = (vec2(2 * at + 1) / vec2(image_size(depth)) - 1.0) * vec2(view.x, -view.y);
  return vec3(p * z, -z);
}

// The change to the nearer neighbour in depth: the one on the same surface.
vec3 slope(ivec2 at, ivec2 by, float z, vec3 here) {
  float ahead = distance_at(at + by), behind = distance_at(at - by);
  return abs(ahead - z) <= abs(behind - z) ? place(at + by, ahead) - here : here - place(at - by, behind);
}

vec4 sample_at(ivec2 pixel) {
  ivec2 at = min(2 * pixel, image_size(depth) - 1);
  float z = distance_at(at);
  vec3 n = vec3(0.0);
  if (source_normals == 0) {
    vec3 here = place(at, z);
    n = cross(slope(at, ivec2(0, 1), z, here), slope(at, ivec2(1, 0), z, here));
  } else {
    n = clamp(fetch(normal, at).xyz, -1e6, 1e6);
    if (source_normals == 2) n = vec3(dot(n, right), dot(n, up), -dot(n, forward));
  }
  float most = max(abs(n.x), max(abs(n.y), abs(n.z)));
  n = most > 1e-30 ? n / most : vec3(0.0, 0.0, 1.0);
  return vec4(n / length(n), z);
}
