// SPDX-License-Identifier: MIT
// Scales down what is brighter than its surroundings and its past allow.
#include "lib/color.glsl"

uniform sampler2D source;
uniform sampler2D before;  // brightness one to four frames ago
uniform float threshold, tolerance;
uniform int search, frames;

// The second brightest pixel at distance 2: a firefly that a reconstruction filter has spread over 3×3 pixels stays within, whatever is larger
// or longer crosses the ring twice. Pairs first: two brightest each.
vec2 pair(float a, float b) { return vec2(max(a, b), min(a, b)); }
vec2 both(vec2 a, vec2 b) { return vec2(max(a.x, b.x), max(min(a.x, b.x), max(a.y, b.y))); }

float at(ivec2 pixel) { return brightest(fetch(source, pixel).rgb); }
vec2 line_of(ivec2 from, ivec2 step) {
  return both(pair(at(from), at(from + step)), pair(at(from + 2 * step), at(from + 3 * step)));
}

float surroundings(ivec2 pixel) {
  vec2 above = line_of(pixel + ivec2(-2, -2), ivec2(1, 0)), right = line_of(pixel + ivec2(2, -2), ivec2(0, 1));
  vec2 below = line_of(pixel + ivec2(2, 2), ivec2(-1, 0)), left = line_of(pixel + ivec2(-2, 2), ivec2(0, -1));
  return both(both(above, right), both(below, left)).y;
}

// The brightness that each of the last frames had nearby: the longer ago, the further a light may have come. 65504 stands for that and all above.
float past(ivec2 pixel) {
  int reach = search * frames;
  vec4 seen = vec4(0.0);
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) {
      ivec4 way = ivec4(max(abs(x), abs(y)));
      vec4 b = fetch(before, pixel + ivec2(x, y));
      seen = max(seen, mix(vec4(0.0), b, lessThanEqual(way, search * ivec4(1, 2, 3, 4))));
    }
  float least = seen.x;
  for (int i = 1; i < frames; ++i) least = min(least, seen[i]);
  return least >= 65504.0 ? kMaxLight : least;
}

bool done_at(ivec2 pixel, out vec4 color) {
  color = fetch(source, pixel);
  return brightest(color.rgb) <= threshold;
}

vec4 sample_at(ivec2 pixel) {
  vec4 color = fetch(source, pixel);
  float b = brightest(color.rgb), limit = max(threshold, tolerance * surroundings(pixel));
  if (b <= limit) return color;
  limit = max(limit, min(tolerance * past(pixel), kMaxLight));
  return b <= limit ? color : vec4(color.rgb * (limit / b), color.a);
}
