// SPDX-License-Identifier: MIT
// c·(S·s + M·m + H·h): s, m, h add up to 1 and come from luminance (Unity's LutBuilder: "Shadows, midtones, highlights").
#include "lib/color.glsl"

uniform vec3 shadows;
uniform vec3 midtones;
uniform vec3 highlights;
uniform vec2 shadow_limits;     // luminance: from 1 to 0 between these
uniform vec2 highlight_limits;  // luminance: from 0 to 1 between these

/// 1 − smoothstep, to the last digit where it is small.
float fall(vec2 limits, float y) {
  float t = clamp((limits.y - y) / (limits.y - limits.x), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

vec4 apply(vec4 color) {
  float y = luminance(color.rgb);
  float s = fall(shadow_limits, y);
  float h = smoothstep(highlight_limits.x, highlight_limits.y, y);
  // 1 − s − h, below 0 where the limits overlap; with the digits of 1 − s or 1 − h, whichever may be small.
  float m = h > 0.5 ? fall(highlight_limits, y) - s : smoothstep(shadow_limits.x, shadow_limits.y, y) - h;
  return vec4(clamp(color.rgb * (shadows * s + midtones * m + highlights * h), 0.0, kMaxLight), color.a);
}
