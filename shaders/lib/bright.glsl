// SPDX-License-Identifier: MIT
// c · max(0, min(b, limit) − t)/b, b the largest channel: the light above a threshold, of which none counts for more than the limit.
#include "lib/color.glsl"

vec3 light_above(vec3 color, float threshold, float limit) {
  float b = brightest(color);
  return color * (max(0.0, min(b, limit) - threshold) / max(b, 1e-5));
}
