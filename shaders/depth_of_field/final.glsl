// SPDX-License-Identifier: MIT
// The picture where it is sharp, what is blurred behind it where it is not, and over both what is blurred in front.
#include "lib/blurred.glsl"
#include "lib/circle_of_confusion.glsl"
#include "lib/depth.glsl"
#include "lib/edge_pixels.glsl"

layout(constant_id = 0) const bool device_input = false;
layout(constant_id = 1) const bool reversed_z = true;

layout(constant_id = 3) const bool is_automatic = false;

uniform vec3 lens;          // of the focus, see circle_of; automatic: see focus_at
uniform sampler2D focused;  // automatic: one texel, dioptres
uniform vec2 inverse_clip;
uniform sampler2D picture;
uniform sampler2D depth;
uniform sampler2D far;   // small, weights in alpha, half a pixel further
uniform sampler2D near;  // the same
layout(constant_id = 2) const int factor = 2;

float circle_for(float d, vec3 focus) { return circle_of(device_input ? view_distance(d, inverse_clip, reversed_z) : d, focus); }
float circle_at(ivec2 pixel, vec3 focus) { return circle_for(fetch(depth, pixel).r, focus); }

/// How much what has the first circle lies in front of what has the second, and is blurred.
float before(float there, float circle) { return clamp(min(-there, circle - there) - 0.5, 0.0, 1.0); }

/// An edge pixel holds light of what is in front at the depth of what is behind, and would stand sharp in the blurred edge: its neighbours away
/// from the edge stand for it. Not those further away: of small bright lights a second one would be seen beside the first.
vec3 behind_edge(vec3 color, ivec2 pixel, float circle, vec3 focus) {
  float nearest = fetch(depth, pixel).r;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      float d = fetch(depth, pixel + ivec2(x, y)).r;
      nearest = device_input && reversed_z ? max(nearest, d) : min(nearest, d);
    }
  float edge = before(circle_for(nearest, focus), circle);
  if (edge <= 0.0) return color;
  vec2 away = vec2(0.0);
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) away -= before(circle_at(pixel + ivec2(x, y), focus), circle) * vec2(x, y);
  vec4 sum = vec4(color, 1.0) * 1e-3;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      ivec2 at = pixel + ivec2(x, y);
      float there = circle_at(at, focus), other = there - circle;
      sum += away_from(away, vec2(x, y)) * (1.0 - before(there, circle)) / (1.0 + other * other) * vec4(fetch(picture, at).rgb, 1.0);
    }
  return mix(color, sum.rgb / sum.a, edge);
}

vec4 sample_at(ivec2 pixel) {
  vec4 color = fetch(picture, pixel);
  vec3 focus = is_automatic ? focus_at(fetch(focused, ivec2(0)).r, lens) : lens;
  float circle = circle_at(pixel, focus), blur = blurred(circle, float(factor));
  ivec2 last = pixel / factor, first = last - 1;
  vec2 f = (vec2(pixel - last * factor) + 0.5) * (1.0 / float(factor)), g = 1.0 - f;
  ivec2 beside = ivec2(last.x, first.y), below = ivec2(first.x, last.y);
  vec4 weights = vec4(g.x * g.y, f.x * g.y, g.x * f.y, f.x * f.y);
  vec4 behind = fetch(far, first) * weights.x + fetch(far, beside) * weights.y + fetch(far, below) * weights.z + fetch(far, last) * weights.w;
  vec4 front = fetch(near, first) * weights.x + fetch(near, beside) * weights.y + fetch(near, below) * weights.z + fetch(near, last) * weights.w;
  if (front.a > 0.0 && blur < 1.0) color.rgb = behind_edge(color.rgb, pixel, circle, focus);
  vec3 result = color.rgb * (1.0 - blur) + behind.rgb * (blur / behind.a);
  // What lies in front shines through itself no more than something is seen past it.
  float seen = circle < 0.0 ? mix(1.0, min(16.0 * behind.a, 1.0), blur) : 1.0, rest = max(1.0 - front.a, 0.0) * seen;
  return vec4((result * rest + front.rgb) / (front.a + rest), color.a);
}
