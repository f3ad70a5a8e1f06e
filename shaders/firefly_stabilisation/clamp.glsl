// SPDX-License-Identifier: MIT
// Scales down what is brighter than its surroundings and its past allow.
#include "lib/color.glsl"

uniform sampler2D source;
uniform sampler2D before;  // brightness one to four frames ago
uniform float threshold, tolerance;
uniform int search, frames;

// The second brightest pixel at distance 2: a firefly that a reconstruction filter has spread over 3×3 pixels stays within, whatever is larger
// or longer crosses the ring twice.
float surroundings(ivec2 pixel) {
  float most = 0.0, second = 0.0;
  for (int i = 0; i < 16; ++i) {
    int side = i / 4, along = i % 4 - 2;
    ivec2 at = side == 0 ? ivec2(along, -2) : side == 1 ? ivec2(2, along) : side == 2 ? ivec2(-along, 2) : ivec2(-2, -along);
    float b = brightest(fetch(source, pixel + at).rgb);
    second = max(second, min(b, most));
    most = max(most, b);
  }
  return second;
}

// The brightness that each of the last frames had nearby: the longer ago, the further a light may have come.
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
  return least;
}

// Up to this brightness its surroundings allow a pixel.
float limit_at(ivec2 pixel) { return max(threshold, tolerance * surroundings(pixel)); }

bool done_at(ivec2 pixel, out vec4 color) {
  color = fetch(source, pixel);
  return brightest(color.rgb) <= limit_at(pixel);
}

vec4 sample_at(ivec2 pixel) {
  vec4 color = fetch(source, pixel);
  float b = brightest(color.rgb), limit = max(limit_at(pixel), min(tolerance * past(pixel), kMaxLight));
  return b <= limit ? color : vec4(color.rgb * (limit / b), color.a);
}
