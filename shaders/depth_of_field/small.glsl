// SPDX-License-Identifier: MIT
// A small picture: the mean of each square of `factor` pixels, with the radius of its circle of confusion in alpha, in pixels of the small
// picture. Of a square that lies across an edge the widest circle counts, and the light of pixels whose circles are like it.
#include "lib/circle_of_confusion.glsl"
#include "lib/depth.glsl"

layout(constant_id = 0) const bool device_input = false;
layout(constant_id = 1) const bool reversed_z = true;

layout(constant_id = 3) const bool is_automatic = false;

uniform vec3 lens;          // of the focus, see circle_of; automatic: see focus_at
uniform sampler2D focused;  // automatic: one texel, dioptres
uniform vec2 inverse_clip;
uniform sampler2D picture;
uniform sampler2D depth;
layout(constant_id = 2) const int factor = 2;

float circle_at(ivec2 pixel, vec3 focus) {
  float d = fetch(depth, pixel).r;
  return circle_of(device_input ? view_distance(d, inverse_clip, reversed_z) : d, focus);
}

vec4 sample_at(ivec2 pixel) {
  ivec2 first = pixel * factor;
  vec3 focus = is_automatic ? focus_at(fetch(focused, ivec2(0)).r, lens) : lens;
  if (factor == 2) {
    // The same for four pixels at once.
    ivec2 right = first + ivec2(1, 0), below = first + ivec2(0, 1), last = first + 1;
    vec4 circles = vec4(circle_at(first, focus), circle_at(right, focus), circle_at(below, focus), circle_at(last, focus));
    float widest = widest_of(circles);
    vec4 weights = like_widest(circles, widest, 1.0);
    vec3 sum = fetch(picture, first).rgb * weights.x + fetch(picture, right).rgb * weights.y + fetch(picture, below).rgb * weights.z +
               fetch(picture, last).rgb * weights.w;
    return vec4(sum / (weights.x + weights.y + weights.z + weights.w), widest * 0.5);
  }
  float widest = 0.0;
  for (int y = 0; y < factor; ++y)
    for (int x = 0; x < factor; ++x) {
      float circle = circle_at(first + ivec2(x, y), focus);
      if (abs(circle) > abs(widest) || (abs(circle) == abs(widest) && circle < 0.0)) widest = circle;
    }
  vec4 sum = vec4(0.0);
  float scale = 2.0 / max(abs(widest), 1.0);
  for (int y = 0; y < factor; ++y)
    for (int x = 0; x < factor; ++x) {
      float circle = circle_at(first + ivec2(x, y), focus);
      sum += clamp(1.5 - scale * abs(circle - widest), 0.0, 1.0) * vec4(fetch(picture, first + ivec2(x, y)).rgb, 1.0);
    }
  return vec4(sum.rgb / sum.a, widest / float(factor));
}
