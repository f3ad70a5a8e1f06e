// SPDX-License-Identifier: MIT
// What crosses a pixel while the shutter is open. Along its own way lies what it is blurred with; what is in front of it and moves
// otherwise comes along the longest way around. A way is read once for each pixel of its longer axis, between the two pixels there, and each
// read counts for the part of its length that the way covers: so a way of half a pixel more blurs by half a pixel more.
#include "lib/color.glsl"

uniform sampler2D source;   // half ways and nearness
uniform sampler2D picture;
uniform sampler2D longest;  // half ways, by tile
uniform float tiles;  // in a pixel: 1 / their side
uniform int samples;
uniform float softness;

/// The longest way around a pixel. (Division of whole numbers is slow on CPU devices; this is the same for sides up to 16384.)
vec2 around(ivec2 pixel) { return fetch(longest, ivec2((vec2(pixel) + 0.5) * tiles)).xy; }

float longer(vec2 way) { return max(abs(way.x), abs(way.y)); }

/// How much of the read `i` steps away a way of `steps` covers.
float covered(float i, float steps) { return clamp(steps + 0.5 - i, 0.0, 1.0); }

/// Square of the difference of two ways; which end of a way comes first decides nothing.
float unlike(vec2 a, vec2 b) { return max(dot(a, a) + dot(b, b) - 2.0 * abs(dot(a, b)), 1e-6); }

/// Adds one pixel, `i` steps along the way, to what is not in front (colour and weight) and to what is (colour and share of the time).
/// `share`: how much of it lies on the way; `inside`: how much of its step the way covers.
void count(inout vec4 behind, inout vec4 front, ivec2 at, float share, float i, float inside, vec2 step, vec4 own, vec2 other, bool two) {
  vec4 read = fetch(source, at);
  float in_front = clamp((read.z - own.z) / softness, 0.0, 1.0);
  // What is in front passes over this pixel for as long as its own motion along this way says.
  float steps = abs(dot(read.xy, step)) / dot(step, step);
  float passes = share * in_front * covered(i, steps) / (2.0 * max(steps, 0.5));
  if (two) {
    // It belongs to the way that it is more like.
    float to_own = unlike(read.xy, own.xy), to_other = unlike(read.xy, other);
    passes *= (inside < 0.0 ? to_own : to_other) / (to_own + to_other);
  }
  float stays = share * max(inside, 0.0) * (1.0 - in_front);
  if (passes + stays <= 0.0) return;
  vec3 color = fetch(picture, at).rgb;
  front += passes * vec4(color, 1.0);
  behind += stays * vec4(color, 1.0);
}

/// Adds what lies along a way, to both sides. `first`: it is the pixel's own way, and what is not in front counts too.
void follow(inout vec4 behind, inout vec4 front, ivec2 pixel, vec2 way, vec4 own, vec2 other, bool two, bool first) {
  float length_of_way = longer(way);
  // No more reads than there may be: each then stands for several pixels.
  float apart = max(1.0, ceil((2.0 * length_of_way - 0.3) / float(samples)));
  vec2 step = way * (apart / length_of_way);
  bool flat_way = abs(way.x) >= abs(way.y);
  ivec2 across = flat_way ? ivec2(0, 1) : ivec2(1, 0);
  ivec2 along = (1 - across) * (int(apart) * ((flat_way ? way.x : way.y) < 0.0 ? -1 : 1));
  float slope = flat_way ? step.y : step.x, steps = length_of_way / apart;
  int reads = int(floor(steps + 0.5));
  for (int i = 1; i <= reads; ++i) {
    float inside = first ? covered(float(i), steps) : -1.0;
    float aside = float(i) * slope, whole = floor(aside), rest = aside - whole;
    ivec2 to = i * along + int(whole) * across;
    count(behind, front, pixel + to, 1.0 - rest, float(i), inside, step, own, other, two);
    count(behind, front, pixel + to + across, rest, float(i), inside, step, own, other, two);
    count(behind, front, pixel - to, 1.0 - rest, float(i), inside, step, own, other, two);
    count(behind, front, pixel - to - across, rest, float(i), inside, step, own, other, two);
  }
}

// Nothing around moves by a pixel.
bool done_at(ivec2 pixel, out vec4 color) {
  color = fetch(picture, pixel);
  return longer(around(pixel)) <= 0.5;
}

vec4 sample_at(ivec2 pixel) {
  vec4 color = fetch(picture, pixel);
  vec2 way = around(pixel);
  vec4 own = fetch(source, pixel);
  vec4 behind = vec4(color.rgb, 1.0), front = vec4(0.0);
  bool two = unlike(way, own.xy) > 0.25;
  if (longer(own.xy) > 0.5) follow(behind, front, pixel, own.xy, own, way, two, true);
  if (two) follow(behind, front, pixel, way, own, way, true, false);
  vec3 result = behind.rgb * (max(1.0 - front.a, 0.0) / behind.a) + front.rgb / max(front.a, 1.0);
  return vec4(result, color.a);
}
