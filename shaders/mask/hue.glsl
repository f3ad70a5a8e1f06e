// SPDX-License-Identifier: MIT
// By hue on the circle of degrees; greys have none, so colours count by their saturation, (max − min)/max.
#include "lib/mask.glsl"

uniform float center;      // degrees
uniform float half_width;  // degrees
uniform float soft;
uniform float saturation;  // from which colours count fully

vec4 apply(vec4 color) {
  vec3 c = max(straight(color), 0.0);
  float high = max(c.r, max(c.g, c.b)), spread = high - min(c.r, min(c.g, c.b));
  float sextant = high == c.r ? (c.g - c.b) : high == c.g ? (c.b - c.r) : (c.r - c.g);
  float hue = 60.0 * (sextant / max(spread, 1e-30) + (high == c.r ? 0.0 : high == c.g ? 2.0 : 4.0));
  float away = abs(mod(hue - center + 180.0, 360.0) - 180.0);
  return vec4((1.0 - smoothstep(half_width, half_width + soft, away)) * smoothstep(0.0, saturation, spread / max(high, 1e-30)));
}
