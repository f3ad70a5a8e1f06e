// SPDX-License-Identifier: MIT
// c · max(0, min(b, limit) − t)/b, b the largest channel: the light above a threshold, of which none counts for more than the limit.
#include "lib/color.glsl"

uniform float threshold, limit;

vec4 apply(vec4 color) {
  float b = brightest(color.rgb);
  return vec4(color.rgb * (max(0.0, min(b, limit) - threshold) / max(b, 1e-5)), 1.0);
}
