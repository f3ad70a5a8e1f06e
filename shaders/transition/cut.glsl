// SPDX-License-Identifier: MIT
// This picture and the other, by how far each pixel has gone over.
#include "lib/color.glsl"
#include "lib/noise.glsl"

layout(constant_id = 0) const int kind = 0;
layout(constant_id = 1) const bool has_other = false;

uniform sampler2D source;
uniform sampler2D other;
uniform float progress, span, soft, pixel, aspect, widest;
uniform vec3 plain;
uniform vec2 direction, hand, center, grain;
uniform int count, seed;

const float kNoDistance = 1e-6;  // from the centre, in sizes of the picture: it has no direction

const int kDissolve = 0, kFade = 1, kWipe = 2, kIris = 3, kClock = 4, kBlinds = 5, kScatter = 6, kPush = 7;

vec3 other_at(ivec2 at, float alpha) { return has_other ? fetch(other, at).rgb : clamp(plain * alpha, -kMaxLight, kMaxLight); }

vec2 share_of(ivec2 at) { return (vec2(at) + 0.5) / vec2(target_size()); }

// From the centre of iris and clock, in heights of the picture. A pixel in the middle is at 0, however divisions are rounded.
vec2 from_center(ivec2 at) {
  vec2 size = vec2(target_size());
  vec2 from = (vec2(2 * at + 1) - size) / (2.0 * size) - (center - 0.5);
  return dot(from, from) < kNoDistance * kNoDistance ? vec2(0.0) : from * vec2(aspect, 1.0);
}

// Turns that a place lies behind a direction, clockwise: -0.5 to 0.5.
float turns_behind(vec2 from, vec2 way) { return atan(way.x * from.y - way.y * from.x, dot(way, from)) / 6.28318530718; }

// When a pixel's turn comes, 0…1.
float turn_of(ivec2 at) {
  vec2 from = from_center(at);
  if (kind == kIris) return length(from) / widest;
  if (kind == kClock) return from == vec2(0.0) ? 0.0 : fract(turns_behind(from, direction) + 1.0);
  if (kind == kScatter) {
    vec2 cell = floor((vec2(at) + 0.5) / (grain.x + grain.y));
    return unit_of(pcg3d(uvec3(uvec2(cell), uint(seed)))).x;
  }
  float along = dot((share_of(at) - 0.5) * vec2(aspect, 1.0), direction) / span + 0.5;
  if (kind == kBlinds) along = fract(along * float(count));
  return along;
}

// How far a pixel is from where the turns begin again, in pixels: from the clock's first line, from where strips meet.
float from_seam(ivec2 at, float turn) {
  if (kind == kBlinds) return min(turn, 1.0 - turn) / pixel;
  vec2 from = from_center(at);
  return dot(from, direction) >= 0.0 ? abs(from.x * direction.y - from.y * direction.x) * float(target_size().y) : 1.0;
}

// How far the edge's middle is ahead of a pixel's turn. The clock's angle is taken from its hand: exact where it matters.
float ahead_of(ivec2 at, float turn) {
  if (kind != kClock) return progress - turn;
  vec2 from = from_center(at);
  if (from == vec2(0.0)) return progress;
  float ahead = -turns_behind(from, hand);
  return ahead + round(progress - turn - ahead);
}

// How much of the other picture a pixel shows, 0…1. Edges and seams are as wide as a pixel at least.
float gone_at(ivec2 at) {
  float turn = turn_of(at), edge = soft;
  if (kind == kClock) edge = max(soft, 1.0 / max(6.28318530718 * length(from_center(at)) * float(target_size().y), 1.0));
  float gone = clamp(progress + ahead_of(at, turn) / edge, 0.0, 1.0);
  if (kind != kClock && kind != kBlinds) return gone;
  float away = from_seam(at, turn);
  if (away >= 0.5) return gone;
  float beyond = clamp(progress + (turn < 0.5 ? progress - 1.0 : progress) / edge, 0.0, 1.0);  // on the other side of the seam
  return mix(beyond, gone, 0.5 + away);
}

vec4 sample_at(ivec2 at) {
  vec4 color = fetch(source, at);
  if (kind == kDissolve) return vec4(lerp(color.rgb, other_at(at, color.a), progress), color.a);
  if (kind == kFade) {
    vec3 through = clamp(plain * color.a, -kMaxLight, kMaxLight);
    vec3 light = progress < 0.5 ? lerp(color.rgb, through, 2.0 * progress) : lerp(through, other_at(at, color.a), 2.0 * progress - 1.0);
    return vec4(light, color.a);
  }
  if (kind == kPush) {
    vec2 size = vec2(target_size());
    vec2 way = abs(direction.x) >= abs(direction.y) ? vec2(sign(direction.x), 0.0) : vec2(0.0, sign(direction.y));  // straight, whatever the angle
    ivec2 moved = ivec2(floor(way * size * progress + 0.5)), whole = ivec2(floor(way * size + 0.5));
    ivec2 from = at - moved;
    bool stays = all(greaterThanEqual(from, ivec2(0))) && all(lessThan(from, ivec2(size)));
    return vec4(stays ? fetch(source, from).rgb : other_at(from + whole, color.a), color.a);
  }
  return vec4(lerp(color.rgb, other_at(at, color.a), gone_at(at)), color.a);
}
