// SPDX-License-Identifier: MIT
// This picture and the other, by how far each pixel has gone over.
#include "lib/color.glsl"
#include "lib/noise.glsl"

layout(constant_id = 0) const int kind = 0;
layout(constant_id = 1) const bool has_other = false;

uniform sampler2D source;
uniform sampler2D other;
uniform float progress, span, soft, aspect, widest, start;
uniform vec3 plain;
uniform vec2 direction, center, grain;
uniform int count, seed;

const int kDissolve = 0, kFade = 1, kWipe = 2, kIris = 3, kClock = 4, kBlinds = 5, kScatter = 6, kPush = 7;

vec3 other_at(ivec2 pixel, float alpha) { return has_other ? fetch(other, pixel).rgb : clamp(plain * alpha, -kMaxLight, kMaxLight); }

// When a pixel's turn comes, 0…1.
float turn_of(ivec2 pixel) {
  vec2 p = (vec2(pixel) + 0.5) / vec2(target_size());
  if (kind == kIris) return length((p - center) * vec2(aspect, 1.0)) / widest;
  if (kind == kClock) {
    vec2 from = (p - center) * vec2(aspect, -1.0);
    if (from == vec2(0.0)) return 0.0;  // the middle itself
    return fract((start - atan(from.y, from.x)) / 6.28318530718 + 1.0);
  }
  if (kind == kScatter) {
    vec2 cell = floor((vec2(pixel) + 0.5) / (grain.x + grain.y));
    return unit_of(pcg3d(uvec3(uvec2(cell), uint(seed)))).x;
  }
  float along = dot((p - 0.5) * vec2(aspect, 1.0), direction) / span + 0.5;
  if (kind == kBlinds) along = fract(along * float(count));
  return along;
}

vec4 sample_at(ivec2 pixel) {
  vec4 color = fetch(source, pixel);
  if (kind == kDissolve) return vec4(lerp(color.rgb, other_at(pixel, color.a), progress), color.a);
  if (kind == kFade) {
    vec3 through = clamp(plain * color.a, -kMaxLight, kMaxLight);
    vec3 light = progress < 0.5 ? lerp(color.rgb, through, 2.0 * progress) : lerp(through, other_at(pixel, color.a), 2.0 * progress - 1.0);
    return vec4(light, color.a);
  }
  if (kind == kPush) {
    vec2 size = vec2(target_size());
    vec2 way = abs(direction.x) >= abs(direction.y) ? vec2(sign(direction.x), 0.0) : vec2(0.0, sign(direction.y));  // straight, whatever the angle
    ivec2 moved = ivec2(floor(way * size * progress + 0.5)), whole = ivec2(floor(way * size + 0.5));
    ivec2 from = pixel - moved;
    bool stays = all(greaterThanEqual(from, ivec2(0))) && all(lessThan(from, ivec2(size)));
    return vec4(stays ? fetch(source, from).rgb : other_at(from + whole, color.a), color.a);
  }
  float gone = clamp((progress * (1.0 + soft) - turn_of(pixel)) / soft, 0.0, 1.0);
  return vec4(lerp(color.rgb, other_at(pixel, color.a), gone), color.a);
}
