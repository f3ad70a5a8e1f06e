// SPDX-License-Identifier: MIT
// The mean over a regular polygon: 3 · rings · (rings + 1) reads in as many rings, as evenly spread as in a honeycomb. Beyond the picture there is no light.
#include "lib/angle.glsl"

uniform sampler2D source;
uniform float radius;  // of its corners, texels
uniform int rings, blades;
uniform float turn;  // whole turns, against the clock

vec4 sample_at(ivec2 pixel) {
  vec2 size = vec2(target_size());
  float sector = 1.0 / float(blades);
  vec3 sum = fetch(source, pixel).rgb;
  for (int ring = 1; ring <= rings; ++ring)
    for (int i = 0; i < 6 * ring; ++i) {
      float angle = float(i) / float(6 * ring);
      float side = direction_of(0.5 * sector).x / direction_of(mod(angle, sector) - 0.5 * sector).x;
      float far = radius * (float(ring) / float(rings)) * side;
      vec2 at = vec2(pixel) + 0.5 + far * (direction_of(angle + turn) * vec2(1.0, -1.0));
      vec2 inside = clamp(min(at, size - at) + 0.5, 0.0, 1.0);
      sum += (inside.x * inside.y) * fetch_linear(source, at).rgb;
    }
  return vec4(sum / float(1 + 3 * rings * (rings + 1)), 1.0);
}
