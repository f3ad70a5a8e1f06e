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

/// What an image of the small size holds at a pixel: from the four texels around.
struct Around { ivec2 first, last; vec4 weights; };

Around around(ivec2 pixel) {
  ivec2 last = pixel / factor;
  vec2 f = (vec2(pixel - last * factor) + 0.5) * (1.0 / float(factor)), g = 1.0 - f;
  return Around(last - 1, last, vec4(g.x * g.y, f.x * g.y, g.x * f.y, f.x * f.y));
}

vec4 near_at(Around a) {
  return fetch(near, a.first) * a.weights.x + fetch(near, ivec2(a.last.x, a.first.y)) * a.weights.y +
         fetch(near, ivec2(a.first.x, a.last.y)) * a.weights.z + fetch(near, a.last) * a.weights.w;
}
vec4 far_at(Around a) {
  return fetch(far, a.first) * a.weights.x + fetch(far, ivec2(a.last.x, a.first.y)) * a.weights.y +
         fetch(far, ivec2(a.first.x, a.last.y)) * a.weights.z + fetch(far, a.last) * a.weights.w;
}

vec4 under(vec3 color, vec4 front, float rest, float alpha) { return vec4((color * rest + front.rgb) / (front.a + rest), alpha); }

// Where the pixel itself is sharp, nothing blurred lies behind it.
bool done_at(ivec2 pixel, out vec4 color) {
  vec4 sharp = fetch(picture, pixel), front = near_at(around(pixel));
  color = under(sharp.rgb, front, max(1.0 - front.a, 0.0), sharp.a);
  return blurred(circle_at(pixel), float(factor)) <= 0.0;
}

vec4 sample_at(ivec2 pixel) {
  vec4 color = fetch(picture, pixel);
  float circle = circle_at(pixel), blur = blurred(circle, float(factor));
  Around here = around(pixel);
  vec4 front = near_at(here), behind = far_at(here);
  vec3 result = color.rgb * (1.0 - blur) + behind.rgb * (blur / behind.a);
  // What lies in front shines through itself no more than something is seen past it.
  float seen = circle < 0.0 ? mix(1.0, min(16.0 * behind.a, 1.0), blur) : 1.0;
  return under(result, front, max(1.0 - front.a, 0.0) * seen, color.a);
}
