// SPDX-License-Identifier: MIT
// Hue, saturation and luma by hue: six points, smoothsteps between them. What has no hue stays: luma counts by HSV's saturation, and the
// others leave greys alone by themselves.
#include "lib/color.glsl"
#include "lib/hue.glsl"

uniform vec3 h1, h2, h3, h4, h5, h6;  // reds, yellows, greens, cyans, blues, magentas: sextants (−½…½), share (−1…1), stops (−1…1)

vec4 apply(vec4 color) {
  vec3 c = color.rgb, hue = hue_and_saturation(c, kNoHueEpsilon);
  bool red = hue.x < 1.0, green = !red && hue.x < 3.0, onwards = hue.y >= 0.0;
  vec3 own = red ? h1 : green ? h3 : h5;
  vec3 next = red ? (onwards ? h2 : h6) : green ? (onwards ? h4 : h2) : onwards ? h6 : h4;
  float f = abs(hue.y), share = f * f * (3.0 - 2.0 * f);
  vec3 change = own + (next - own) * share;
  c = turn_hue(c, 0.0, change.x, kNoHueEpsilon);
  c = max(c * (1.0 + change.y) - luminance(c) * change.y, 0.0) * exp2(change.z * hue.z);
  return vec4(min(c, kMaxLight), color.a);
}
