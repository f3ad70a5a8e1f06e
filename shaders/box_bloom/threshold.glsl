// SPDX-License-Identifier: MIT
// c · max(0, b − t)/max(b, 1e-5): a hard threshold on brightness, linear, without a knee.
#include "lib/color.glsl"

layout(constant_id = 0) const bool luma = false;  // brightness is a weighted sum; else the largest channel
uniform float threshold;

vec4 apply(vec4 color) {
  float b = luma ? dot(color.rgb, vec3(0.3, 0.59, 0.11)) : brightest(color.rgb);
  return vec4(color.rgb * (max(0.0, b - threshold) / max(b, 1e-5)), color.a);
}
