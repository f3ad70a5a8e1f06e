// SPDX-License-Identifier: MIT
// Which of the two nearest 8-bit codes a pixel gets, so that an area of them has the light that was meant.
#include "lib/display.glsl"

/// `threshold` in (0, 1) is the pixel's blue noise. Between two codes the sRGB curve bends by at most 3 %, so that a share of t pixels at the upper
/// code makes the light of t(1 + rt)/(1 + r) of the step: this is accounted for, to 2e-4 of a code. What lies within a
/// thousandth of a code is that code everywhere: black, white, flat areas of 8-bit pictures.
vec3 dithered_color(vec3 light, float threshold) {
  vec3 encoded = 255.0 * clamp(srgb_encode(clamp(light, 0.0, 1.0)), 0.0, 1.0);
  vec3 code = floor(encoded), t = encoded - code;
  vec3 r = mix(vec3(0.0), 0.7 / (code + 14.025), greaterThan(code, vec3(10.0)));
  t = t * (1.0 + r * t) / (1.0 + r);
  vec3 up = mix(vec3(0.0), vec3(1.0), greaterThan(t * 1.002 - 0.001, vec3(threshold)));
  return min(code + up, 255.0) / 255.0;
}
