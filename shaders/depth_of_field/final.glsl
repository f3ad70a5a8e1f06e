// SPDX-License-Identifier: MIT
// The picture where it is sharp, what is blurred behind it where it is not, and over both what is blurred in front.
#include "lib/blurred.glsl"
#include "lib/circle_of_confusion.glsl"
#include "lib/depth.glsl"

layout(constant_id = 0) const bool device_input = false;
layout(constant_id = 1) const bool reversed_z = true;

uniform vec3 focus;  // see circle_of
uniform vec2 inverse_clip;
uniform sampler2D picture;
uniform sampler2D depth;
uniform sampler2D far;   // small, weights in alpha, half a pixel further
uniform sampler2D near;  // the same
layout(constant_id = 2) const int factor = 2;

float circle_at(ivec2 pixel) {
  float d = fetch(depth, pixel).r;
  return circle_of(device_input ? view_distance(d, inverse_clip, reversed_z) : d, focus);
}

vec4 sample_at(ivec2 pixel) {
  vec4 color = fetch(picture, pixel);
  float circle = circle_at(pixel), blur = blurred(circle, float(factor));
  ivec2 last = pixel / factor, first = last - 1;
  vec2 f = (vec2(pixel - last * factor) + 0.5) * (1.0 / float(factor)), g = 1.0 - f;
  ivec2 beside = ivec2(last.x, first.y), below = ivec2(first.x, last.y);
  vec4 weights = vec4(g.x * g.y, f.x * g.y, g.x * f.y, f.x * f.y);
  vec4 behind = fetch(far, first) * weights.x + fetch(far, beside) * weights.y + fetch(far, below) * weights.z + fetch(far, last) * weights.w;
  vec4 front = fetch(near, first) * weights.x + fetch(near, beside) * weights.y + fetch(near, below) * weights.z + fetch(near, last) * weights.w;
  vec3 result = color.rgb * (1.0 - blur) + behind.rgb * (blur / behind.a);
  // What lies in front shines through itself no more than something is seen past it.
  float seen = circle < 0.0 ? mix(1.0, min(16.0 * behind.a, 1.0), blur) : 1.0, rest = max(1.0 - front.a, 0.0) * seen;
  return vec4((result * rest + front.rgb) / (front.a + rest), color.a);
}
